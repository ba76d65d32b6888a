#include "daemon/offline/analysis/plan_plot.h"

#include <gtest/gtest.h>

#include <limits>

namespace footing::plot {
namespace {

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

}  // namespace
}  // namespace footing::plot
