#include "daemon/offline/analysis/stick_plot.h"

#include <gtest/gtest.h>

#include <limits>

namespace footing::plot {
namespace {

TEST(StickPlot, DrawsAllPanelsAtOneScaleOnOneGround) {
  // The tallest panel is 2 high: 280 of height over 2; both feet at 340.
  const std::string svg = StickPlot(
      "a & b", {{"tall", {}, {{0, 0, 0, 2}}}, {"short", {{1, 0, 1, 1}}, {{1, 0, 1.5, 1}}}});
  EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
  EXPECT_NE(svg.find("y1='340' x2='120' y2='60'"), std::string::npos) << svg;
  // Middle of the second panel 360, its sticks from x = 1 to 1.5 about 1.25: 35 to each side.
  EXPECT_NE(svg.find("x1='325' y1='340' x2='395' y2='200'"), std::string::npos) << svg;
}

TEST(StickPlot, LeavesOutWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = StickPlot("", {{"", {{0, nan, 1, 1}}, {{0, 0, 1, 1.0 / 0.0}}}});
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

}  // namespace
}  // namespace footing::plot
