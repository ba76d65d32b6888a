#include <gtest/gtest.h>

#include "daemon/simulation/reconstruction/delay.h"
#include "daemon/simulation/reconstruction/pose_targets.h"
#include "daemon/simulation/reconstruction/report.h"
#include "tests/simulation/reconstruction/made_world.h"

namespace footing::reconstruction {
namespace {

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
