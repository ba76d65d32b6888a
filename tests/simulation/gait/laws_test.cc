#include <array>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/paper.h"
#include "daemon/simulation/gait/running.h"
#include "daemon/simulation/gait/style.h"
#include "daemon/simulation/gait/targets.h"
#include "tests/simulation/test_world.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

/// A body over its support foot, for laws that ask for little more.
struct LawsScene {
  biped::BipedParameters biped = test::Biped();
  Gains gains;
  biped::BodyState body;
  biped::GaitCommand goal;
  GaitMemory memory;

  LawsScene() {
    body.p_WC = {0, 0, 0.92};
    for (int i = 0; i < 2; ++i) {
      const double y = biped::Side(i) * biped.hip_half_spacing_m;
      body.legs[i].p_WH = {0, y, 0.92};
      body.legs[i].p_WF = {0, y, 0.02};
    }
  }
  Context context() const { return {body, biped, gains, goal, nullptr, 0.001}; }
};

/// The pendulum of equation (1): height 0.9 m, walked by the law until it repeats.
TEST(Equation1, MakesAnInvertedPendulumWalkAtTheDesiredSpeed) {
  for (const double speed_mps : {0.0, 0.5, 1.2}) {
    LawsScene scene;
    scene.memory.speed.desired_mps = speed_mps;
    const double w = std::sqrt(kStandardGravityMps2 / 0.9);
    const double step_s =
        scene.gains.walking.swing_time_s + scene.gains.walking.double_support_time_s;
    // The law looks half a double support ahead of the touchdown; so does this pendulum.
    const double ahead_s = 0.5 * scene.gains.walking.double_support_time_s;
    Vector3d x(0, 0, 0.92), v(0.8, 0.1, 0), foot(0, 0.1, 0.02), start_of_step;
    const auto fly = [&](double time_s) {
      const double c = std::cosh(w * time_s), s = std::sinh(w * time_s);
      const Vector3d r = x - foot;
      x.head<2>() = (foot + r * c + v * s / w).head<2>();
      v.head<2>() = (r * w * s + v * c).head<2>();
    };
    for (int step = 0; step < 40; ++step) {
      start_of_step = x;
      fly(step_s - ahead_s);
      scene.body.p_WC = x;
      scene.body.v_WC = v;
      scene.memory.support_leg = step % 2;
      scene.body.legs[scene.memory.support_leg].p_WF = foot;
      const Vector3d next = PlanWalkingFoothold(scene.context(), scene.memory).p_WF_m;
      fly(ahead_s);
      foot = next;
    }
    EXPECT_NEAR((x - start_of_step).x() / step_s, speed_mps, 1e-6);
    const double width_m = std::fabs(foot.y() - scene.body.legs[scene.memory.support_leg].p_WF.y());
    EXPECT_NEAR(width_m, scene.gains.walking.step_width_m, 1e-6);
  }
}

TEST(Equation1, AStepThatWouldCrossTooFarHurries) {
  LawsScene scene;
  EXPECT_EQ(PlanWalkingFoothold(scene.context(), scene.memory).hurry, 0);
  scene.body.v_WC.y() = 0.9;  // Over the left, supporting foot: the right one must cross.
  EXPECT_GT(PlanWalkingFoothold(scene.context(), scene.memory).hurry, 0);
}

/// A walk of 1.2 m/s on its left leg at a part of the step, by our laws with a style.
struct StyledStep {
  LawsScene scene;

  explicit StyledStep(double phase) {
    scene.gains.style = {.bob_share = 0.8,
                         .pelvis_roll_rad = 0.08,
                         .pelvis_yaw_rad = 0.06,
                         .nod_rad = 0.02,
                         .lean_rad_per_mps = 0.01};
    scene.memory.speed.desired_mps = 1.2;
    scene.memory.walking = phase > 0 ? WalkingPhase::kRise : WalkingPhase::kDoubleSupport;
    scene.memory.support_leg = biped::kLeft;
    const double double_support_s = scene.gains.walking.double_support_time_s;
    const double step_s = scene.gains.walking.swing_time_s + double_support_s;
    scene.body.time_s = std::max(0.0, phase * step_s - double_support_s);
    for (auto& leg : scene.body.legs) leg.touching = true;
  }
  Targets targets() const { return WalkingTargets(scene.context(), scene.memory); }
};

