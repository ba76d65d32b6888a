#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <string_view>

#include "daemon/simulation/reconstruction/pose_targets.h"
#include "tests/simulation/reconstruction/made_world.h"

namespace footing::reconstruction {
namespace {

/// A sensor that shows its segment turned so since the T-pose.
BodyTurns TurnAt(BodySite site, const Eigen::Matrix3d& turn_W, double heading_sd_rad = 0) {
  BodyTurns turns;
  arms::HandState& one = turns[static_cast<std::size_t>(site)];
  one.valid = true;
  one.turn_W = turn_W;
  one.heading_sd_rad = heading_sd_rad;
  return turns;
}
BodyTurns BeltAt(const Eigen::Matrix3d& turn_W, double heading_sd_rad = 0) {
  return TurnAt(BodySite::kPelvis, turn_W, heading_sd_rad);
}

Eigen::Matrix3d About(const Eigen::Vector3d& axis, double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

struct BodyTurnTest : testing::Test {
  World world;
  SubjectModel model = BestSubjectModel(world.person, world.models, world.AtRate()).value();

  /// Sum of the squares of the terms, of a pelvis that has turned by `turn_W`.
  double Cost(const BodyTurns& turns, const Eigen::Matrix3d& turn_W) {
    pose::PoseTargets targets;
    AddTurnTargets(model, turns, {}, targets);
    body::Kinematics at = model.t_pose_at;
    at.R_WJ[0] = turn_W * at.R_WJ[0];
    double sum = 0;
    for (int i = 0; i < targets.count; ++i) {
      const pose::PointTarget& point = targets.points[static_cast<std::size_t>(i)];
      sum += Whitened(point, point.p_W_m - PlaceOf(point, at)).squaredNorm();
    }
    return sum;
  }
};

TEST_F(BodyTurnTest, ThePelvisIsAskedToTurnAsTheBeltDoes) {
  const Eigen::Matrix3d turn =
      About(Eigen::Vector3d::UnitZ(), 0.6) * About(Eigen::Vector3d(1, 2, 0).normalized(), 0.5);
  EXPECT_NEAR(Cost(BeltAt(turn), turn), 0, 1e-20);
  pose::PoseTargets targets;
  AddTurnTargets(model, {}, {}, targets);
  EXPECT_EQ(targets.count, 0) << "nothing is turns";
}

TEST_F(BodyTurnTest, LeaningAndTurningCostWhatTheirDeviationsSay) {
  constexpr double kSmallRad = 0.01;
  const double sd_rad = BestConstants{}.segment_sd_rad;
  const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
  const double expected = std::pow(kSmallRad / sd_rad, 2);
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
    EXPECT_NEAR(Cost(BeltAt(none), About(axis, kSmallRad)), expected, 0.01 * expected) << axis;
  }
  // A heading of which little is known costs as little.
  constexpr double kHeadingSd = 0.7;
  const double little = kSmallRad * kSmallRad / (kHeadingSd * kHeadingSd + sd_rad * sd_rad);
  EXPECT_NEAR(Cost(BeltAt(none, kHeadingSd), About(Eigen::Vector3d::UnitZ(), kSmallRad)), little,
              0.01 * little);
}

TEST_F(BodyTurnTest, WhatIsNoTurnIsNotUsed) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(UsableTurns(BeltAt(About(Eigen::Vector3d::UnitY(), 0.3)))[0].valid);
  EXPECT_FALSE(UsableTurns(BeltAt(2 * Eigen::Matrix3d::Identity()))[0].valid);
  EXPECT_FALSE(UsableTurns(BeltAt(-Eigen::Matrix3d::Identity()))[0].valid) << "a mirror image";
  EXPECT_FALSE(UsableTurns(BeltAt(Eigen::Matrix3d::Constant(kNaN)))[0].valid);
  EXPECT_FALSE(UsableTurns(BeltAt(Eigen::Matrix3d::Identity(), kNaN))[0].valid);
}

TEST_F(BodyTurnTest, AHandThatIsNotSeenIsNotAskedToTurn) {
  const Reconstruction free = world.FreelyMade();
  Reconstruction with = free, without = free, seen = free;
  for (std::size_t i = 0; i < 560; ++i) {
    Inputs inputs = world.inputs[i], turned = inputs, hidden = inputs;
    turned.turns = TurnAt(BodySite::kLeftHand, About(Eigen::Vector3d::UnitX(), 0.3));
    seen.Advance(turned);
    hidden.hands[0].valid = false;
    without.Advance(hidden);
    hidden.turns = turned.turns;
    with.Advance(hidden);
    ASSERT_TRUE(Finite(seen.output())) << i;
    ASSERT_EQ(with.output().R_WJ[0], without.output().R_WJ[0]) << i;
  }
  const auto hand = static_cast<std::size_t>(model.fists[0].joint);
  EXPECT_GT((seen.output().R_WJ[hand] - without.output().R_WJ[hand]).norm(), 0.05);
}

TEST_F(BodyTurnTest, ThePelvisFollowsTheBelt) {
  const Reconstruction free = world.FreelyMade();
  Reconstruction with = free, without = free;
  constexpr double kTurnRad = 0.3;
  for (std::size_t i = 0; i < 560; ++i) {
    Inputs inputs = world.inputs[i];
    inputs.turns = BeltAt(About(Eigen::Vector3d::UnitZ(), kTurnRad));
    with.Advance(inputs);
    without.Advance(world.inputs[i]);
    ASSERT_TRUE(Finite(with.output())) << i;
  }
  const auto turned_rad = [&](const Output& output) {
    const Eigen::Matrix3d turn_W = output.R_WJ[0] * model.t_pose_at.R_WJ[0].transpose();
    return std::atan2(turn_W(1, 0), turn_W(0, 0));
  };
  EXPECT_GT(turned_rad(with.output()) - turned_rad(without.output()), 0.5 * kTurnRad);
}

TEST_F(BodyTurnTest, EachSegmentAsksForItsOwnJoint) {
  // A thigh that is raised level: its heading is about the vertical, its tilt about level axes.
  const Eigen::Matrix3d raised = About(Eigen::Vector3d::UnitY(), -1.5);
  for (std::size_t site = 0; site < kBodySites; ++site) {
    pose::PoseTargets targets;
    const auto where = static_cast<BodySite>(site);
    AddTurnTargets(model, TurnAt(where, raised, 0.5), {}, targets);
    ASSERT_EQ(targets.count, 2) << kBodySiteNames[site];
    const int joint = model.body.landmarks[JointOf(where)];
    const Eigen::Matrix3d R_WJ = raised * model.t_pose_at.R_WJ[static_cast<std::size_t>(joint)];
    for (int i = 0; i < 2; ++i) {
      const pose::PointTarget& target = targets.points[static_cast<std::size_t>(i)];
      EXPECT_EQ(target.joint, joint);
      EXPECT_LT((R_WJ * target.p_J_m - target.p_W_m).norm(), 1e-12) << kBodySiteNames[site];
    }
    const double times = IsHand(where) ? 2 : 5;  // A hand's own deviation is larger.
    EXPECT_GT(targets.points[1].sd_m.x(), times * targets.points[0].sd_m.x())
        << "the heading drifts";
  }
}

TEST_F(BodyTurnTest, ABendToAnotherSideCostsWhatTheHeadingsDeviationSays) {
  constexpr double kOffRad = 0.1, kHeadingSd = 0.3, kBentRad = 1;
  const Eigen::Matrix3d off = About(Eigen::Vector3d::UnitZ(), kOffRad);
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.6, -0.8, 0)}) {
    const Eigen::Matrix3d turn = About(axis, kBentRad), shown = off * turn * off.transpose();
    const double across_rad = kOffRad * std::sin(kBentRad);
    const double sure = Cost(BeltAt(shown), turn), unsure = Cost(BeltAt(shown, kHeadingSd), turn);
    EXPECT_GT(sure, 0.8 * std::pow(across_rad / BestConstants{}.segment_sd_rad, 2)) << axis;
    EXPECT_LT(unsure, 2 * std::pow(kOffRad / kHeadingSd, 2)) << axis;
    // A bend further than shown costs as much as ever.
    const Eigen::Matrix3d deeper = About(axis, kBentRad + kOffRad);
    EXPECT_GT(Cost(BeltAt(turn, kHeadingSd), deeper),
              0.8 * std::pow(kOffRad / BestConstants{}.segment_sd_rad, 2))
        << axis;
  }
}

