#include "common/qr/qr_code.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace footing::qr {
namespace {

TEST(QrCode, HasSquaresAtThreeCornersAndALightBorder) {
  const std::string fingerprint = "sha256:" + std::string(64, 'a');
  const std::string drawn = QrCode(fingerprint);
  // 71 bytes fit into version 4 at level L (ISO/IEC 18004: up to 78): 33 squares and the border of
  // 4 on each side, two rows a line.
  std::vector<std::string> lines;
  std::istringstream text(drawn);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), (33 + 8 + 1) / 2u);
  EXPECT_EQ(lines.front().find("█"), std::string::npos) << "the border is light";
  // The first two rows of a corner's square: seven dark ones above one dark at each side.
  const std::string corner = "█▀▀▀▀▀█";
  EXPECT_EQ(lines[2].find(corner), lines[2].find(' ') + 4);
  EXPECT_NE(lines[2].rfind(corner), lines[2].find(corner)) << "left and right";
  EXPECT_EQ(QrCode(std::string(4000, 'a')), "") << "longer than any QR code";
}

}  // namespace
}  // namespace footing::qr