TEST(Style, SwingsThePelvisWithTheLegsOfAWalk) {
  const Targets touchdown = StyledStep(0).targets(), middle = StyledStep(0.5).targets();
  // The landing left leg's hip is ahead: the body is turned to the right, and turns to the left.
  EXPECT_NEAR(touchdown.yaw_rad, -0.06, 1e-12);
  EXPECT_NEAR(middle.yaw_rad, 0, 1e-12);
  EXPECT_GT(middle.rate_W_radps.z(), 0);
  // In the middle of its support the left hip is up, which is a roll to the right.
  EXPECT_NEAR(touchdown.roll_rad, 0, 1e-12);
  EXPECT_NEAR(middle.roll_rad, 0.08, 1e-12);
  EXPECT_GT(touchdown.rate_W_radps.x(), 0);
  // Forward at touchdown, besides the lean by 0.01 rad for each m/s.
  EXPECT_NEAR(touchdown.lean_rad, 0.012 + 0.02, 1e-12);
  EXPECT_NEAR(middle.lean_rad, 0.012 - 0.02, 1e-12);
}

TEST(Style, RaisesTheHipsOverTheSupportingLegByAPartOfARigidLegsArc) {
  const StyledStep touchdown(0), middle(0.5);
  const WalkingGains& gains = touchdown.scene.gains.walking;
  const double step_m = 1.2 * (gains.swing_time_s + gains.double_support_time_s);
  EXPECT_NEAR(middle.targets().legs[biped::kLeft].axial.length_m -
                  touchdown.targets().legs[biped::kLeft].axial.length_m,
              0.8 * step_m * step_m / (8 * gains.hip_height_m), 1e-12);
}

/// A walk with all of its style, as nothing disturbs it.
struct StyledWalk : LawsScene {
  StyledWalk() {
    goal.gait = memory.gait = memory.style.gait = stream::Gait::kWalk;
    body.R_WB.setIdentity();
    gains.walking.swing_time_s = 0.32;
    memory.walking = WalkingPhase::kRise;
    memory.walking_step.swing_time_s = 0.6;
    memory.style.there = true;
    memory.style.share = 1;
  }
};

TEST(Style, FadesWhereBalanceComesFirst) {
  StyledWalk scene;
  EXPECT_EQ(RegularShare(scene.context(), scene.memory), 1);
  const auto share = [](const auto& change) {
    StyledWalk changed;
    change(changed);
    return RegularShare(changed.context(), changed.memory);
  };
  EXPECT_EQ(share([](auto& s) { s.memory.pit.sighting.ahead = true; }), 0);
  EXPECT_EQ(share([](auto& s) { s.goal.gait = stream::Gait::kRun; }), 0);
  EXPECT_EQ(share([](auto& s) { s.memory.style.excess_m = 0.1; }), 0);
  EXPECT_EQ(share([](auto& s) {
              s.body.R_WB = Eigen::AngleAxisd(0.2, Vector3d::UnitX()).toRotationMatrix();
            }),
            0);
  const FadeGains& gains = scene.gains.fade;
  EXPECT_NEAR(share([&gains](auto& s) {
                s.goal.turn_per_step_rad = -(gains.turn_from_rad + gains.turn_to_rad) / 2;
              }),
              0.5, 1e-12);
}

TEST(Style, ShortensTheStepAsItFadesAndKeepsWhatIsOverOfIt) {
  StyledWalk scene;
  scene.body.time_s = 0.3;  // Half of the slow swing.
  scene.memory.pit.sighting.ahead = true;
  FadeStyle(scene.context(), scene.memory);
  EXPECT_NEAR(scene.memory.style.share, 1 - 0.001 / scene.gains.fade.out_s, 1e-12);
  EXPECT_EQ(SwingTime(scene.context(), scene.memory), 0.32);
  EXPECT_NEAR(scene.context().TimeIn(scene.memory), 0.16, 1e-12);
  for (int i = 0; i < 1000; ++i) FadeStyle(scene.context(), scene.memory);
  EXPECT_EQ(scene.memory.style.share, 0);
}

TEST(Style, IsAbsentFromTheDefaultsThatThePapersGaitsHave) {
  LawsScene scene;
  scene.memory.speed.desired_mps = 1.2;
  const Targets targets = WalkingTargets(scene.context(), scene.memory);
  EXPECT_EQ(targets.roll_rad, 0);
  EXPECT_EQ(targets.yaw_rad, 0);
  EXPECT_EQ(targets.lean_rad, 0);
  EXPECT_EQ(targets.rate_W_radps, Vector3d::Zero());
}

