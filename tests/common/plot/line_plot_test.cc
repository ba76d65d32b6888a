#include <limits>

#include <gtest/gtest.h>

#include "common/plot/line_plot.h"

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

TEST(PlanPlot, DrawsAreasAndLinesAtFivePixelsAMetreWithYUp) {
  const std::string svg = PlanPlot(
      "a & b",
      {{"one", {{{{0, 0}, {10, 0}, {10, 4}, {0, 4}}, "#123456"}, {{{2, 0}, {2, 4}}, "#abcdef"}}}},
      {{"#123456", "ground"}});
  EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
  // The panel begins at x 16 and y 34, its drawing 20 lower; 4 m are 20 pixels.
  EXPECT_NE(svg.find("points='16,74 66,74 66,54 16,54 ' fill='#123456'"), std::string::npos) << svg;
  EXPECT_NE(svg.find("points='26,74 26,54 ' fill='none' stroke='#abcdef'"), std::string::npos);
  EXPECT_NE(svg.find(">10 m</text>"), std::string::npos);
  EXPECT_NE(svg.find(">ground</text>"), std::string::npos);
}

TEST(PlanPlot, PutsWhatDoesNotFitBesideIntoTheNextRow) {
  const PlanPanel wide{"", {{{{0, 0}, {100, 0}, {100, 10}}, "#000"}}};
  const std::string svg = PlanPlot("", {wide, wide}, {});
  EXPECT_NE(svg.find("points='16,104 516,104 516,54 "), std::string::npos) << svg;
  // The row before it is 20 + 50 high, and 16 apart.
  EXPECT_NE(svg.find("points='16,190 516,190 516,140 "), std::string::npos) << svg;
}

TEST(PlanPlot, LeavesOutWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = PlanPlot("", {{"", {{{{0, nan}, {1, 1}, {2, 2}}, "#000"}}}}, {});
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(svg.find("polygon"), std::string::npos);
}

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
