#include <cmath>

#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/targets.h"
#include "tests/simulation/test_world.h"

namespace footing::gait {
namespace {

using stream::Gait;

/// A character that walks or runs, and is given a command at a moment of its cycle.
struct Scene {
  biped::BipedParameters biped = test::Biped();
  Gains gains;
  physics::World world = test::LevelWorld();
  GaitMemory memory = Standing(0, 0);
  double time_s = 0;
  bool fell = false;

  Scene() {
    const double leg_m = StandingLength(biped, gains);
    std::array<double, physics::kJoints> joints{};
    joints[3] = joints[7] = leg_m - biped.leg_length_m;
    world.Reset({0, 0, leg_m + biped.foot_radius_m}, 0, joints);
  }
  biped::BodyState Body() const { return biped::Read(biped, world.Observe(), time_s); }
  void Run(const biped::GaitCommand& command, double seconds) {
    for (const double end_s = time_s + seconds; time_s < end_s; time_s += world.step_s()) {
      world.Step(Advance(Body(), biped, gains, command, nullptr, world.step_s(), memory),
                 Eigen::Vector3d::Zero());
      fell = fell || Body().p_WB.z() < 0.55;
    }
  }
  double PitchRad() const { return -std::asin(Body().R_WB(2, 0)); }
};

constexpr double kFrameS = 1.0 / 60;
constexpr double kDegree = 0.017453292519943295;

/// How fast the foothold of a slow step moves ahead shortly before its foot touches down, m/s.
double FootholdSpeed(double foresight) {
  Scene scene;
  scene.gains.walking.swing_time_s = 0.52;
  scene.gains.style.foresight = foresight;
  scene.memory.style.share = 1;
  const biped::GaitCommand walk{.gait = Gait::kWalk, .speed_mps = 0.7};
  scene.Run(walk, 6);
  const auto late = [&scene] {
    return scene.memory.walking == WalkingPhase::kFall &&
           scene.time_s - scene.memory.phase_start_s > 0.4;
  };
  for (int i = 0; i < 2000 && !late(); ++i) scene.Run(walk, scene.world.step_s());
  const double before_m = scene.memory.foothold_W_m.x();
  constexpr double kSeconds = 0.05;
  scene.Run(walk, kSeconds);
  EXPECT_TRUE(late());
  EXPECT_FALSE(scene.fell);
  return (scene.memory.foothold_W_m.x() - before_m) / kSeconds;
}

TEST(WalkingFoothold, IsForeseenInASlowStepSoThatTheFootLandsNearlyAtRest) {
  EXPECT_GT(FootholdSpeed(0), 0.9);
  EXPECT_LT(FootholdSpeed(1), 0.6 * FootholdSpeed(0));
}

/// Difference that a command makes to the body after `seconds`: pitch, and height.
struct Answer {
  double pitch_rad, height_m;
};
Answer AnswerOf(const biped::GaitCommand& before, const biped::GaitCommand& after, double moment_s,
                double seconds) {
  Scene without, with;
  without.Run(before, moment_s);
  with.Run(before, moment_s);
  without.Run(before, seconds);
  with.Run(after, seconds);
  const Answer answer{with.PitchRad() - without.PitchRad(),
                      with.Body().p_WB.z() - without.Body().p_WB.z()};
  with.Run(after, 3);
  EXPECT_FALSE(with.fell);
  return answer;
}

TEST(Anticipation, AWalkLeansForwardAtOnceForASpeedItMustStillGain) {
  const biped::GaitCommand slow{.gait = Gait::kWalk, .speed_mps = 0.4};
  const biped::GaitCommand fast{.gait = Gait::kWalk, .speed_mps = 1.4};
  for (const double moment_s : {4.0, 4.1, 4.2}) {
    EXPECT_GT(AnswerOf(slow, fast, moment_s, kFrameS).pitch_rad, 0.05 * kDegree);
    EXPECT_GT(AnswerOf(slow, fast, moment_s, 0.15).pitch_rad, 1 * kDegree);
    EXPECT_LT(AnswerOf(fast, slow, moment_s, 0.15).pitch_rad, -1 * kDegree);
  }
}

TEST(Anticipation, AWalkCrouchesWhileItWaitsToJump) {
  const biped::GaitCommand walk{.gait = Gait::kWalk, .speed_mps = 0.8};
  const biped::GaitCommand jump{.gait = Gait::kJump, .speed_mps = 0.8, .height_m = 0.2};
  double lowest_m = 0;
  for (const double moment_s : {4.0, 4.1, 4.2}) {
    lowest_m = std::min(lowest_m, AnswerOf(walk, jump, moment_s, 0.1).height_m);
  }
  EXPECT_LT(lowest_m, -0.01);
}

TEST(Anticipation, NothingShowsOfACommandThatIsObeyed) {
  Scene scene;
  const biped::GaitCommand walk{.gait = Gait::kWalk, .speed_mps = 0.8};
  scene.Run(walk, 4);
  const biped::BodyState body = scene.Body();
  const Context context{body, scene.biped, scene.gains, walk, nullptr, 0.001};
  EXPECT_EQ(AnticipatedLean(context, scene.memory), 0);
  EXPECT_EQ(AnticipatedCrouch(context, scene.memory), 0);
}

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
