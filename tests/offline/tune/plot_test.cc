#include "daemon/offline/tune/plot.h"

#include <gtest/gtest.h>

#include <limits>

namespace footing::tune {
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

}  // namespace
}  // namespace footing::tune
