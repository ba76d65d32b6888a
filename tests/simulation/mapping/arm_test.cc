#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/virtual/people/person.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/simulation/mapping/arm.h"
#include "tests/simulation/mapping/arm_motion.h"
#include "tests/simulation/test_world.h"

namespace footing::mapping {
namespace {

using stream::Gait;

constexpr double kTwistStepRad = DegreesToRadians(5);

ArmInterface NewArm() {
  return ArmInterface(ParseArmMapping(test::DataFile(kArmMappingFile), kArmMappingFile).value());
}

ArmSwing Walking() { return {.frequency_hz = 1.0}; }
ArmSwing Running() { return {.frequency_hz = 1.8, .swing_rad = 0.35, .elbow_rad = kPi / 2}; }

/// The command after 5 s of the same motion from rest.
biped::GaitCommand After5S(const ArmSwing& motion, bool mounted,
                           stream::InterfaceState* state = nullptr) {
  Arms arms(mounted);
  ArmInterface arm = NewArm();
  biped::GaitCommand command;
  while (arms.time_s() < 5) {
    const Inputs inputs = arms.Advance(motion);
    command = arm.Advance(arms.time_s(), inputs);
  }
  if (state != nullptr) *state = arm.state();
  return command;
}

/// The turn a step after 4 s of going straight from rest, and 5 s more with the arms twisted.
double TurnWith(ArmSwing motion, double twist_deg, bool mounted) {
  Arms arms(mounted);
  ArmInterface arm = NewArm();
  biped::GaitCommand command;
  while (arms.time_s() < 9) {
    motion.twist_rad = arms.time_s() < 4 ? 0 : DegreesToRadians(twist_deg);
    const Inputs inputs = arms.Advance(motion);
    command = arm.Advance(arms.time_s(), inputs);
  }
  return command.turn_per_step_rad;
}

/// Turn that `twist_deg` to the right commands.
double TurnFor(double twist_deg) {
  return twist_deg > 0 ? -kTwistStepRad : twist_deg < 0 ? kTwistStepRad : 0;
}

TEST(Arm, StraightArmsWalkAndBentArmsRunWhateverTheGrip) {
  for (const bool mounted : {false, true}) {
    for (const double left_deg : {-45.0, 0.0, 45.0}) {
      for (const double right_deg : {-45.0, 0.0, 45.0}) {
        ArmSwing walking = Walking(), running = Running();
        walking.grip_left_rad = running.grip_left_rad = DegreesToRadians(left_deg);
        walking.grip_right_rad = running.grip_right_rad = DegreesToRadians(right_deg);
        EXPECT_EQ(After5S(walking, mounted).gait, Gait::kWalk) << left_deg << ", " << right_deg;
        EXPECT_EQ(After5S(running, mounted).gait, Gait::kRun) << left_deg << ", " << right_deg;
      }
    }
  }
}

TEST(Arm, GripsThatMirrorEachOtherDoNotTurn) {
  for (const bool mounted : {false, true}) {
    for (const ArmSwing& swing : {Walking(), Running()}) {
      ArmSwing motion = swing;
      motion.grip_left_rad = DegreesToRadians(45);
      motion.grip_right_rad = DegreesToRadians(-45);
      EXPECT_EQ(After5S(motion, mounted).turn_per_step_rad, 0) << motion.elbow_rad;
    }
  }
}

TEST(Arm, TwistedStraightArmsAndInclinedBentOnesTurnToTheirSide) {
  for (const bool mounted : {false, true}) {
    for (const ArmSwing& swing : {Walking(), Running()}) {
      for (const double twist_deg : {-35.0, 0.0, 35.0}) {
        for (const double grip_deg : {0.0, 40.0}) {
          ArmSwing motion = swing;
          motion.grip_left_rad = DegreesToRadians(grip_deg);
          motion.grip_right_rad = DegreesToRadians(-grip_deg);
          EXPECT_NEAR(TurnWith(motion, twist_deg, mounted), TurnFor(twist_deg), 1e-9)
              << twist_deg << " degrees, grip " << grip_deg << ", elbow " << swing.elbow_rad;
        }
      }
    }
  }
}

TEST(Arm, GripsOfUpTo45DegreesInAnyCombinationNeitherTurnNorKeepFromTurning) {
  for (const ArmSwing& swing : {Walking(), Running()}) {
    for (const double left_deg : {-45.0, 0.0, 45.0}) {
      for (const double right_deg : {-45.0, 0.0, 45.0}) {
        for (const double twist_deg : {-35.0, 0.0, 35.0}) {
          ArmSwing motion = swing;
          motion.grip_left_rad = DegreesToRadians(left_deg);
          motion.grip_right_rad = DegreesToRadians(right_deg);
          EXPECT_NEAR(TurnWith(motion, twist_deg, false), TurnFor(twist_deg), 1e-9)
              << left_deg << ", " << right_deg << ", twist " << twist_deg << ", elbow "
              << swing.elbow_rad;
        }
      }
    }
  }
}

/// Advances both for `seconds` of a motion; the turn a step at the end.
double Go(Arms& arms, ArmInterface& arm, const ArmSwing& motion, double seconds) {
  biped::GaitCommand command;
  for (const double until_s = arms.time_s() + seconds; arms.time_s() < until_s;) {
    const Inputs inputs = arms.Advance(motion);
    command = arm.Advance(arms.time_s(), inputs);
  }
  return command.turn_per_step_rad;
}

TEST(Arm, APutBackKeepsTheGripAndANewTrialLearnsItAgain) {
  Arms arms(false);
  ArmInterface arm = NewArm();
  ArmSwing twisted = Walking();
  twisted.twist_rad = DegreesToRadians(35);
  EXPECT_EQ(Go(arms, arm, Walking(), 4), 0);
  EXPECT_NEAR(Go(arms, arm, twisted, 4), -kTwistStepRad, 1e-9);
  arm.StartAgain();
  EXPECT_NEAR(Go(arms, arm, twisted, 4), -kTwistStepRad, 1e-9);
  arm.RenewGrip();
  EXPECT_EQ(Go(arms, arm, twisted, 4), 0);
}

TEST(Arm, AHandThatWasAwayForLongMayHoldItsControllerOtherwise) {
  for (const double away_s : {1.0, 6.0}) {
    Arms arms(false);
    ArmInterface arm = NewArm();
    Go(arms, arm, Walking(), 4);
    ArmSwing turned = Walking();
    turned.grip_left_rad = turned.grip_right_rad = DegreesToRadians(40);
    for (const double until_s = arms.time_s() + away_s; arms.time_s() < until_s;) {
      Inputs inputs = arms.Advance(turned);
      inputs.hands.left = {};
      arm.Advance(arms.time_s(), inputs);
    }
    EXPECT_EQ(Go(arms, arm, turned, 4) != 0, away_s < 5) << away_s;
  }
}

TEST(Arm, AGripThatARunHasShownHoldsInAWalkAndTheOtherWayRound) {
  for (const double grip_deg : {-40.0, 0.0, 40.0}) {
    for (const bool run_first : {true, false}) {
      for (const double twist_deg : {-35.0, 0.0, 35.0}) {
        Arms arms(false);
        ArmInterface arm = NewArm();
        ArmSwing first = run_first ? Running() : Walking();
        ArmSwing then = run_first ? Walking() : Running();
        for (ArmSwing* motion : {&first, &then}) {
          motion->grip_left_rad = motion->grip_right_rad = DegreesToRadians(grip_deg);
        }
        Go(arms, arm, first, 4);
        then.twist_rad = DegreesToRadians(twist_deg);
        EXPECT_NEAR(Go(arms, arm, then, 4), TurnFor(twist_deg), 1e-9)
            << grip_deg << ", twist " << twist_deg << ", run first: " << run_first;
      }
    }
  }
}

TEST(Arm, ArmsThatSwingTogetherJump) {
  for (ArmSwing motion : {Walking(), Running()}) {
    motion.phase_rad = 0;
    const auto command = After5S(motion, false);
    EXPECT_EQ(command.gait, Gait::kJump);
    EXPECT_GT(command.height_m, 0.08);
  }
}

TEST(Arm, TheFrequencySetsTheSpeedWithinAGait) {
  ArmSwing slow = Walking(), fast = Walking();
  slow.frequency_hz = 0.9;
  fast.frequency_hz = 1.4;
  const double slow_mps = After5S(slow, false).speed_mps, fast_mps = After5S(fast, false).speed_mps;
  EXPECT_NEAR(slow_mps, 0.2 + 0.2 / 0.9 * 1.2, 0.03);  // 0.7 to 1.6 Hz are 0.2 to 1.4 m/s.
  EXPECT_NEAR(fast_mps, 0.2 + 0.7 / 0.9 * 1.2, 0.03);
}

TEST(Arm, BendingAndStretchingHaveHysteresis) {
  ArmInterface arm = NewArm();
  const auto gait_at = [&](double from_s, double elevation_deg) {
    LimbFeatures hand{.present = true, .moving = true, .frequency_valid = true, .frequency_hz = 1};
    hand.inclination_valid = true;
    hand.pitch_rad = DegreesToRadians(elevation_deg);
    Inputs inputs;
    inputs.hands = {.left = hand, .right = hand, .phase_valid = true, .phase_rad = kPi};
    biped::GaitCommand command;
    for (int i = 0; i < 200; ++i) command = arm.Advance(from_s + 0.01 * i, inputs);
    return command.gait;
  };
  EXPECT_EQ(gait_at(0, -80), Gait::kWalk);
  EXPECT_EQ(gait_at(2, -45), Gait::kWalk);
  EXPECT_EQ(gait_at(4, -30), Gait::kRun);
  EXPECT_EQ(gait_at(6, -45), Gait::kRun);
  EXPECT_EQ(gait_at(8, -60), Gait::kWalk);
}

TEST(Arm, ItsBeliefShowsTheForearmsAndWhatIsMissing) {
  stream::InterfaceState state;
  After5S(Running(), true, &state);
  EXPECT_EQ(state.interface, stream::UserInterface::kArm);
  EXPECT_EQ(state.activity, stream::Activity::kAlternate);
  EXPECT_EQ(state.gait, Gait::kRun);
  ASSERT_TRUE(state.forearms.valid);
  EXPECT_GT(state.forearms.elevation_rad, DegreesToRadians(-25));
  EXPECT_EQ(state.missing_roles, 0u);
  ArmInterface arm = NewArm();
  EXPECT_EQ(arm.Advance(0, {}).turn_per_step_rad, 0);
  EXPECT_EQ(arm.state().activity, stream::Activity::kAbsent);
}

TEST(ArmMapping, RefusesBordersThatCross) {
  std::string text = test::DataFile(kArmMappingFile);
  const std::string key = "\"straight_arm_below_deg\": -50.0";
  text.replace(text.find(key), key.size(), "\"straight_arm_below_deg\": -30.0");
  EXPECT_FALSE(ParseArmMapping(text, kArmMappingFile).ok());
}

}  // namespace

/// The arm interface behind the features of synthetic users whose remotes lie rotated in the hands.
namespace {

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

/// Intention of a user who stands, walks, and jumps.
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

/// The same rotation every 10 ms, for `seconds` from `from_s`.
void Go(NeutralGrip& grip, double from_s, double seconds, double rotation_deg) {
  for (int i = 0; i < 100 * seconds; ++i) {
    grip.Stride(from_s + 0.01 * i, DegreesToRadians(rotation_deg), 0.8);
  }
}

double TwistDegrees(const NeutralGrip& grip, double rotation_deg) {
  return RadiansToDegrees(grip.TwistOf(DegreesToRadians(rotation_deg)).value());
}

TEST(NeutralGrip, WithoutARestItIsTheMeanOfTheFirstCycleAndNotKnownBefore) {
  NeutralGrip grip;
  Go(grip, 0, 1.2, 45);  // A cycle at 0.8 Hz takes 1.25 s.
  EXPECT_FALSE(grip.known());
  EXPECT_FALSE(grip.TwistOf(0));
  Go(grip, 1.2, 0.1, 45);
  ASSERT_TRUE(grip.known());
  EXPECT_NEAR(TwistDegrees(grip, 80), 35, 1e-9);
}

TEST(NeutralGrip, StridesThatWereTooFewDoNotCount) {
  NeutralGrip grip;
  Go(grip, 0, 1, -45);
  grip.Rest();
  Go(grip, 2, 1, 45);
  EXPECT_FALSE(grip.known());
  Go(grip, 3, 0.5, 45);
  EXPECT_NEAR(TwistDegrees(grip, 45), 0, 1e-9);
  grip.Rest();
  EXPECT_TRUE(grip.known());
}

TEST(NeutralGrip, ATwistNeverBecomesTheNeutralHoweverLongItLasts) {
  NeutralGrip grip;
  Go(grip, 0, 3, 10);
  Go(grip, 3, 120, 35);
  EXPECT_NEAR(TwistDegrees(grip, 35), 25, 1e-9);
}

TEST(NeutralGrip, FollowsAGripThatSlips) {
  NeutralGrip grip;
  for (int second = 0; second < 300; ++second) Go(grip, second, 1, 0.1 * second);
  EXPECT_LT(std::fabs(TwistDegrees(grip, 30)), 5);  // 0.1 degrees a second, with a lag of 30 s.
}

/// Arms that hang still at the same rotation, every 10 ms.
void Hang(NeutralGrip& grip, double from_s, double seconds, double rotation_deg) {
  for (int i = 0; i < 100 * seconds; ++i) {
    grip.Hang(from_s + 0.01 * i, DegreesToRadians(rotation_deg));
  }
}

TEST(NeutralGrip, ArmsThatHungStillShowItBeforeTheFirstStrideWhichMayTurn) {
  NeutralGrip grip;
  Hang(grip, 0, 0.6, 30);
  Go(grip, 0.7, 5, 66);  // A twist of 36 degrees from the first stride on.
  EXPECT_NEAR(TwistDegrees(grip, 66), 36, 1e-9);
}

TEST(NeutralGrip, TheLastMomentOfARestIsAMotionThatBegins) {
  NeutralGrip grip;
  Hang(grip, 0, 0.6, 30);
  Hang(grip, 0.6, 0.19, 45);
  Go(grip, 0.79, 1, 66);
  EXPECT_NEAR(TwistDegrees(grip, 66), 36, 1e-9);
}

TEST(NeutralGrip, IsRenewedByTheRestThatGoesOnElseByWhatComes) {
  NeutralGrip grip;
  Hang(grip, 0, 1, 10);
  Go(grip, 1, 3, 10);
  Hang(grip, 4, 1, 40);
  EXPECT_NEAR(TwistDegrees(grip, 40), 30, 1e-9);
  grip.Renew();
  EXPECT_NEAR(TwistDegrees(grip, 40), 0, 1e-9);
  Go(grip, 5, 3, 40);
  grip.Renew();
  EXPECT_FALSE(grip.known());
  Go(grip, 8, 2, -20);
  EXPECT_NEAR(TwistDegrees(grip, -20), 0, 1e-9);
}

TEST(NeutralGrip, LaterRestsDoNotCount) {
  NeutralGrip grip;
  Hang(grip, 0, 1, 10);
  Go(grip, 1, 3, 10);
  Hang(grip, 4, 3, 46);
  EXPECT_NEAR(TwistDegrees(grip, 46), 36, 1e-9);
}

}  // namespace
}  // namespace footing::mapping
