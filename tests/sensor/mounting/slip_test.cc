#include "daemon/sensor/mounting/slip.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "common/base/units.h"

namespace footing::mounting {
namespace {

using stream::DeviceRole;

class SlipTest : public testing::Test {
 protected:
  /// `seconds` of a force of 1 g that leans by `lean_deg` to the side, plus a swing.
  bool Feel(SlipWatch& watch, double seconds, double lean_deg,
            const Eigen::Vector3d& swing_mps2 = Eigen::Vector3d::Zero()) {
    const double lean_rad = DegreesToRadians(lean_deg);
    for (int i = 0; i < static_cast<int>(seconds * 100); ++i) {
      now_ns_ += 10'000'000;
      stream::MotionSample sample;
      sample.sampled_ns = now_ns_;
      sample.specific_force_mps2 =
          kStandardGravityMps2 * Eigen::Vector3d(std::sin(lean_rad), 0, -std::cos(lean_rad)) +
          swing_mps2 * std::sin(2 * kPi * NanosecondsToSeconds(now_ns_));
      watch.Advance(sample);
    }
    return watch.slipped();
  }
  std::int64_t now_ns_ = 0;
};

TEST_F(SlipTest, AShinThatLeansAtRestHasSlipped) {
  SlipWatch watch(DeviceRole::kLeftLeg);
  EXPECT_FALSE(Feel(watch, 20, 15));
  EXPECT_FALSE(Feel(watch, 2, 40));
  EXPECT_FALSE(Feel(watch, 2, 0)) << "a moment is no slip";
  EXPECT_TRUE(Feel(watch, 4, 40));
  EXPECT_TRUE(Feel(watch, 20, 0)) << "stays until it is mounted anew";
}

TEST_F(SlipTest, AnArmHeldUpHasNotSlipped) {
  SlipWatch watch(DeviceRole::kRightHand);
  EXPECT_FALSE(Feel(watch, 60, 120));
}

TEST_F(SlipTest, AHeadMayLookDownAndATrunkLean) {
  for (const DeviceRole role : {DeviceRole::kHead, DeviceRole::kTrunk}) {
    SlipWatch watch(role);
    EXPECT_FALSE(Feel(watch, 60, 40));
    EXPECT_TRUE(Feel(watch, 5, 80));
  }
}

TEST_F(SlipTest, ABandThatTurnedAboutTheWristSwingsSideways) {
  SlipWatch watch(DeviceRole::kLeftHand);
  EXPECT_FALSE(Feel(watch, 30, 0, {0, 4, 3}));
  EXPECT_FALSE(Feel(watch, 5, 0, {4, 1, 3})) << "a wave to the side";
  EXPECT_FALSE(Feel(watch, 3, 0, {0, 4, 3}));
  EXPECT_TRUE(Feel(watch, 15, 0, {4, 1, 3}));
}

}  // namespace
}  // namespace footing::mounting
