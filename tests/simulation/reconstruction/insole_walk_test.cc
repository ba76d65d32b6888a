#include "daemon/simulation/reconstruction/insole_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/base/units.h"
#include "tests/simulation/reconstruction/made_person.h"

namespace footing::reconstruction {
namespace {

constexpr double kSpeedMps = 1;
constexpr double kInsoleWalkStepS = 0.55;

class Walker {
 public:
  Walker() : person_(MadePerson()), at_(person_.skeleton) {
    const Models models = MakeModels({BasisOf(person_, MadeMotion(person_, 16))}).value();
    Options options;
    options.rate_hz = kMadeRateHz;
    walk_ = InsoleWalk::Create(person_, models, options).value();
    body::ComputeKinematics(person_.skeleton, body::TPose(person_.skeleton, person_.landmarks),
                            at_);
  }

  /// Stands so long, then walks along x: hands at the level of a T-pose, feet in turns.
  InsoleInputs At(double t_s) const {
    InsoleInputs inputs;
    inputs.time_s = t_s;
    const double walked_s = std::max(0.0, t_s - kMadeStandS);
    const bool left = std::fmod(walked_s, 2 * kInsoleWalkStepS) < kInsoleWalkStepS;
    for (std::size_t f = 0; f < 2; ++f) {
      const double share = walked_s == 0 ? 0.5 : (f == 0) == left ? 1 : 0;
      inputs.feet[f].valid = true;
      inputs.feet[f].count = 1;
      inputs.feet[f].p_S_m[0].x() = 0.1;
      inputs.feet[f].load_n[0] = share * KilogramsToNewtons(person_.mass_kg);
    }
    for (int side = 0; side < 2; ++side) {
      const body::Point fist = body::Fist(person_, side);
      const auto joint = static_cast<std::size_t>(fist.joint);
      HandInput& hand = inputs.hands[static_cast<std::size_t>(side)];
      hand.valid = true;
      hand.p_W_m = body::Place(fist, at_.R_WJ[joint], at_.p_WJ[joint]) +
                   Eigen::Vector3d(3 + kSpeedMps * walked_s, -2, 0);
    }
    return inputs;
  }

  InsoleWalk& walk() { return *walk_; }