TEST(PaperEquations, AreAnglesAsPrinted) {
  EXPECT_NEAR(PaperWalkingAngle(0.15, -0.3, 1.0, 1.2), 0.15 + 0.3 * 0.2, 1e-12);
  EXPECT_NEAR(PaperRunningAngle(0.2, -0.08, 3.0, 2.5), 2.5 * 0.1 - 0.08 * 0.5, 1e-12);
}

/// The paper's gaits look at contacts and at the rear leg, not at a clock.
TEST(PaperWalking, ChangesItsStateOnContactAndMovement) {
  LawsScene scene;
  scene.memory.gait = scene.goal.gait = stream::Gait::kWalk;
  scene.gains.paper.pick_up_s = 1;
  scene.gains.paper.rise_passed_m = 0;
  const auto after = [&scene](WalkingPhase phase, double time_s) {
    scene.memory.walking = phase;
    scene.memory.phase_start_s = scene.body.time_s - time_s;
    AdvancePaper(scene.context(), scene.memory);
    return scene.memory.walking;
  };
  biped::LegState& rear = scene.body.legs[1];
  scene.body.legs[0].touching = rear.touching = true;
  scene.body.legs[0].length_m = rear.length_m = 0.9;
  EXPECT_EQ(after(WalkingPhase::kDoubleSupport, 0.5), WalkingPhase::kDoubleSupport);
  rear.touching = false;  // Pulled up by the forward movement of the body.
  EXPECT_EQ(after(WalkingPhase::kDoubleSupport, 0.1), WalkingPhase::kRise);
  rear.p_WF.x() = -0.2;
  EXPECT_EQ(after(WalkingPhase::kRise, 0.5), WalkingPhase::kRise);
  rear.p_WF.x() = 0.1;
  EXPECT_EQ(after(WalkingPhase::kRise, 0.1), WalkingPhase::kFall);
  EXPECT_EQ(after(WalkingPhase::kFall, 0.5), WalkingPhase::kFall);
  rear.touching = true;
  EXPECT_EQ(after(WalkingPhase::kFall, 0.1), WalkingPhase::kDoubleSupport);
  EXPECT_EQ(scene.memory.support_leg, 1);
}

/// "The transition from Rise to Fall occurs when the foot of the swing leg reaches a specified
/// height and the sideways velocity of the hip is greater than a threshold."
TEST(PaperStepping, FallsOnceTheFootIsHighAndTheHipGoesItsWay) {
  LawsScene scene;
  scene.memory.gait = scene.goal.gait = stream::Gait::kStep;
  scene.gains.paper.rise_height_m = 0.03;
  scene.gains.paper.rise_sideways_mps = 0.05;
  scene.memory.walking = WalkingPhase::kRise;
  scene.body.legs[1].p_WF.z() = 0.1;
  AdvancePaper(scene.context(), scene.memory);
  EXPECT_EQ(scene.memory.walking, WalkingPhase::kRise);
  scene.body.v_WB.y() = -0.1;  // Towards the right, swinging leg.
  AdvancePaper(scene.context(), scene.memory);
  EXPECT_EQ(scene.memory.walking, WalkingPhase::kFall);
}

TEST(PaperStepping, FollowsAWalkOnceThatIsSlow) {
  LawsScene scene;
  scene.memory.gait = stream::Gait::kWalk;
  scene.goal.gait = stream::Gait::kStep;
  scene.body.v_WC.x() = 1;
  AdvancePaper(scene.context(), scene.memory);
  EXPECT_EQ(scene.memory.gait, stream::Gait::kWalk);
  scene.body.v_WC.x() = 0.9 * scene.gains.paper.step_below_mps;
  AdvancePaper(scene.context(), scene.memory);
  EXPECT_EQ(scene.memory.gait, stream::Gait::kStep);
  scene.body.v_WC.x() = 1;
  scene.goal.gait = stream::Gait::kWalk;  // "The controller is immediately changed."
  AdvancePaper(scene.context(), scene.memory);
  EXPECT_EQ(scene.memory.gait, stream::Gait::kWalk);
}

