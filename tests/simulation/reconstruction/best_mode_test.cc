#include <cmath>

#include <gtest/gtest.h>

#include "daemon/simulation/reconstruction/best_mode.h"
#include "daemon/simulation/reconstruction/pose_targets.h"
#include "daemon/simulation/reconstruction/report.h"
#include "tests/simulation/reconstruction/made_world.h"

namespace footing::reconstruction {
namespace {

std::array<HandInput, kHands> HandsAt(double forward_m) {
  std::array<HandInput, kHands> hands;
  for (std::size_t side = 0; side < kHands; ++side) {
    hands[side] = {true, {forward_m, side == 0 ? 0.7 : -0.7, 1.4}, Eigen::Vector3d::Constant(0.01)};
  }
  return hands;
}

TEST(StandingRise, FeetAreFlatInTheTPoseAndAsUsualOnceTheHandsHaveLeftIt) {
  const FootSpread usual;
  StandingRise rise;
  const auto advance = [&](double forward_m) { return rise.Advance(HandsAt(forward_m), usual); };
  const FootSpread flat = advance(0);
  EXPECT_EQ(flat.ankle_rise, 0);
  EXPECT_EQ(flat.toe_rise, 0);
  EXPECT_EQ(flat.ankle_up, usual.flat_up);
  const double left = 1 - std::exp(-0.2 / usual.leave_m);
  EXPECT_NEAR(advance(0.2).ankle_rise, left * usual.ankle_rise, 1e-9);
  EXPECT_NEAR(advance(3).toe_rise, usual.toe_rise, 1e-4);
  EXPECT_NEAR(advance(0).toe_rise, usual.toe_rise, 1e-4) << "they do not become flat again";
  rise.Start();
  EXPECT_EQ(advance(1).ankle_rise, 0) << "the hands of another T-pose";
}

TEST(StandingRise, HandsThatNobodySeesInTheTPoseSayNothing) {
  const FootSpread usual;
  StandingRise rise;
  std::array<HandInput, kHands> hands = HandsAt(0);
  hands[0].valid = false;
  const FootSpread spread = rise.Advance(hands, usual);
  EXPECT_EQ(spread.ankle_rise, usual.ankle_rise);
  EXPECT_GE(spread.ankle_up, usual.ankle_up);
}

TEST(Reconstruction, InTheTPoseTheKneesAreStraight) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate());
  const auto knee_rad = [&](const std::vector<Eigen::Matrix3d>& R_WJ) {
    const auto knee = static_cast<std::size_t>(world.person.landmarks[body::Landmark::kLeftKnee]);
    const auto thigh = static_cast<std::size_t>(world.person.skeleton.joints[knee].parent);
    return std::acos(((R_WJ[thigh].transpose() * R_WJ[knee]).trace() - 1) / 2);
  };
  double off_rad = 0;
  const auto last = static_cast<std::size_t>(kMadeStandS * kMadeRateHz);
  for (std::size_t i = 0; i < last; ++i) {
    reconstruction.Advance(world.inputs[i]);
    world.ErrorM(reconstruction.output(), i, 0);
    off_rad = knee_rad(reconstruction.output().R_WJ) - knee_rad(world.at.R_WJ);
  }
  EXPECT_NEAR(off_rad, 0, 0.1);
}

TEST(Delay, GoesBackToTheFirstValueAtMost) {
  Delay<int, 3> delay;
  delay.Add(10);
  EXPECT_EQ(delay.Back(0), 10);
  EXPECT_EQ(delay.Back(2), 10);
  for (const int value : {11, 12, 13}) delay.Add(value);
  EXPECT_EQ(delay.Back(0), 13);
  EXPECT_EQ(delay.Back(2), 11);
  delay.Clear();
  delay.Add(20);
  EXPECT_EQ(delay.Back(2), 20);
}

SubjectModel ModelOf(const World& world) {
  return WalkSubjectModel(world.person, world.models, world.AtRate()).value();
}

