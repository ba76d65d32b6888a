#include "common/virtual/devices/insole_cells.h"

#include <gtest/gtest.h>

#include <cmath>

namespace footing::virtual_sensors {
namespace {

Eigen::Vector2d InW(const SolePlace& sole, const Eigen::Vector2d& p_F_m) {
  const double c = std::cos(sole.yaw_rad), s = std::sin(sole.yaw_rad);
  return sole.heel_m +
         Eigen::Vector2d(c * p_F_m.x() - s * p_F_m.y(), s * p_F_m.x() + c * p_F_m.y());
}

TEST(LoadInsole, HasTheFootsLoadAndCopAndNeverPulls) {
  const SolePlace sole{{0.5, -0.3}, 0.7, 0.24};
  const auto places = InsolePlaces(sole.length_m);
  for (const double x : {0.006, 0.05, 0.12, 0.2, 0.234}) {
    for (const double y : {-0.024, 0.0, 0.015}) {
      const FootForce foot{600, InW(sole, {x, y})};
      const auto loads = LoadInsole(places, sole, foot);
      double total = 0;
      Eigen::Vector2d moment = Eigen::Vector2d::Zero();
      for (std::size_t i = 0; i < loads.size(); ++i) {
        EXPECT_GE(loads[i], 0);
        total += loads[i];
        moment += loads[i] * InW(sole, places[i]);
      }
      EXPECT_NEAR(total, 600, 1e-6);
      EXPECT_LT((moment / total - foot.cop_m).norm(), 1e-4) << x << " " << y;
    }
  }
}

TEST(LoadInsole, IsEvenUnderTheMiddleAndAtTheEdgeForACopBeyondIt) {
  const SolePlace sole{{0, 0}, 0, 0.24};
  const auto places = InsolePlaces(sole.length_m);
  for (const double load : LoadInsole(places, sole, {160, {0.12, 0}})) EXPECT_NEAR(load, 10, 1e-6);
  const auto ahead = LoadInsole(places, sole, {160, {0.5, 0}});
  double moment = 0;
  for (std::size_t i = 0; i < ahead.size(); ++i) moment += ahead[i] * places[i].x();
  EXPECT_NEAR(moment / 160, 0.235, 1e-4);
  for (const double load : LoadInsole(places, sole, {-5, {0, 0}})) EXPECT_EQ(load, 0);
}

}  // namespace
}  // namespace footing::virtual_sensors