TEST_F(BodyTurnTest, LegsLeanInTheTPoseAsFeetAndWeightStand) {
  momentum::TPose straight;
  std::array<Eigen::Vector3d, momentum::kFeet> ankle_m;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const FootGeometry& foot = model.feet[f];
    ankle_m[f] = model.t_pose_at.p_WJ[static_cast<std::size_t>(foot.ankle.joint)];
    straight.p_WP_m[f] = ankle_m[f] - foot.R_WF * foot.ankle_F_m;
  }
  const Eigen::Vector3d com_m = body::CentreOfMass(model.body, model.t_pose_at);
  straight.cop_m = com_m;
  const Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  for (const Eigen::Matrix3d& leg : StanceOf(model, straight, origin_m)) {
    EXPECT_TRUE(leg.isIdentity(1e-9));
  }
  momentum::TPose wide = straight;
  wide.p_WP_m[0].y() += 0.1;
  wide.p_WP_m[1].y() -= 0.1;
  const Stance spread = StanceOf(model, wide, origin_m);
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  EXPECT_NEAR((spread[0] * down).y(), 0.12, 0.03) << "the left leg to the left";
  EXPECT_NEAR((spread[1] * down).y(), -0.12, 0.03);
  momentum::TPose ahead = straight;
  ahead.cop_m.x() += 0.05;
  const Eigen::Vector3d up = StanceOf(model, ahead, origin_m)[0] * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(up.x(), 0.05 / (com_m - ankle_m[0]).z(), 0.003) << "weight ahead: a lean forwards";
  // Turned back by its lean, a leg that was spread in the T-pose hangs straight.
  const Eigen::Matrix3d back = spread[0].transpose();
  const BodyTurns turns = FromStance(TurnAt(BodySite::kLeftThigh, back), spread);
  EXPECT_TRUE(turns[static_cast<std::size_t>(BodySite::kLeftThigh)].turn_W.isIdentity(1e-9));
  const BodyTurns belt = FromStance(BeltAt(back), spread);
  EXPECT_TRUE(belt[0].turn_W.isApprox(back)) << "the pelvis is upright";
}

