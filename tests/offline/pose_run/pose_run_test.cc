#include "daemon/offline/pose_run/pose_run.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/body/kinematics.h"
#include "common/body/points.h"
#include "daemon/offline/pose_run/held_hands.h"
#include "daemon/simulation/pose/arm_geometry.h"
#include "tests/offline/pose_run/standing.h"

namespace footing::pose_run {
namespace {

PoseRun RunOf(const Settings& settings) {
  return RunPose(Standing(4), settings, "standing").value();
}

TEST(PoseRun, TheCellsCarryTheBody) {
  Settings settings;
  settings.mass_kg = 80;
  const PoseRun run = RunOf(settings);
  ASSERT_GT(run.frames.size(), 600u);
  for (const Frame& frame : {run.frames[100], run.frames.back()}) {
    const auto pressure = momentum::PressureOf(frame.inputs.loads, 10);
    EXPECT_NEAR(pressure.total_n, 80 * 9.80665, 1);
    EXPECT_NEAR((pressure.p_WP_m - frame.com_m).head<2>().norm(), 0, 0.005);
    EXPECT_NEAR(frame.feet[0].load_n + frame.feet[1].load_n, pressure.total_n, 1);
  }
}

TEST(PoseRun, TheHandsAreWhereTheFistsAreButForTheirNoise) {
  Settings settings;
  settings.hand_noise_m = 0.02;
  const PoseRun run = RunOf(settings);
  body::Kinematics at(run.body.skeleton);
  double sum = 0;
  for (const Frame& frame : run.frames) {
    body::ComputeKinematics(run.body.skeleton, frame.q, at);
    const body::Point fist = body::Fist(run.body, 1);
    const auto joint = static_cast<std::size_t>(fist.joint);
    ASSERT_TRUE(frame.inputs.hands[1].valid);
    sum += (frame.inputs.hands[1].p_W_m - body::Place(fist, at.R_WJ[joint], at.p_WJ[joint]))
               .squaredNorm();
  }
  // Three axes of 2 cm each.
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(run.frames.size()) / 3), 0.02, 0.002);
  settings.hands = false;
  EXPECT_FALSE(RunOf(settings).frames[0].inputs.hands[0].valid);
}

TEST(PoseRun, AKinectsHandsAreCarriedOnToNow) {
  Settings settings;
  settings.hand_device = HandDevice::kKinect;
  const PoseRun run = RunOf(settings);
  EXPECT_FALSE(run.frames[3].inputs.hands[0].valid);  // 67 ms are 4 frames.
  ASSERT_TRUE(run.frames[4].inputs.hands[0].valid);
  double changes = 0, apart = 0, away = 0, count = 0;
  body::Kinematics at(run.body.skeleton);
  const body::Point fist = body::Fist(run.body, 0);
  const auto joint = static_cast<std::size_t>(fist.joint);
  for (std::size_t i = 10; i < run.frames.size(); ++i) {
    const auto& hands = run.frames[i].inputs.hands;
    changes += hands[0].p_W_m != run.frames[i - 1].inputs.hands[0].p_W_m ? 1 : 0;
    // The offset is common to both, the noise is not.
    const Eigen::Vector3d middle = 0.5 * (hands[0].p_W_m + hands[1].p_W_m);
    apart += (hands[0].p_W_m - middle).squaredNorm();
    body::ComputeKinematics(run.body.skeleton, run.frames[i].q, at);
    away += (hands[0].p_W_m - body::Place(fist, at.R_WJ[joint], at.p_WJ[joint])).squaredNorm();
    ++count;
  }
  EXPECT_GT(changes / count, 0.99);  // Between the 30 exposures a second, too.
  // Late by 67 ms, so less sure than the 4.3 cm along an axis of an exposure.
  const double sd_m = run.frames.back().inputs.hands[0].sd_m.x();
  EXPECT_GT(sd_m, 0.0427);
  EXPECT_LT(sd_m, 0.15);
  EXPECT_LT(std::sqrt(away / count / 3), sd_m);
  EXPECT_GT(apart / count, 0.3);
}

