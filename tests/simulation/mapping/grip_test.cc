#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "common/base/units.h"
#include "common/virtual/people/person.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/simulation/mapping/arm.h"
#include "tests/simulation/test_world.h"

/// The arm interface behind the features of synthetic users whose remotes lie rotated in the hands.
namespace footing::mapping {
namespace {

using stream::Gait;

constexpr double kJumpsS = 5;

/// The body and the two remotes of a user, and footingd's chain behind them.
class ArmUser {
 public:
  ArmUser(std::uint64_t seed, double grip_deg)
      : person_(stream::UserInterface::kArm, StyleOf(seed, grip_deg), seed), random_(seed) {}

  Inputs Advance(double time_s, const users::Intention& wanted) {
    person_.Advance(time_s, wanted);
    const std::int64_t now_ns = SecondsToNanoseconds(time_s);
    for (std::size_t hand = 0; hand < 2; ++hand) {
      const users::FeltRemote& remote = person_.felt().remotes[hand];
      const auto reading = wrists::Read(sensor_, remote.specific_force_S_mps2, random_);
      chain_.Add(hand == 0 ? eval::kLeftDevice : eval::kRightDevice, now_ns,
                 reading.specific_force_mps2, reading.clipped_axes);
    }
    TakeFeatures(chain_.Compute(now_ns), 0, inputs_);
    return inputs_;
  }

 private:
  /// Mirror images of each other.
  static users::Style StyleOf(std::uint64_t seed, double grip_deg) {
    users::Style style = users::DrawStyle(seed);
    style.left_grip_rad = DegreesToRadians(grip_deg);
    style.right_grip_rad = -style.left_grip_rad;
    return style;
  }

  users::Person person_;
  noise::Random random_;
  wrists::SensorModel sensor_;
  eval::Chain chain_{true};
  Inputs inputs_;
};

/// What a user does who stands, walks, and jumps.
users::Intention WantedAt(double time_s) {
  if (time_s < 1) return {};
  if (time_s < kJumpsS) return {.gait = Gait::kWalk, .effort = 0.5};
  return {.gait = Gait::kJump, .effort = 0.5};
}

/// How long after the motion of the jump begins it is commanded; negative: before.
double SecondsToTheJump(std::uint64_t seed, double grip_deg) {
  ArmUser user(seed, grip_deg);
  ArmInterface arm(ParseArmMapping(test::DataFile(kArmMappingFile), kArmMappingFile).value());
  for (int tick = 1; tick <= 800; ++tick) {
    const double time_s = 0.01 * tick;
    const auto command = arm.Advance(time_s, user.Advance(time_s, WantedAt(time_s)));
    if (command.gait == Gait::kJump) return time_s - kJumpsS;
  }
  return INFINITY;
}

TEST(ArmGrip, MirroredGripsDelayNoJumpOutOfAWalk) {
  double straight_s = 0, mirrored_s = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const double grip_deg : {-45.0, 0.0, 45.0}) {
      const double jump_s = SecondsToTheJump(seed, grip_deg);
      EXPECT_GT(jump_s, 0) << seed << ", grips of " << grip_deg << " degrees";
      (grip_deg == 0 ? straight_s : mirrored_s) += grip_deg == 0 ? jump_s : jump_s / 2;
    }
  }
  // A quarter of a cycle of these walks.
  EXPECT_NEAR(mirrored_s / 3, straight_s / 3, 0.2);
}

}  // namespace
}  // namespace footing::mapping