TEST_F(BodyTurnTest, AnglesThatASensorShowsHaveSmallDeviations) {
  Reconstruction bare = world.FreelyMade(), belt = bare, thighs = bare;
  for (std::size_t i = 0; i < 560; ++i) {
    Inputs inputs = world.inputs[i];
    bare.Advance(inputs);
    inputs.turns = BeltAt(Eigen::Matrix3d::Identity());
    belt.Advance(inputs);
    for (const BodySite site : {BodySite::kLeftThigh, BodySite::kRightThigh}) {
      inputs.turns[static_cast<std::size_t>(site)] = inputs.turns[0];
    }
    thighs.Advance(inputs);
  }
  const auto sd_rad = [](const Reconstruction& of, std::string_view name) {
    return of.output().angle_sd_rad.at(body::StatedAngle(name).value());
  };
  for (const double one_rad : bare.output().angle_sd_rad) {
    EXPECT_GT(one_rad, 0);
    EXPECT_LE(one_rad, kUnknownAngleRad);
  }
  EXPECT_LT(sd_rad(belt, "pelvis_tilt"), BestConstants{}.segment_sd_rad);
  EXPECT_LT(sd_rad(belt, "pelvis_tilt"), sd_rad(bare, "pelvis_tilt"));
  for (const char* name : {"hip_flexion_l", "hip_flexion_r"}) {
    EXPECT_LT(sd_rad(thighs, name), 1.5 * BestConstants{}.segment_sd_rad) << name;
    EXPECT_LT(sd_rad(thighs, name), sd_rad(belt, name)) << name;
  }
}

}  // namespace
}  // namespace footing::reconstruction
