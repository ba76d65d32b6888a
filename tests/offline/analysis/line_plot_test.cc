#include "daemon/offline/analysis/line_plot.h"

#include <gtest/gtest.h>

#include <limits>

namespace footing::plot {
namespace {

TEST(LinePlot, PlacesPointsBetweenZeroAndTheLargestMark) {
  const std::string svg = LinePlot("a < b", "iteration", "objective", {{"run", {{0, 4}, {10, 2}}}});
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  // Left edge 60, right edge 620; top 40 is 4, bottom 310 is 0.
  EXPECT_NE(svg.find("points='60,40 620,175 '"), std::string::npos) << svg;
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
}

TEST(LinePlot, LeavesOutWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = LinePlot("", "", "", {{"", {{0, nan}, {1, 1}, {2, 1 / 0.0}}}, {"", {}}});
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(LinePlot, FitsAxesToCurvesThatGoBelowZero) {
  const std::string svg = LinePlot(
      "", "s", "cm", {{"truth", {{10, -4}, {12, 6}}, true}, {"told", {{11, 0}}}}, Axes::kFitted);
  // x from 10 to 12, marks of 0.5; y from -4 to 6, marks of 2. Bottom 310 is -4, top 40 is 6.
  EXPECT_NE(svg.find("points='60,310 620,40 '"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">-4</text>"), std::string::npos);
  EXPECT_NE(svg.find(">10.5</text>"), std::string::npos);
  EXPECT_NE(svg.find(">0</text>"), std::string::npos);
  // (11, 0) is half way across and 4 of 10 up: 310 - 0.4 x 270.
  EXPECT_NE(svg.find("points='340,202 '"), std::string::npos) << svg;
}

}  // namespace
}  // namespace footing::plot