/// "The swing leg is extended to make contact with the ground."
TEST(PaperWalking, TheSwingLegReachesForTheGroundInFall) {
  LawsScene scene;
  scene.memory.gait = scene.goal.gait = stream::Gait::kWalk;
  scene.memory.walking = WalkingPhase::kFall;
  const auto length_m = [&scene](double time_s) {
    scene.memory.phase_start_s = scene.body.time_s - time_s;
    return AdvancePaper(scene.context(), scene.memory).legs[1].r_HF_W_m.norm();
  };
  const gait::PaperGains& gains = scene.gains.paper;
  EXPECT_NEAR(length_m(0), gains.touchdown_length_m, 1e-9);
  EXPECT_NEAR(length_m(0.1), gains.touchdown_length_m + 0.1 * gains.reach_mps, 1e-9);
  EXPECT_LE(length_m(5), 1.1 + 1e-9);
}

TEST(Jumping, RetractsTheSecondLegOnceTheFirstHasLeftTheGround) {
  for (const double laws : {0.0, 1.0}) {
    LawsScene scene;
    scene.gains.paper.laws = laws;
    scene.memory.gait = scene.goal.gait = stream::Gait::kJump;
    scene.memory.running = RunningPhase::kExtension;
    scene.memory.hop.thrust_length_m = 1.0;
    for (biped::LegState& leg : scene.body.legs) {
      leg.touching = true;
      leg.length_m = 0.9;
    }
    const auto left_leg = [&] {
      return (laws > 0 ? AdvancePaper(scene.context(), scene.memory)
                       : AdvanceRunning(scene.context(), scene.memory))
          .legs[0];
    };
    scene.body.time_s = 0.05;
    EXPECT_EQ(left_leg().task, LegTask::kSupport);
    scene.body.legs[1].touching = false;
    left_leg();
    EXPECT_EQ(left_leg().task, LegTask::kPlace) << laws;
    EXPECT_NEAR(left_leg().r_HF_W_m.norm(), scene.gains.hopping.jump_flight_length_m, 1e-9);
  }
}

TEST(Equation2, IsHalfTheSupportsTravelAtTheDesiredSpeed) {
  LawsScene scene;
  scene.goal.gait = stream::Gait::kRun;
  scene.memory.gait = stream::Gait::kRun;
  scene.memory.hop.support_time_s = 0.2;
  scene.memory.speed.desired_mps = 3;
  scene.body.v_WC = {3, 0, 1};
  const double neutral_m = 3 * 0.2 / 2 + scene.gains.hopping.speed_gain_s * 3;
  EXPECT_NEAR(HoppingFoothold(scene.context(), scene.memory, 0).x(), neutral_m, 1e-12);
  scene.body.v_WC.x() = 3.5;  // Faster: the foot goes further forward, by T / 2 + |k_R|.
  EXPECT_NEAR(HoppingFoothold(scene.context(), scene.memory, 0).x(),
              neutral_m + 0.5 * (0.1 + scene.gains.hopping.run_velocity_gain_s), 1e-12);
}

TEST(Equation2, BrakesHarderInARunThatIsToEnd) {
  LawsScene scene;
  scene.memory.gait = stream::Gait::kRun;
  scene.memory.speed.desired_mps = 2.7;
  scene.body.v_WC = {3, 0, 1};
  scene.goal.gait = stream::Gait::kRun;
  const double running_m = HoppingFoothold(scene.context(), scene.memory, 0).x();
  scene.goal.gait = stream::Gait::kWalk;
  EXPECT_NEAR(
      HoppingFoothold(scene.context(), scene.memory, 0).x() - running_m,
      0.3 * (scene.gains.transition.leaving_run_gain_s - scene.gains.hopping.run_velocity_gain_s),
      1e-12);
  scene.memory.speed.desired_mps = 1.8;  // The reach: 0.115 s of 3 m/s.
  EXPECT_NEAR(HoppingFoothold(scene.context(), scene.memory, 0).x(), 0.345, 1e-12);
  scene.body.v_WC.x() = 1.5;  // Slower than wanted: nothing to brake.
  const double slow_m = HoppingFoothold(scene.context(), scene.memory, 0).x();
  scene.goal.gait = stream::Gait::kRun;
  EXPECT_EQ(HoppingFoothold(scene.context(), scene.memory, 0).x(), slow_m);
}

