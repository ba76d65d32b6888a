#include "common/camera/samples.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/common/camera/boards.h"

namespace footing::camera_pose {
namespace {

const Eigen::Isometry3d kFirst = LookingAtTheBoards({2.1, 0.4, 1.3});
const Eigen::Isometry3d kLater = LookingAtTheBoards({1.8, -0.5, 0.9});

stream::HandSample SampleBy(const Eigen::Isometry3d& X_WC, const SeenPoint& seen) {
  stream::HandSample sample;
  sample.confidence = 0.9;
  sample.position_m = seen.p_C_m;
  sample.sd_m = seen.covariance_m2.diagonal().cwiseSqrt();
  sample.covariance_m2 = {seen.covariance_m2(0, 1), seen.covariance_m2(0, 2),
                          seen.covariance_m2(1, 2)};
  sample.tracker_pose = stream::TrackerPose{};  // Not calibrated: in the camera's own frame.
  return Recalibrated(sample, X_WC);
}

TEST(Samples, ANewCalibrationGivesWhatItWouldHaveGivenThen) {
  const SeenPoint seen = SeenAt(kFirst, {0.2, 0.3, 1.1});
  const auto old = SampleBy(kFirst, seen), wanted = SampleBy(kLater, seen);
  EXPECT_LT((old.position_m - Eigen::Vector3d(0.2, 0.3, 1.1)).norm(), 1e-12);
  const auto again = Recalibrated(old, kLater);
  EXPECT_LT((again.position_m - wanted.position_m).norm(), 1e-12);
  EXPECT_LT((again.sd_m - wanted.sd_m).norm(), 1e-12);
  EXPECT_LT((again.covariance_m2 - wanted.covariance_m2).norm(), 1e-15);
  const auto raw = InTrackerFrame(again);
  ASSERT_TRUE(raw);
  EXPECT_LT((raw->p_C_m - seen.p_C_m).norm(), 1e-12);
  EXPECT_TRUE(raw->covariance_m2.isApprox(seen.covariance_m2, 1e-9));
}

TEST(Samples, WhatWasNotSeenOrHasNoFrameStays) {
  stream::HandSample sample = SampleBy(kFirst, SeenAt(kFirst, {0.2, 0.3, 1.1}));
  sample.confidence = 0;
  EXPECT_FALSE(InTrackerFrame(sample));
  const auto again = Recalibrated(sample, kLater);
  EXPECT_EQ(again.position_m, sample.position_m);
  EXPECT_LT((again.tracker_pose->position_m - kLater.translation()).norm(), 1e-12);
  stream::HandSample skeleton;
  skeleton.confidence = 1;
  skeleton.position_m = {1, 2, 1};
  EXPECT_FALSE(InTrackerFrame(skeleton));
  EXPECT_EQ(Recalibrated(skeleton, kLater).position_m, skeleton.position_m);
}

}  // namespace
}  // namespace footing::camera_pose