TEST(PoseRun, AWiimoteTellsReadingsAndNoPlaces) {
  Settings settings;
  settings.hand_device = HandDevice::kWiimote;
  PoseRun run = RunOf(settings);
  EXPECT_NEAR(run.reading_s, 1.0 / 60, 1e-9);
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const Frame& frame = run.frames[i];
    ASSERT_FALSE(frame.inputs.hands[0].valid);
    ASSERT_EQ(frame.readings[0][0].size(), 1u);
    force += frame.readings[0][0][0].specific_force_S_mps2 / static_cast<double>(run.frames.size());
  }
  EXPECT_NEAR(force.norm(), 9.8, 0.5);  // Gravity, with a gain and a bias.

  arms::ArmModel model;
  model.mean.setZero();
  model.scale.setZero();
  model.weights.setZero(arms::kDirections, arms::ArmFeatures::kCount);
  model.offset << 0, 1, 0, 0, 0, 1, 0, 1, 0;
  model.covariance.setIdentity();
  EstimateArms(model, run);
  EXPECT_FALSE(run.frames[300].inputs.arms[0].valid);
  EXPECT_TRUE(run.frames[340].inputs.arms[0].valid);
  EXPECT_LT((run.frames[340].inputs.arms[1].directions.upper + Eigen::Vector3d::UnitY()).norm(),
            1e-9);
}

/// The furthest that an upper arm's or forearm's direction is off.
double WorstOfStraps(bool perfect) {
  Settings settings;
  settings.hand_device = HandDevice::kStraps;
  settings.perfect_devices = perfect;
  PoseRun run = RunOf(settings);
  EXPECT_TRUE(run.frames[0].readings[0][0].empty()) << "no fist";
  EstimateArms(std::nullopt, run);
  body::Kinematics at(run.body.skeleton);
  double worst = 0;
  for (std::size_t i = 345; i < run.frames.size(); ++i) {
    body::ComputeKinematics(run.body.skeleton, run.frames[i].q, at);
    for (const int side : {0, 1}) {
      const arms::ArmEstimate& arm = run.frames[i].inputs.arms[static_cast<std::size_t>(side)];
      EXPECT_TRUE(arm.valid) << i;
      const arms::ArmDirections truth = arms::ArmGeometry(run.body, side).Directions(at);
      worst = std::max({worst, (arm.directions.upper - truth.upper).norm(),
                        (arm.directions.forearm - truth.forearm).norm()});
    }
  }
  return worst;
}

TEST(PoseRun, StrapsShowBothArmsWithoutAModel) {
  const double perfect = WorstOfStraps(true), real = WorstOfStraps(false);
  EXPECT_LT(perfect, 0.06);
  EXPECT_LT(real, 0.3);
  EXPECT_GT(real, perfect) << "noise, bias and mounting show";
}

TEST(PoseRun, ErrorsOfTheLayoutMoveWhereTheCellsAreToldToBe) {
  Settings settings;
  const PoseRun right = RunOf(settings);
  settings.gap_error_m = 0.04;
  settings.mass_error = 0.02;
  const PoseRun wrong = RunOf(settings);
  const auto cell = [](const PoseRun& r, std::size_t foot, std::size_t frame) {
    return r.frames[frame].inputs.loads.feet[foot].cells[0];
  };
  EXPECT_NEAR(cell(wrong, 0, 0).p_WS_m.y() - cell(right, 0, 0).p_WS_m.y(), 0.02, 1e-9);
  EXPECT_NEAR(cell(wrong, 1, 0).p_WS_m.y() - cell(right, 1, 0).p_WS_m.y(), -0.02, 1e-9);
  EXPECT_NEAR(cell(wrong, 0, 0).load_n / cell(right, 0, 0).load_n, 1.02, 1e-9);
  EXPECT_NEAR(cell(wrong, 0, 400).load_n / cell(right, 0, 400).load_n, 1, 1e-9);
}

TEST(PoseRun, NamesTheClipThatHasNoPerson) {
  motion::Motion motion = Standing(1);
  motion.skeleton.joints[0].name = "thing";
  for (body::Joint& joint : motion.skeleton.joints) joint.name = "x" + joint.name;
  const auto made = RunPose(motion, {}, "chair.bvh");
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().message.find("chair.bvh"), std::string::npos);
}

}  // namespace
}  // namespace footing::pose_run