TEST(Equation2, TurnsWithTheHeading) {
  LawsScene scene;
  scene.memory.gait = stream::Gait::kRun;
  scene.body.v_WC = {2, 0, 0};
  scene.memory.speed.desired_mps = 2;
  const Vector3d straight = HoppingFoothold(scene.context(), scene.memory, 1);
  scene.memory.heading_rad = 0.7;
  scene.body.v_WC = ToWorld(0.7, {2, 0, 0});
  const Vector3d turned = HoppingFoothold(scene.context(), scene.memory, 1);
  EXPECT_LT((turned - ToWorld(0.7, straight)).norm(), 1e-12);
}

TEST(Mirrored, SwingsTheIdleLegAgainstTheOther) {
  const Vector3d mirrored = Mirrored(0, {0.3, 0.1, -0.9}, 0.7, 0);
  EXPECT_NEAR(mirrored.x(), -0.7 * std::sin(std::atan2(0.3, 0.9)), 1e-12);
  EXPECT_NEAR(mirrored.y(), -0.7 * std::sin(std::atan2(0.1, 0.9)), 1e-12);
  EXPECT_LT(mirrored.z(), 0);
}

TEST(Mirrored, SwingsAsideBesides) {
  const Vector3d mirrored = Mirrored(0, {0.3, 0, -0.9}, 0.7, 0.2);
  EXPECT_NEAR(mirrored.y(), 0.7 * std::sin(0.2), 1e-12);
}

TEST(Turning, PutsTheFootSoThatItsForceTurnsTheVelocity) {
  LawsScene scene;
  scene.memory.gait = stream::Gait::kRun;
  scene.body.v_WC = {3, 0, 0};
  scene.memory.speed.desired_mps = 3;
  scene.memory.step_time_s = 0.5;
  scene.memory.hop.support_time_s = 0.2;
  const double straight_m = HoppingFoothold(scene.context(), scene.memory, 0).y();
  scene.goal.turn_per_step_rad = 0.08;
  const double turned_m = HoppingFoothold(scene.context(), scene.memory, 0).y();
  // The leg leans by (v turn / T) / g to the outer side; the COM moves 3 m/s * 0.1 s on half
  // turned.
  const double length_m = scene.gains.hopping.touchdown_length_m;
  EXPECT_NEAR(turned_m - straight_m,
              -length_m * (3 * 0.08 / 0.5) / kStandardGravityMps2 + 3 * 0.1 * 0.08 / 2, 1e-12);
}

TEST(Turning, HoldsARunBankedAndTurningAsItsHeadingDoes) {
  LawsScene scene;
  scene.memory.speed.desired_mps = 4;
  scene.memory.turning_radps = 0.2;
  Targets targets;
  targets.hopping = true;
  const double bank_rad = BankAngle(scene.memory, scene.gains.attitude);
  EXPECT_NEAR(bank_rad, -scene.gains.attitude.bank_share * 4 * 0.2 / kStandardGravityMps2, 1e-12);
  scene.body.R_WB = Eigen::AngleAxisd(bank_rad, Vector3d::UnitX()).toRotationMatrix();
  scene.body.w_WB = {0, 0, 0.2};
  EXPECT_LT(BodyMoment(scene.body, scene.memory, targets, scene.gains.attitude).norm(), 1e-9);
}

/// A run's or jump's support, the hips still, the legs swinging.
struct SupportScene : LawsScene {
  explicit SupportScene(stream::Gait gait) {
    memory.gait = goal.gait = gait;
    memory.running = RunningPhase::kCompression;
    for (biped::LegState& leg : body.legs) {
      leg.length_m = 0.9;
      leg.touching = true;
      leg.joint_velocity = {0, 0.5, -1.5, 0};
      leg.hinge_axes_W.col(0) = Vector3d::UnitZ();
      leg.hinge_axes_W.col(1) = Vector3d::UnitX();
      leg.hinge_axes_W.col(2) = Vector3d::UnitY();
    }
  }
};

