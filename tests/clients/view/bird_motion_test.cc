#include "clients/view/scene/bird_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

CharacterPose Turned(double yaw_rad, bool touching) {
  CharacterPose pose = made::TickAt(0, {}).frame->characters[0];
  pose.links[0].orientation = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
  for (auto& contact : pose.contacts) contact.touching = touching;
  return pose;
}

TEST(BirdMotion, TheHeadFollowsATurnByAFilterOfAFifthOfASecond) {
  const BirdSkeleton skeleton = FindParts(made::Biped());
  BirdMotion motion = Advance({}, skeleton, Turned(0, true), 0);
  motion = Advance(motion, skeleton, Turned(1, true), 0.2);
  // One time constant after a step: 1 - 1/e.
  EXPECT_NEAR(motion.head_yaw_rad, 1 - std::exp(-1.0), 1e-9);
}

TEST(BirdMotion, ToesSpreadOnContactAndFoldInFlight) {
  const BirdSkeleton skeleton = FindParts(made::Biped());
  BirdMotion motion;
  for (int i = 0; i < 50; ++i) motion = Advance(motion, skeleton, Turned(0, true), 0.01);
  EXPECT_GT(motion.toe_spread[0], 0.99);
  EXPECT_LT(motion.wing_spread, 0.01);
  for (int i = 0; i < 50; ++i) motion = Advance(motion, skeleton, Turned(0, false), 0.01);
  EXPECT_LT(motion.toe_spread[0], 0.01);
  EXPECT_GT(motion.wing_spread, 0.9);
}

TEST(BirdMotion, AFootIsDrawnWhereItTouchedUntilItLeaves) {
  const BirdSkeleton skeleton = FindParts(made::Biped());
  const auto step = [&skeleton](BirdMotion& motion, double foot_m, bool touching) {
    CharacterPose pose = Turned(0, touching);
    pose.contacts[0].position_m.x() = foot_m;
    motion = Advance(motion, skeleton, pose, 0.01);
    return foot_m + motion.feet[0].shift_m.x();
  };
  BirdMotion motion;
  EXPECT_EQ(step(motion, 0.9, false), 0.9);
  for (int i = 0; i < 40; ++i) EXPECT_NEAR(step(motion, 1 + 0.0003 * i, true), 1, 1e-9) << i;
  // In flight it goes back to the true one without a jump.
  double drawn_m = 1;
  for (int i = 0; i < 30; ++i) {
    const double next_m = step(motion, 1.012, false);
    EXPECT_LT(std::fabs(next_m - drawn_m), 0.004) << i;
    drawn_m = next_m;
  }
  EXPECT_NEAR(drawn_m, 1.012, 1e-4);
  // A foot that really slides is seen to.
  step(motion, 1, true);
  EXPECT_NEAR(step(motion, 1.2, true), 1.17, 1e-9);
}

/// A walk along x: poses at 100 Hz, a touchdown every step.
struct Walk {
  static constexpr double kDtS = 0.01, kStepS = 0.375;
  double speed_mps = 1;
  double bounce_m = 0;
  CharacterPose pose = Turned(0, false);
  BirdMotion motion;
  double time_s = 0;

  void Advance() {
    time_s += kDtS;
    const double steps = time_s / kStepS;
    pose.links[0].position_m.x() = speed_mps * time_s;
    pose.links[0].position_m.z() = 1 + bounce_m * std::sin(2 * M_PI * steps);
    for (std::size_t foot = 0; foot < 2; ++foot) {
      const double cycle = (steps + static_cast<double>(foot)) / 2;
      pose.contacts[foot].touching = cycle - std::floor(cycle) < 0.6;
    }
    pose.gait.steps = static_cast<std::uint64_t>(steps + 1e-6);
    motion = scene::Advance(motion, FindParts(made::Biped()), pose, kDtS);
  }
  double HeadM() const { return pose.links[0].position_m.x() + motion.head_ahead.value; }
};

TEST(BirdMotion, TheHeadRestsInSpaceAndIsThrustAheadOnceAStep) {
  Walk walk;
  for (int i = 0; i < 300; ++i) walk.Advance();
  int still = 0, thrusts = 0;
  double fastest_mps = 0, least_m = 1, most_m = -1;
  const int frames = static_cast<int>(20 * Walk::kStepS / Walk::kDtS);
  for (int i = 0; i < frames; ++i) {
    const double before_m = walk.HeadM();
    const bool rested = walk.motion.head_rests;
    walk.Advance();
    const double head_mps = (walk.HeadM() - before_m) / Walk::kDtS;
    still += std::abs(head_mps) < 0.05 ? 1 : 0;
    thrusts += rested && !walk.motion.head_rests ? 1 : 0;
    fastest_mps = std::max(fastest_mps, head_mps);
    least_m = std::min(least_m, walk.motion.head_ahead.value);
    most_m = std::max(most_m, walk.motion.head_ahead.value);
  }
  EXPECT_GT(still, 0.35 * frames) << "pigeons rest it for about half of a cycle";
  EXPECT_NEAR(thrusts, 20, 2);
  EXPECT_GT(fastest_mps, 1.5);
  EXPECT_GT(least_m, -0.1201);
  EXPECT_LT(most_m, 0.1201);
}