TEST(PoseTargets, AWalksFeetAreAimedAtWithItsOwnDeviations) {
  World world;
  const SubjectModel model = ModelOf(world);
  WalkPrior prior;
  prior.feet[1] = {{1, -0.1, 0.08}, {1.15, -0.1, 0.02}, 0.03, 0.05};
  pose::PoseTargets targets;
  AddFeetTargets(model, prior.feet, targets);
  SetMomentumTargets(prior.com, targets);
  ASSERT_EQ(targets.count, 4);
  EXPECT_FALSE(targets.has_com) << "no hand shows where the body is";
  const auto points = PointsOf(model.feet[1], targets);
  ASSERT_TRUE(points);
  EXPECT_EQ((*points)[0].p_W_m, prior.feet[1].ankle_W_m);
  EXPECT_EQ((*points)[0].sd_m, Eigen::Vector3d::Constant(0.03));
  EXPECT_EQ((*points)[1].p_W_m, prior.feet[1].toe_W_m);
  EXPECT_EQ((*points)[1].sd_m, Eigen::Vector3d::Constant(0.05));
}

TEST(PoseTargets, DirectionsOfAnArmStayWhereTheOriginMoves) {
  World world;
  const SubjectModel model = ModelOf(world);
  Measurement then;
  then.hands[0] = {true, {0.2, 0.7, 1.4}, Eigen::Vector3d::Constant(0.01)};
  then.arms[1].valid = true;
  pose::PoseTargets targets;
  AddHandTargets(model, then, {}, targets);
  ASSERT_EQ(targets.count, 4) << "one fist, three of the other arm";
  const pose::PoseTargets in_W = targets;
  MoveOrigin({1, 2, 0}, targets);
  EXPECT_EQ(targets.points[0].p_W_m, in_W.points[0].p_W_m - Eigen::Vector3d(1, 2, 0));
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(targets.points[i].p_W_m, in_W.points[i].p_W_m);
}

TEST(Doubt, APoseFromHandsAndFeetAloneIsLessCertainEvenWhereItFits) {
  EXPECT_EQ(Doubt(0.5, true), 1);
  EXPECT_GT(Doubt(0.5, false), 1.3);
  EXPECT_EQ(Doubt(3, true), 4);  // (3 / 1.5)^2
  EXPECT_EQ(Doubt(3, false), 4);
}

TEST(Reconstruction, ATruthTakesThePlaceOfTheEstimateInEitherMode) {
  World world;
  for (const Mode mode : {Mode::kBest, Mode::kPaper}) {
    Options options = world.AtRate(mode);
    options.use_angular_momentum = false;
    Reconstruction without = world.Made(options), with = world.Made(options);
    double without_m = 0, with_m = 0;
    for (std::size_t i = 0; i < 600; ++i) {
      Inputs inputs = world.inputs[i];
      // Boards that are 5 cm beside where they are thought to be.
      for (auto& foot : inputs.loads.feet) {
        for (auto& cell : foot.cells) cell.p_WS_m.y() += 0.05;
      }
      const auto q = world.motion.q.col(static_cast<Eigen::Index>(i));
      body::ComputeKinematics(world.person.skeleton, q, world.at);
      Truth truth;
      truth.com_W_m = body::CentreOfMass(world.person, world.at);
      truth.feet = std::array<Truth::Foot, 2>{};
      const auto feet = StandingFeet(world.person);
      for (std::size_t f = 0; f < momentum::kFeet; ++f) {
        const auto place = [&](const body::Point& point) {
          const auto joint = static_cast<std::size_t>(point.joint);
          return body::Place(point, world.at.R_WJ[joint], world.at.p_WJ[joint]);
        };
        (*truth.feet)[f] = {place(feet[f].ankle), place(feet[f].toe)};
      }
      without.Advance(inputs);
      with.Advance(inputs, truth);
      if (i < 400) continue;
      without_m += world.ErrorM(without.output(), i, 0);
      with_m += world.ErrorM(with.output(), i, 0);
    }
    EXPECT_LT(with_m, 0.8 * without_m);
  }
}

}  // namespace
}  // namespace footing::reconstruction
