#include "daemon/simulation/gait/leg_room.h"

#include <cmath>

#include "daemon/simulation/gait/attitude.h"
#include "tests/simulation/test_world.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

constexpr int kIdle = biped::kRight;
const Vector3d kHip(0, 0.1, 0.9);

/// A run through a curve to the left on its left leg, whose foot is 12 cm outside of its hip; the
/// idle right leg's target hangs under its own hip.
struct CurveScene {
  biped::BipedParameters biped = test::Biped();
  Gains gains;
  biped::BodyState body;
  biped::GaitCommand goal;
  GaitMemory memory;
  Targets targets;

  CurveScene() {
    memory.gait = stream::Gait::kRun;
    memory.support_leg = biped::kLeft;
    memory.speed.desired_mps = 5;
    memory.turning_radps = 0.3;
    const double bank_rad = BankAngle(memory, gains.attitude);
    body.R_WB = Eigen::AngleAxisd(bank_rad, Vector3d::UnitX()).toRotationMatrix();
    body.legs[0].p_WH = kHip;
    body.legs[0].p_WF = {0, -0.02, 0.02};
    body.legs[1].p_WH = {0, -0.1, 0.9};
    targets.hopping = true;
    targets.legs[kIdle].task = LegTask::kPlace;
    targets.legs[kIdle].r_HF_W_m = {0, 0.04, -0.7};
  }
  Vector3d Kept() {
    KeepLegsApart({body, biped, gains, goal, nullptr, 0.001}, memory, targets);
    return targets.legs[kIdle].r_HF_W_m;
  }
};

TEST(LegRoom, KeepsTheIdleLegOfACurveTheGapAside) {
  CurveScene scene;
  const double length_m = scene.targets.legs[kIdle].r_HF_W_m.norm();
  const Vector3d kept = scene.Kept();
  EXPECT_NEAR(kept.norm(), length_m, 1e-12);
  // At the idle foot's height the supporting leg is this far along its way from the hip; the idle
  // target's height changes a little with its length kept.
  const double way = -kept.z() / (0.9 - 0.02);
  const double other_y_m = std::lerp(0.1, -0.02, way);
  EXPECT_NEAR(other_y_m - (-0.1 + kept.y()), scene.gains.curve.leg_gap_m, 0.003);
}

TEST(LegRoom, LeavesLegsAloneThatHaveSpaceOrPassOneBeforeTheOther) {
  CurveScene scene;
  const Vector3d wide(0, -0.1, -0.7), ahead(0.5, 0.04, -0.5);
  for (const Vector3d& target : {wide, ahead}) {
    scene.targets.legs[kIdle].r_HF_W_m = target;
    EXPECT_EQ(scene.Kept(), target);
  }
}

TEST(LegRoom, BeginsInACurveBeforeTheLegsPassTheSoonerTheFasterTheyDo) {
  const Vector3d ahead(0.35, 0.12, -0.6);
  const auto outward_m = [&ahead](double speed_mps, double turning_radps) {
    CurveScene scene;
    scene.memory.speed.desired_mps = speed_mps;
    scene.memory.turning_radps = turning_radps;
    const double bank_rad = BankAngle(scene.memory, scene.gains.attitude);
    scene.body.R_WB = Eigen::AngleAxisd(bank_rad, Vector3d::UnitX()).toRotationMatrix();
    scene.targets.legs[kIdle].r_HF_W_m = ahead;
    return ahead.y() - scene.Kept().y();
  };
  EXPECT_GT(outward_m(5, 0.3), 0.005);
  EXPECT_GT(outward_m(6, 0.3), outward_m(5, 0.3) + 0.002);
  EXPECT_EQ(outward_m(1, 0.3), 0);
  EXPECT_EQ(outward_m(6, 0), 0);
}

TEST(LegRoom, KeepsAWalksFeetTheGapAsideUntilAPushWantsThemToCross) {
  constexpr double kGapM = 0.07;
  EXPECT_EQ(SideStep(0.2, kGapM), 0.2);
  EXPECT_EQ(SideStep(0.03, kGapM), kGapM);
  EXPECT_EQ(SideStep(0, kGapM), kGapM);
  EXPECT_NEAR(SideStep(-0.035, kGapM), 0, 1e-12);
  EXPECT_EQ(SideStep(-0.1, kGapM), -0.1);
  EXPECT_EQ(SideStep(-0.1, 0), -0.1);
}

TEST(LegRoom, KeepsTheGapStraightAheadTooWhileTheBodyIsUpright) {
  const auto straight_at = [](double tilt_rad) {
    CurveScene scene;
    scene.memory.turning_radps = 0;
    scene.body.R_WB = Eigen::AngleAxisd(tilt_rad, Vector3d::UnitX()).toRotationMatrix();
    return scene.Kept();
  };
  const Vector3d curve = CurveScene().Kept();
  EXPECT_LT((straight_at(0) - curve).norm(), 1e-3);
  const Vector3d target = CurveScene().targets.legs[kIdle].r_HF_W_m;
  EXPECT_GT(straight_at(0.09).y(), curve.y());
  EXPECT_LT(straight_at(0.09).y(), target.y());
  EXPECT_EQ(straight_at(0.13), target);
}

TEST(LegRoom, IsForRunsThatNobodyPushed) {
  const Vector3d target = CurveScene().targets.legs[kIdle].r_HF_W_m;
  CurveScene pushed;
  pushed.body.R_WB = Eigen::AngleAxisd(0.4, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_EQ(pushed.Kept(), target);
  CurveScene jumping;
  jumping.memory.gait = stream::Gait::kJump;
  EXPECT_EQ(jumping.Kept(), target);
}

}  // namespace
}  // namespace footing::gait
