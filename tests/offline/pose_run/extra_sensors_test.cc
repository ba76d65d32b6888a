#include "daemon/offline/pose_run/extra_sensors.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "common/body/kinematics.h"
#include "common/body/skeleton_points.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "tests/offline/pose_run/standing.h"

namespace footing::pose_run {
namespace {

constexpr std::size_t kHead = body::IndexOf(stream::BodyJoint::kHead);
constexpr double kTurnRad = 0.8;

/// Turns to the left and back on the spot, with the arms out.
motion::Motion Turning(double seconds) {
  motion::Motion motion = Standing(seconds);
  constexpr int kHeading = 3;  // The root's first angle (common/body).
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    motion.q(kHeading, i) = kTurnRad * std::sin(static_cast<double>(i) / motion.rate_hz);
  }
  return motion;
}

PoseRun RunOf(HeadDevice head, bool belt, double seconds = 4) {
  Settings settings;
  settings.head = head;
  if (belt) settings.segments = {reconstruction::BodySite::kPelvis};
  return RunPose(Turning(seconds), settings, "turning").value();
}

TEST(ExtraSensors, AddNothingToHandsAndBoards) {
  const PoseRun plain = RunOf(HeadDevice::kNone, false), more = RunOf(HeadDevice::kSphere, true);
  for (std::size_t i = 0; i < plain.frames.size(); ++i) {
    const auto& ours = plain.frames[i].inputs;
    const auto& theirs = more.frames[i].inputs;
    ASSERT_EQ(ours.hands[0].p_W_m, theirs.hands[0].p_W_m) << i;
    ASSERT_EQ(ours.loads.feet[1].cells[2].load_n, theirs.loads.feet[1].cells[2].load_n) << i;
    ASSERT_FALSE(ours.joints[kHead].valid || ours.turns[0].valid) << i;
  }
  const PoseRun without = WithoutExtras(more);
  EXPECT_FALSE(without.frames.back().inputs.joints[kHead].valid);
  EXPECT_FALSE(without.frames.back().inputs.turns[0].valid);
}

TEST(ExtraSensors, AHeadsErrorsAreThoseItReports) {
  const PoseRun run = RunOf(HeadDevice::kSphere, false);
  const body::Point head = body::SkeletonPoints(run.body)[kHead];
  body::Kinematics at(run.body.skeleton);
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  double square_m2 = 0;
  const double share = 1 / static_cast<double>(run.frames.size());
  for (const Frame& frame : run.frames) {
    body::ComputeKinematics(run.body.skeleton, frame.q, at);
    const auto& input = frame.inputs.joints[kHead];
    ASSERT_TRUE(input.valid);
    const auto joint = static_cast<std::size_t>(head.joint);
    const Eigen::Vector3d off_m =
        at.R_WJ[joint].transpose() * (input.p_W_m - body::Place(head, at));
    mean_m += share * off_m;
    square_m2 += share * off_m.squaredNorm();
  }
  // The constant part is the cap's height and the T-pose's error, the changing part the noise.
  const HeadErrors errors;
  EXPECT_NEAR(mean_m.norm(), errors.above_m, 3 * std::hypot(errors.seat_sd_m, errors.t_pose_sd_m));
  EXPECT_NEAR(std::sqrt((square_m2 - mean_m.squaredNorm()) / 3), errors.noise_m, 0.001);
  EXPECT_NEAR(run.frames[0].inputs.joints[kHead].sd_m.x(), errors.noise_m, 1e-12);
}

TEST(ExtraSensors, MovesShowHowTheHandsHaveTurned) {
  Settings settings;
  settings.segments = {reconstruction::BodySite::kLeftHand, reconstruction::BodySite::kRightHand};
  const PoseRun run = RunPose(Turning(4), settings, "turning").value();
  EXPECT_TRUE(run.headings.empty()) << "no squat shows their heading";
  body::Kinematics at(run.body.skeleton), before(run.body.skeleton);
  body::ComputeKinematics(run.body.skeleton, run.frames.front().q, before);
  for (const auto site : settings.segments) {
    const auto joint = static_cast<std::size_t>(run.body.landmarks[reconstruction::JointOf(site)]);
    double worst_rad = 0, mean_rad = 0;
    for (std::size_t i = run.judged_from; i < run.frames.size(); ++i) {
      const arms::HandState& turn = run.frames[i].inputs.turns[static_cast<std::size_t>(site)];
      ASSERT_TRUE(turn.valid) << i;
      body::ComputeKinematics(run.body.skeleton, run.frames[i].q, at);
      const Eigen::Matrix3d off = turn.turn_W * before.R_WJ[joint] * at.R_WJ[joint].transpose();
      const double off_rad = Eigen::AngleAxisd(off).angle();
      worst_rad = std::max(worst_rad, off_rad);
      mean_rad += off_rad / static_cast<double>(run.frames.size() - run.judged_from);
    }
    // The grip, the bent wrist of the T-pose and the slip, each of 0.05 to 0.1 about an axis.
    EXPECT_LT(worst_rad, 0.7);
    EXPECT_GT(mean_rad, 0.03) << "nobody holds it perfectly";
    EXPECT_LT(mean_rad, 0.4);
  }
}

TEST(ExtraSensors, AKinectShowsTheHeadLateAndLessSurely) {
  const PoseRun run = RunOf(HeadDevice::kKinect, false);
  EXPECT_FALSE(run.frames[3].inputs.joints[kHead].valid);  // 67 ms are 4 frames.
  ASSERT_TRUE(run.frames[4].inputs.joints[kHead].valid);
  EXPECT_GT(run.frames.back().inputs.joints[kHead].sd_m.x(), 0.0427);
  EXPECT_FALSE(run.frames.back().inputs.joints[kHead + 1].valid);  // The head alone.
}

TEST(ExtraSensors, ABeltShowsHowThePelvisHasTurnedSinceTheTPose) {
  const PoseRun run = RunOf(HeadDevice::kNone, true, 12);
  EXPECT_FALSE(run.frames[static_cast<std::size_t>(5 * run.rate_hz)].inputs.turns[0].valid);
  body::Kinematics at(run.body.skeleton);
  double square = 0, sd = 0, furthest_rad = 0;
  for (std::size_t i = run.judged_from; i < run.frames.size(); ++i) {
    const arms::HandState& belt = run.frames[i].inputs.turns[0];
    ASSERT_TRUE(belt.valid) << i;
    body::ComputeKinematics(run.body.skeleton, run.frames[i].q, at);
    const Eigen::AngleAxisd off(belt.turn_W.transpose() * at.R_WJ[0]);
    square += off.angle() * off.angle();
    sd = belt.heading_sd_rad;
    furthest_rad = std::max(furthest_rad, std::abs(Eigen::AngleAxisd(at.R_WJ[0]).angle()));
  }
  EXPECT_GT(furthest_rad, 0.9 * kTurnRad);
  const double rms_rad = std::sqrt(square / static_cast<double>(run.frames.size()));
  // The slip of the belt about three axes, and the device's own.
  EXPECT_GT(rms_rad, 0.03);
  EXPECT_LT(rms_rad, 0.13);
  EXPECT_GT(sd, run.frames[run.judged_from].inputs.turns[0].heading_sd_rad)
      << "nothing corrects it";
}

TEST(ExtraSensors, StateHowWellASquatHasShownWhichWayTheyFace) {
  const auto scene = Stage(Standing(1), {}, "standing");
  ASSERT_TRUE(scene.ok());
  using reconstruction::BodySite;
  const std::vector<BodySite> sites{BodySite::kPelvis, BodySite::kLeftThigh, BodySite::kRightShank};
  std::vector<double> nees(sites.size());
  constexpr int kSeeds = 20;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const ExtraSensors extra(*scene, HeadDevice::kNone, sites, true, seed, 1 / 60.0);
    const auto headings = extra.headings();
    ASSERT_EQ(headings.size(), sites.size());
    for (std::size_t i = 0; i < sites.size(); ++i) {
      ASSERT_TRUE(headings[i].known) << i;
      nees[i] += std::pow(headings[i].error_rad / headings[i].sd_rad, 2) / kSeeds;
    }
  }
  for (std::size_t i = 0; i < nees.size(); ++i) {
    EXPECT_GT(nees[i], 0.3) << i;
    EXPECT_LT(nees[i], 1.8) << i;
  }
}

TEST(ExtraSensors, WithoutASquatTheyDoNotKnowWhichWayTheyFace) {
  Settings settings;
  settings.segments = {reconstruction::BodySite::kPelvis};
  settings.squat_before = false;
  const PoseRun run = RunPose(Turning(4), settings, "turning").value();
  for (const Frame& frame : run.frames) ASSERT_FALSE(frame.inputs.turns[0].valid);
  ASSERT_EQ(run.headings.size(), 1u);
  EXPECT_FALSE(run.headings[0].known);
}

}  // namespace
}  // namespace footing::pose_run