TEST(BirdMotion, AStandingAndARunningBirdDoNotBob) {
  for (const double speed_mps : {0.0, 3.0}) {
    Walk walk;
    walk.speed_mps = speed_mps;
    for (int i = 0; i < 500; ++i) walk.Advance();
    for (int i = 0; i < 100; ++i) {
      walk.Advance();
      EXPECT_NEAR(walk.motion.head_ahead.value, 0, 0.005) << speed_mps;
    }
  }
}

TEST(BirdMotion, TheTailLagsBehindABounceAndComesToRest) {
  Walk walk;
  walk.bounce_m = 0.04;
  double most_rad = 0;
  for (int i = 0; i < 300; ++i) {
    walk.Advance();
    most_rad = std::max(most_rad, std::abs(walk.motion.tail_pitch.value));
  }
  EXPECT_GT(most_rad, 0.1);
  EXPECT_LE(most_rad, 0.5);
  walk.bounce_m = 0;
  for (int i = 0; i < 300; ++i) walk.Advance();
  EXPECT_NEAR(walk.motion.tail_pitch.value, 0, 0.01);
}

TEST(BirdMotion, TheTailSwingsToTheInsideOfATurn) {
  const BirdSkeleton skeleton = FindParts(made::Biped());
  BirdMotion motion = Advance({}, skeleton, Turned(0, true), 0);
  for (int i = 1; i <= 100; ++i) motion = Advance(motion, skeleton, Turned(0.02 * i, true), 0.01);
  EXPECT_NEAR(motion.tail_yaw.value, 0.15 * 2, 0.02);
}

TEST(BirdMotion, EyesBlinkAtEveryEighthStepAndOpenAgain) {
  Walk walk;
  int closed = 0, blinks = 0;
  bool was_closed = false;
  for (int i = 0; i < 6000; ++i) {
    walk.Advance();
    const bool is_closed = walk.motion.lid > 0.5;
    closed += is_closed ? 1 : 0;
    blinks += is_closed && !was_closed ? 1 : 0;
    was_closed = is_closed;
  }
  EXPECT_NEAR(blinks, 60 / (8 * Walk::kStepS), 1);
  EXPECT_LT(closed, 20 * blinks);
}

TEST(BirdMotion, ForgetsWhatWasShownSomeSecondsAgo) {
  Walk walk, other;
  for (int i = 0; i < 137; ++i) other.Advance();  // Begins elsewhere in the cycle, and with a jolt.
  walk = other;
  walk.motion = {};
  walk.motion.placed = false;
  for (int i = 0; i < 800; ++i) {
    walk.Advance();
    other.Advance();
  }
  EXPECT_NEAR(walk.motion.head_ahead.value, other.motion.head_ahead.value, 1e-6);
  EXPECT_NEAR(walk.motion.tail_pitch.value, other.motion.tail_pitch.value, 1e-6);
  EXPECT_EQ(walk.motion.lid, other.motion.lid);
}

TEST(BirdMotion, EyesLookAtTheNextFoothold) {
  Walk walk;
  walk.pose.gait.next_foothold_m = {1000, 300};  // To the left, far away.
  walk.speed_mps = 0;
  for (int i = 0; i < 200; ++i) walk.Advance();
  EXPECT_NEAR(walk.motion.gaze_yaw_rad, std::atan2(300, 1000), 0.01);
  EXPECT_NEAR(walk.motion.gaze_pitch_rad, 0, 0.01);
  walk.pose.gait.next_foothold_m = {0.8, -0.1};  // Right before the feet.
  for (int i = 0; i < 200; ++i) walk.Advance();
  EXPECT_LT(walk.motion.gaze_yaw_rad, -0.1);
  EXPECT_NEAR(walk.motion.gaze_pitch_rad, -0.6, 0.01) << "as far as eyes turn";
}

TEST(BirdMotion, WingsOpenForBalance) {
  const BirdSkeleton skeleton = FindParts(made::Biped());
  CharacterPose pose = Turned(0, true);
  BirdMotion motion;
  for (const double lean_rad : {0.1, 0.4}) {
    pose.links[0].orientation = Eigen::AngleAxisd(lean_rad, Eigen::Vector3d::UnitX());
    for (int i = 0; i < 300; ++i) motion = Advance(motion, skeleton, pose, 0.01);
    if (lean_rad < 0.12) {
      EXPECT_LT(motion.wing_spread, 0.01);
    } else {
      EXPECT_NEAR(motion.wing_spread, 0.42, 0.05);
    }
  }
}

TEST(BirdMotion, ABodyThatIsPutElsewhereStartsThere) {
  Walk walk;
  for (int i = 0; i < 300; ++i) walk.Advance();
  walk.pose.links[0].position_m.x() += 50;
  walk.motion = scene::Advance(walk.motion, FindParts(made::Biped()), walk.pose, Walk::kDtS);
  EXPECT_EQ(walk.motion.head_ahead.value, 0);
  EXPECT_EQ(walk.motion.tail_pitch.value, 0);
}

TEST(FindParts, GoesByNameNotByPlace) {
  stream::Skeleton skeleton = made::Biped();
  std::swap(skeleton.links[1], skeleton.links[3]);
  std::swap(skeleton.contact_points[0], skeleton.contact_points[1]);
  const BirdSkeleton found = FindParts(skeleton);
  EXPECT_EQ(found.hips[0], 3);
  EXPECT_EQ(found.feet[0], 1);
}

}  // namespace
}  // namespace footing::scene
