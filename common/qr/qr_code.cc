#include "common/qr/qr_code.h"

#include <memory>

#include <qrencode.h>

namespace footing::qr {
namespace {

constexpr int kBorder = 4;                             // ISO/IEC 18004: four squares.
constexpr const char* kBlackOnWhite = "\x1b[30;107m";  // Whatever the terminal's colours are.
constexpr const char* kPlain = "\x1b[0m";

}  // namespace

std::string QrCode(const std::string& text) {
  const std::unique_ptr<QRcode, void (*)(QRcode*)> code(
      QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L), QRcode_free);
  if (!code) return "";
  const auto dark = [&](int row, int column) {
    const bool inside = row >= 0 && column >= 0 && row < code->width && column < code->width;
    return inside && (code->data[row * code->width + column] & 1u) != 0;
  };
  std::string drawn;
  for (int row = -kBorder; row < code->width + kBorder; row += 2) {
    drawn += kBlackOnWhite;
    for (int column = -kBorder; column < code->width + kBorder; ++column) {
      const bool upper = dark(row, column), lower = dark(row + 1, column);
      drawn += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
    }
    drawn += std::string(kPlain) + "\n";
  }
  return drawn;
}

}  // namespace footing::qr