 private:
  body::Body person_;
  body::Kinematics at_;
  std::optional<InsoleWalk> walk_;
};

TEST(InsoleWalk, StandsUnderTheHandsWhileItIsCalibrated) {
  Walker walker;
  for (int i = 0; i < kMadeStandS * kMadeRateHz; ++i) walker.walk().Advance(walker.At(i / 60.0));
  EXPECT_TRUE(walker.walk().output().calibrated);
  const Eigen::Vector2d middle = 0.5 * (walker.walk().place_m(0) + walker.walk().place_m(1));
  EXPECT_NEAR(middle.x(), 3, 0.15);
  EXPECT_NEAR(middle.y(), -2, 0.02);
  EXPECT_NEAR(walker.walk().output().q(0), 3, 0.15);
}

TEST(InsoleWalk, FollowsSomebodyWhoWalksAwayAndStandsStillOnTheFootThatCarries) {
  Walker walker;
  std::array<Eigen::Vector2d, 2> before;
  std::array<bool, 2> carried{};
  double off = 0;
  int frames = 0;
  for (int i = 0; i < 26 * kMadeRateHz; ++i) {
    const InsoleInputs inputs = walker.At(i / 60.0);
    const Output& output = walker.walk().Advance(inputs);
    ASSERT_TRUE(output.q.allFinite());
    for (std::size_t f = 0; f < 2; ++f) {
      const bool carries = walker.walk().contact(f);
      if (carries && carried[f]) {
        EXPECT_EQ(walker.walk().place_m(f).x(), before[f].x()) << i;
      }
      before[f] = walker.walk().place_m(f);
      carried[f] = carries;
    }
    if (inputs.time_s < 16) continue;
    // Somewhere under the hands, 10 to 20 m away from where it began.
    const double hands = 0.5 * (inputs.hands[0].p_W_m + inputs.hands[1].p_W_m).x();
    off += std::abs(output.q(0) - hands);
    ++frames;
  }
  EXPECT_LT(off / frames, 0.25);
  EXPECT_GT(walker.walk().output().q(0), 3 + 19);
}

TEST(InsoleWalk, IsFiniteWhateverTheSensorsSay) {
  Walker walker;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 9 * kMadeRateHz; ++i) {
    InsoleInputs inputs = walker.At(i / 60.0);
    if (inputs.time_s > 6.5 && i % 3 == 0) {
      inputs.feet[0].load_n[0] = nan;
      inputs.hands[1].p_W_m.x() = nan;
      inputs.feet[1].p_S_m[0].x() = i % 2 == 0 ? nan : 1e300;
    }
    if (i % 50 == 1) inputs.hands[0].valid = inputs.feet[1].valid = false;
    const Output& output = walker.walk().Advance(inputs);
    ASSERT_TRUE(output.q.allFinite()) << i;
    ASSERT_TRUE(walker.walk().place_m(0).allFinite() && walker.walk().place_m(1).allFinite()) << i;
  }
}

TEST(InsoleWalk, CellsThatFallSilentLeaveTheFootLessAndLessSure) {
  Walker walker;
  double t_s = 0;
  for (; t_s < 9; t_s += 1 / kMadeRateHz) walker.walk().Advance(walker.At(t_s));
  const double sure_m2 = walker.walk().output().momentum.feet[0].variance_m2.x();
  EXPECT_LT(sure_m2, 0.01);
  double last_m2 = sure_m2;
  for (int second = 0; second < 3; ++second) {
    for (int i = 0; i < kMadeRateHz; ++i, t_s += 1 / kMadeRateHz) {
      InsoleInputs inputs = walker.At(t_s);
      inputs.feet[0].valid = inputs.feet[1].valid = false;
      ASSERT_TRUE(walker.walk().Advance(inputs).q.allFinite());
    }
    const double now_m2 = walker.walk().output().momentum.feet[0].variance_m2.x();
    EXPECT_GE(now_m2, last_m2);
    last_m2 = now_m2;
  }
  EXPECT_NEAR(std::sqrt(last_m2), 0.6, 1e-9) << "as far as it can be";
  EXPECT_FALSE(walker.walk().output().valid);
  for (int i = 0; i < kMadeRateHz; ++i, t_s += 1 / kMadeRateHz)
    walker.walk().Advance(walker.At(t_s));
  EXPECT_LT(walker.walk().output().momentum.feet[0].variance_m2.x(), 0.01);
}

TEST(InsoleWalk, ASwingingFootThatBrushesTheGroundHasNotLanded) {
  Walker walker, brushing;
  for (double t_s = 0; t_s < 14; t_s += 1 / kMadeRateHz) {
    InsoleInputs inputs = walker.At(t_s);
    walker.walk().Advance(inputs);
    const double into_s = std::fmod(std::max(0.0, t_s - kMadeStandS), kInsoleWalkStepS);
    if (t_s > 8 && into_s > 0.2 && into_s < 0.3) {
      for (InsoleFoot& foot : inputs.feet) foot.load_n[0] = std::max(foot.load_n[0], 90.0);
    }
    brushing.walk().Advance(inputs);
    if (t_s < kMadeStandS) continue;
    for (std::size_t f = 0; f < 2; ++f) {
      ASSERT_NEAR(walker.walk().place_m(f).x(), brushing.walk().place_m(f).x(), 0.02) << t_s;
    }
  }
}

TEST(InsoleWalk, WithoutHandsItStaysBoundedAndGoesAheadWithTheSteps) {
  Walker walker;
  const double start_m = walker.walk().output().q(0);
  for (double t_s = 0; t_s < 20; t_s += 1 / kMadeRateHz) {
    InsoleInputs inputs = walker.At(t_s);
    for (HandInput& hand : inputs.hands) hand.valid = false;
    ASSERT_TRUE(walker.walk().Advance(inputs).q.allFinite());
  }
  const double gone_m = walker.walk().output().q(0) - start_m;
  EXPECT_GT(gone_m, 5);
  EXPECT_LT(gone_m, 14 * 2);  // No faster than 2 m/s.
}

TEST(InsoleWalk, ACalibrationThatIsAskedForBeginsAnew) {
  Walker walker;
  for (double t_s = 0; t_s < 8; t_s += 1 / kMadeRateHz) walker.walk().Advance(walker.At(t_s));
  ASSERT_TRUE(walker.walk().output().calibrated);
  walker.walk().Recalibrate();
  EXPECT_FALSE(walker.walk().output().calibrated);
  EXPECT_EQ(walker.walk().output().calibration_progress, 0);
  for (double t_s = 0; t_s < kMadeStandS; t_s += 1 / kMadeRateHz)
    walker.walk().Advance(walker.At(t_s));
  EXPECT_TRUE(walker.walk().output().calibrated);
  EXPECT_NEAR(walker.walk().output().q(0), 3, 0.15);
}

TEST(StepPattern, ASwingClearsTheGroundAndIsTheSameBackwardsTheOtherWayRound) {
  for (double share = 0; share <= 1; share += 0.05) {
    const FootRise ahead = SwingRise(share, 0.33), back = SwingRise(1 - share, -0.33);
    EXPECT_GT(ahead.ankle_m, 0.02);
    EXPECT_GT(ahead.ball_m, 0.02);
    EXPECT_NEAR(ahead.ankle_m, back.ankle_m, 1e-12);
    EXPECT_NEAR(ahead.ball_m, back.ball_m, 1e-12);
    EXPECT_LT(SwingRise(share, 10).ankle_m, 0.3);
    EXPECT_DOUBLE_EQ(SwingRise(share, 0).ball_m, 0.03);
  }
  EXPECT_GT(SwingRise(0.25, 0.33).ankle_m, SwingRise(0.8, 0.33).ankle_m)
      << "the heel goes up first";
  EXPECT_GT(SwingRise(0.8, 0.33).ball_m, SwingRise(0.8, 0.33).ankle_m) << "the heel lands first";
  EXPECT_EQ(SwingWay(0), 0);
  EXPECT_EQ(SwingWay(0.5), 0.5);
  EXPECT_EQ(SwingWay(1), 1);
}

TEST(StepPattern, TimesFollowTheStepsAndIgnoreWhatIsNone) {
  StepTimes times;
  for (int i = 0; i < 20; ++i) {
    times.Bore(0.8);
    times.Swung(0.5);
    times.Bore(12);    // Stood.
    times.Swung(0.1);  // A blink.
  }
  EXPECT_NEAR(times.stance_s, 0.8, 1e-3);
  EXPECT_NEAR(times.swing_s, 0.5, 1e-3);
  // Walk ratio: 0.0065 m min times the cadence is a step; times the cadence again the speed.
  const double cadence_per_min = 60 * 2 / 1.3;
  EXPECT_NEAR(times.UsualSpeedMps(), 0.0065 * cadence_per_min * cadence_per_min / 60, 1e-3);
}

TEST(InsoleWalk, SaysThatOnlyTheBestModeWalks) {
  const body::Body person = MadePerson();
  const Models models = MakeModels({BasisOf(person, MadeMotion(person, 16))}).value();
  Options options;
  options.mode = Mode::kPaper;
  const auto refused = InsoleWalk::Create(person, models, options);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("best mode"), std::string::npos);
}

}  // namespace
}  // namespace footing::reconstruction
