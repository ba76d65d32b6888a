#include "daemon/offline/eval/fusion.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace footing::eval {
namespace {

/// A leg of two segments of 0.5 m, bent so that the knee is 0.3 m from the line of 0.8 m.
LegPlaces Bent() { return {{0, 0, 0.9}, {0.3, 0, 0.5}, {0, 0, 0.1}}; }

LegPlaces Moved(const LegPlaces& leg, const Eigen::Isometry3d& by) {
  return {by * leg.hip, by * leg.knee, by * leg.ankle};
}

TEST(SplitKneeError, AKneeThatIsTurnedAboutTheLineFromHipToAnkleIsOffByThatAlone) {
  constexpr double kTurnRad = 0.4;
  LegPlaces estimate = Bent();
  estimate.knee = Eigen::AngleAxisd(kTurnRad, -Eigen::Vector3d::UnitZ()) * estimate.knee;
  const KneeError error = SplitKneeError(Bent(), estimate);
  EXPECT_NEAR(error.turn_rad, kTurnRad, 1e-12);  // The line points down.
  EXPECT_NEAR(error.unturned_m, 0, 1e-12);
}

TEST(SplitKneeError, ALegThatIsMovedIsNotTurned) {
  const Eigen::Isometry3d by(Eigen::Translation3d(0.1, -0.05, 0.02));
  const KneeError error = SplitKneeError(Bent(), Moved(Bent(), by));
  EXPECT_NEAR(error.turn_rad, 0, 1e-12);
  EXPECT_NEAR(error.unturned_m, std::sqrt(0.01 + 0.0025 + 0.0004), 1e-12);
}

TEST(SplitKneeError, ALegThatLeansInItsOwnPlaneIsNotTurned) {
  const Eigen::Isometry3d by(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(SplitKneeError(Bent(), Moved(Bent(), by)).turn_rad, 0, 1e-12);
}

TEST(SplitKneeError, ALegThatBendsFurtherIsNotTurned) {
  LegPlaces estimate = Bent();
  estimate.knee.x() += 0.07;
  const KneeError error = SplitKneeError(Bent(), estimate);
  EXPECT_NEAR(error.turn_rad, 0, 1e-12);
  EXPECT_NEAR(error.unturned_m, 0.07, 1e-12);
}

TEST(SplitKneeError, AStraightLegHasNoTurn) {
  LegPlaces straight = Bent();
  straight.knee.x() = 0;
  const KneeError error = SplitKneeError(Bent(), straight);
  EXPECT_EQ(error.turn_rad, 0);
  EXPECT_NEAR(error.unturned_m, 0.3, 1e-12);
}

}  // namespace
}  // namespace footing::eval