TEST(Support, DampsTheMomentumOfBodyAndLegsAsIfItWereTheBodysRate) {
  for (const stream::Gait gait : {stream::Gait::kRun, stream::Gait::kJump}) {
    const SupportScene scene(gait);
    const Targets targets = RunningTargets(scene.context(), scene.memory);
    const Vector3d momentum = AngularMomentum(scene.body, scene.biped);
    ASSERT_GT(std::fabs(momentum.y()), 0.1);
    EXPECT_NEAR(targets.rate_W_radps.x(), -momentum.x() / scene.biped.body_inertia_roll_kgm2, 1e-9);
    EXPECT_NEAR(targets.rate_W_radps.y(), -momentum.y() / scene.biped.body_inertia_pitch_kgm2,
                1e-9);
    EXPECT_NEAR(targets.rate_W_radps.z(),
                -scene.gains.attitude.hop_yaw_momentum_share * momentum.z() /
                    scene.biped.body_inertia_yaw_kgm2,
                1e-9);
  }
}

TEST(Support, RightsATiltInPitchByTheEndOfAJumpsFlight) {
  LawsScene scene;
  scene.body.R_WB = Eigen::AngleAxisd(0.1, Vector3d::UnitY()).toRotationMatrix();
  Targets targets;
  targets.hopping = targets.jumping = true;
  targets.flight_s = 0.6;
  const Vector3d moment = BodyMoment(scene.body, scene.memory, targets, scene.gains.attitude);
  EXPECT_NEAR(moment.y(), -scene.gains.attitude.pitch_damping_nms_per_rad / 0.6 * 0.1, 1e-9);
}

TEST(Support, TakesEnergyOutOfARunThatIsToEnd) {
  SupportScene scene(stream::Gait::kRun);
  const auto damping = [&scene] {
    return RunningTargets(scene.context(), scene.memory).legs[0].axial.damping_ns_per_m;
  };
  EXPECT_EQ(damping(), scene.gains.hopping.run_leg_damping_ns_per_m);
  scene.goal.gait = stream::Gait::kWalk;
  EXPECT_EQ(damping(), scene.gains.transition.leaving_run_damping_ns_per_m);
  scene.memory.running = RunningPhase::kExtension;
  EXPECT_EQ(damping(), scene.gains.hopping.run_leg_damping_ns_per_m);
}

TEST(Flight, OfAJumpThatTurnsOverSwingsTheFarLegOut) {
  SupportScene scene(stream::Gait::kJump);
  scene.memory.running = RunningPhase::kUpwardFlight;
  const auto feet_m = [&scene](double roll_rad) {
    scene.body.R_WB = Eigen::AngleAxisd(roll_rad, Vector3d::UnitX()).toRotationMatrix();
    const Targets targets = RunningTargets(scene.context(), scene.memory);
    return std::array{targets.legs[0].r_HF_W_m.y(), targets.legs[1].r_HF_W_m.y()};
  };
  const auto upright = feet_m(0);
  const double from_rad = scene.gains.recovery.jump_yield_from_rad;
  EXPECT_EQ(feet_m(-0.9 * from_rad), upright);
  const auto to_the_left = feet_m(-from_rad - 0.1);
  EXPECT_EQ(to_the_left[0], upright[0]);
  EXPECT_LT(to_the_left[1], upright[1] - 0.1);
  const auto to_the_right = feet_m(from_rad + 0.1);
  EXPECT_GT(to_the_right[0], upright[0] + 0.1);
  EXPECT_EQ(to_the_right[1], upright[1]);
}

TEST(LegInverseKinematics, BringsTheFootWhereItIsWanted) {
  const biped::BipedParameters biped = test::Biped();
  const Vector3d wanted(0.25, -0.12, -0.85);
  const auto joints = LegInverseKinematics(biped, wanted);
  // Roll about x, then pitch about y, then along -z.
  const Vector3d foot = Eigen::AngleAxisd(joints[1], Vector3d::UnitX()) *
                        (Eigen::AngleAxisd(joints[2], Vector3d::UnitY()) *
                         Vector3d(0, 0, -(biped.leg_length_m + joints[3])));
  EXPECT_LT((foot - wanted).norm(), 1e-12);
}

TEST(LegInverseKinematics, StaysWithinTheLegsStroke) {
  const biped::BipedParameters biped = test::Biped();
  EXPECT_EQ(LegInverseKinematics(biped, {0, 0, -9})[3], biped.leg_length_max_m - 1);
  EXPECT_EQ(LegInverseKinematics(biped, {0, 0, -0.01})[3], biped.leg_length_min_m - 1);
  for (const double joint : LegInverseKinematics(biped, Vector3d::Zero())) {
    EXPECT_TRUE(std::isfinite(joint));
  }
}

}  // namespace
}  // namespace footing::gait
