#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "common/base/units.h"
#include "common/camera/camera_pose.h"
#include "tests/common/camera/boards.h"

namespace footing::camera_pose {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

std::string RefusalOf(const Observations& observations) {
  const auto pose = Calibrate(observations);
  return pose ? "" : pose.error().message;
}

TEST(Marks, LieOverTheLoadCellsOnceAroundEachBoard) {
  const auto marks = BoardMarks(*board::LayoutNamed("side_by_side", 20), kRadiusM);
  ASSERT_EQ(marks.size(), 8u);
  EXPECT_EQ(marks[0].name, "front left, left board");
  EXPECT_EQ(marks[2].name, "rear right, left board");
  EXPECT_NEAR(marks[0].p_W_m.x() - marks[3].p_W_m.x(), 0.238, 1e-12);  // Front is forward.
  EXPECT_NEAR(marks[0].p_W_m.y() - marks[1].p_W_m.y(), 0.433, 1e-12);
  EXPECT_NEAR(marks[0].p_W_m.z(), 0.0225, 1e-12);  // The radius: W's z is 0 where people stand.
  EXPECT_EQ(BoardMarks(*board::LayoutNamed("single", 20), kRadiusM).size(), 4u);
}

TEST(Marks, AreNamedAsThePersonLooks) {
  // Its long sides lie along the walk.
  const auto marks = BoardMarks(*board::LayoutNamed("one_foot_each", 20), kRadiusM);
  ASSERT_EQ(marks.size(), 8u);
  EXPECT_EQ(marks[4].name, "front left, right board");
  for (const std::size_t board : {0u, 4u}) {
    EXPECT_NEAR(marks[board].p_W_m.x() - marks[board + 3].p_W_m.x(), 0.433, 1e-12);
    EXPECT_NEAR(marks[board].p_W_m.y() - marks[board + 1].p_W_m.y(), 0.238, 1e-12);
    EXPECT_NEAR(marks[board + 1].p_W_m.x() - marks[board + 2].p_W_m.x(), 0.433, 1e-12);
  }
}

TEST(CameraPose, OfMarksWithoutNoiseIsTheTrueOne) {
  const auto pose = Calibrate(Seen(kTrue));
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_TRUE(pose->X_WC.isApprox(kTrue, 1e-9));
  EXPECT_NEAR(pose->scale, 1, 1e-9);
  EXPECT_LT(pose->residual_rms_m, 1e-9);
}

TEST(CameraPose, CovarianceIsThatOfItsErrors) {
  noise::Random random(11);
  const Vector3d hand(0, 0.2, 1.2);
  double nees = 0, misfit = 0, scale = 0;
  constexpr int kTrials = 200;
  for (int i = 0; i < kTrials; ++i) {
    Observations observations = Seen(kTrue);
    const double common = random.Normal();
    for (SeenMark& mark : observations.marks) {
      // Depth: half of the variance is common to all marks, half each one's own.
      const Vector3d depth_sd = 1e-3 * mark.seen.p_C_m.norm() * mark.seen.p_C_m;
      mark.seen.p_C_m += std::sqrt(0.5) * (common + random.Normal()) * depth_sd +
                         1e-4 * Normal3(random) + 1e-3 * Normal3(random);
    }
    const CameraPose pose = Fit(observations);
    const Vector3d error = pose.X_WC * (kTrue.inverse() * hand) - hand;
    nees += error.dot(pose.CovarianceAt(hand).ldlt().solve(error)) / 3 / kTrials;
    misfit += pose.misfit / kTrials;
    scale += std::pow((pose.scale - 1) / pose.scale_sd, 2) / kTrials;
  }
  // Mean of 200 of 3 degrees of freedom each: standard deviation sqrt(2 / 600) = 0.06.
  EXPECT_NEAR(nees, 1, 0.2);
  EXPECT_NEAR(misfit, 1, 0.1);
  EXPECT_NEAR(scale, 1, 0.3);
}

TEST(CameraPose, PlumbsHoldTheVerticalThatMarksLeaveOpen) {
  Observations observations;
  const auto marks = BoardMarks(*board::LayoutNamed("single", 20), kRadiusM);
  for (const Mark& mark : marks) observations.marks.push_back({mark, SeenAt(kTrue, mark.p_W_m)});
  const double alone = Fit(observations).TurnSdRad();
  for (const Mark& mark : marks)
    observations.plumbs.push_back(
        {SeenAt(kTrue, mark.p_W_m), SeenAt(kTrue, mark.p_W_m + Vector3d(0, 0, 0.19)), 0.005});
  const auto pose = Calibrate(observations);
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_LT(pose->TurnSdRad(), alone);
  EXPECT_LT(pose->tilt_rad, 1e-9);
  EXPECT_TRUE(pose->X_WC.isApprox(kTrue, 1e-9));
}

TEST(CameraPose, RefusesTooFewMarksAndALine) {
  Observations observations = Seen(kTrue);
  Observations two = observations;
  two.marks.resize(2);
  EXPECT_THAT(RefusalOf(two), HasSubstr("2 marks"));
  Observations line = observations;
  line.marks = {observations.marks[0], observations.marks[1]};
  line.marks.push_back(line.marks[0]);
  EXPECT_THAT(RefusalOf(line), HasSubstr("in a line"));
}

TEST(CameraPose, RefusesAMirroredImage) {
  Observations observations = Seen(kTrue);
  for (SeenMark& mark : observations.marks) mark.seen.p_C_m.x() *= -1;
  EXPECT_THAT(RefusalOf(observations), HasSubstr("as in a mirror"));
}

TEST(CameraPose, RefusesLengthsThatAreOff) {
  // A focal length that is 5 % too great sees everything 5 % too far away.
  Observations observations = Seen(kTrue);
  for (SeenMark& mark : observations.marks) mark.seen.p_C_m *= 1.05;
  const std::string refusal = RefusalOf(observations);
  EXPECT_THAT(refusal, HasSubstr("5.0 %"));
  EXPECT_THAT(refusal, HasSubstr("multiply radius_m by 0.952"));
}

TEST(CameraPose, NamesTheMarkThatIsInTheWrongPlace) {
  Observations observations = Seen(kTrue);
  observations.marks[5].seen = SeenAt(kTrue, observations.marks[5].p_W_m + Vector3d(0, 0.03, 0));
  EXPECT_THAT(RefusalOf(observations), HasSubstr("mark " + observations.marks[5].name + " is"));
}

TEST(CameraPose, RefusesGravityThatDisagreesWithTheBoards) {
  Observations observations = Seen(kTrue);
  for (const std::size_t i : {0, 4}) {
    const Vector3d low = observations.marks[i].p_W_m;
    // 6 degrees of 0.19 m.
    observations.plumbs.push_back(
        {SeenAt(kTrue, low), SeenAt(kTrue, low + Vector3d(0.02, 0, 0.19)), 0});
  }
  EXPECT_THAT(RefusalOf(observations), HasSubstr("6.0 degrees"));
}

TEST(CameraPose, RefusesADirectionThatStaysUncertain) {
  Observations observations = Seen(kTrue);
  observations.placement_sd_m = 0.02;
  EXPECT_THAT(RefusalOf(observations), HasSubstr("stays uncertain by"));
}

std::vector<SeenPoint> Frames(int count, double moving_m, std::uint64_t seed) {
  noise::Random random(seed);
  const SeenPoint place = SeenAt(kTrue, Vector3d::Zero());
  const Eigen::LLT<Eigen::Matrix3d> root(place.covariance_m2);
  std::vector<SeenPoint> frames(static_cast<std::size_t>(count), place);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Vector3d noise = root.matrixL() * Normal3(random);
    frames[i].p_C_m += noise;
    frames[i].p_C_m.x() += moving_m * static_cast<double>(i) / count;
  }
  return frames;
}

TEST(MeanAtRest, AveragesWhatScatters) {
  const auto mean = MeanAtRest(Frames(120, 0, 3));
  ASSERT_TRUE(mean);
  const SeenPoint place = SeenAt(kTrue, Vector3d::Zero());
  const Vector3d error = mean->p_C_m - place.p_C_m;
  // The mean of 120 has a hundredth of the variance; six deviations.
  EXPECT_LT(error.dot(place.covariance_m2.ldlt().solve(error)), 36 / 120.0);
  EXPECT_LT(mean->covariance_m2.trace(), 0.5 * place.covariance_m2.trace());
}

TEST(MeanAtRest, KeepsWhatAllFramesHaveInCommon) {
  // The same error in all frames: nothing scatters, and nothing is averaged away.
  const SeenPoint place = SeenAt(kTrue, Vector3d::Zero());
  const auto mean = MeanAtRest(std::vector<SeenPoint>(60, place));
  ASSERT_TRUE(mean);
  EXPECT_TRUE(mean->covariance_m2.isApprox(place.covariance_m2, 1e-9));
}

TEST(MeanAtRest, RefusesASphereThatMovesAndOneHardlySeen) {
  EXPECT_THAT(MeanAtRest(Frames(60, 0.02, 4)).error().message, HasSubstr("the sphere moved by"));
  EXPECT_THAT(MeanAtRest(Frames(12, 0, 5)).error().message, HasSubstr("seen in 12 frames"));
}

TEST(MeanAtRest, TakesNoiseForRest) {
  for (std::uint64_t seed = 0; seed < 300; ++seed)
    EXPECT_TRUE(MeanAtRest(Frames(static_cast<int>(kLeastFrames), 0, seed))) << seed;
}

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

constexpr double kHeightM = 1.74;

/// A person of that height whose measures are off by `body` standard deviations.
Observations Poses(const Eigen::Matrix<double, kBodyMeasures, 1>& body) {
  Observations observations;
  observations.in_poses = true;
  observations.placement_sd_m = kPoseSdM;
  for (const Mark& mark : PoseMarks(kHeightM, kFistToSphereM))
    observations.marks.push_back({mark, SeenAt(kTrue, mark.p_W_m + mark.per_sd * body)});
  return observations;
}

const Eigen::Matrix<double, kBodyMeasures, 1> kAsExpected =
    Eigen::Matrix<double, kBodyMeasures, 1>::Zero();

TEST(Poses, AreAPersonsWithArmsDownAheadAndToTheSides) {
  const auto marks = PoseMarks(kHeightM, kFistToSphereM);
  ASSERT_EQ(marks.size(), 6u);
  EXPECT_EQ(marks[0].name, "left hand, arms down");
  EXPECT_EQ(marks[5].name, "right hand, arms to the sides");
  const double arm_m = 0.351 * kHeightM, shoulder_m = 0.791 * kHeightM;
  EXPECT_NEAR(marks[0].p_W_m.z(), shoulder_m - std::cos(0.07) * arm_m, 1e-9);
  EXPECT_NEAR(marks[2].p_W_m.z(), shoulder_m + 0.11, 1e-9);  // The spheres are above the fists,
  EXPECT_NEAR(marks[0].p_W_m.x(), 0.11 - 0.020 * kHeightM, 1e-9);  // and before hanging ones.
  EXPECT_NEAR(marks[2].p_W_m.x(), arm_m - 0.0385 * kHeightM, 1e-9);
  EXPECT_NEAR(marks[4].p_W_m.y() - marks[5].p_W_m.y(), 2 * (arm_m + 0.108 * kHeightM), 1e-9);
}

TEST(Poses, OfThePersonThatIsExpectedGiveTheTrueCamera) {
  const auto pose = Calibrate(Poses(kAsExpected));
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_TRUE(pose->X_WC.isApprox(kTrue, 1e-9));
  EXPECT_LT(pose->residual_rms_m, 1e-9);
}

TEST(Poses, ShowHowLongThePersonsArmsAre) {
  auto body = kAsExpected;
  body[2] = 2;  // 49 mm longer.
  const auto pose = Calibrate(Poses(body));
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_NEAR(pose->body[2], 2, 0.6);
  // Less than half of what the hands are off.
  EXPECT_LT((pose->X_WC.translation() - kTrue.translation()).norm(), 0.024);
}

TEST(Poses, CovarianceIsThatOfItsErrors) {
  noise::Random random(5);
  const Vector3d hand(0.2, 0.3, 1.4);
  double nees = 0;
  constexpr int kTrials = 150;
  for (int i = 0; i < kTrials; ++i) {
    auto body = kAsExpected;
    for (double& measure : body) measure = random.Normal();
    Observations poses = Poses(body);
    for (SeenMark& mark : poses.marks) mark.seen.p_C_m += kPoseSdM * Normal3(random);
    const CameraPose pose = Fit(poses);
    const Vector3d error = pose.X_WC * (kTrue.inverse() * hand) - hand;
    nees += error.dot(pose.CovarianceAt(hand).ldlt().solve(error)) / 3 / kTrials;
    EXPECT_LT(RadiansToDegrees(pose.TurnSdRad()), 3);
  }
  EXPECT_NEAR(nees, 1, 0.2);
}

TEST(Poses, OfAMirrorOrWithControllersInTheWrongHandsAreRefused) {
  Observations exchanged = Poses(kAsExpected);
  for (std::size_t i = 0; i < 6; i += 2)
    std::swap(exchanged.marks[i].seen, exchanged.marks[i + 1].seen);
  EXPECT_THAT(RefusalOf(exchanged), HasSubstr("each controller is in the other hand"));
  Observations mirrored = Poses(kAsExpected);
  for (SeenMark& mark : mirrored.marks) mark.seen.p_C_m.x() *= -1;
  EXPECT_THAT(RefusalOf(mirrored), HasSubstr("as in a mirror"));
}

TEST(Poses, WithAWrongArmNameIt) {
  // The right arm hangs on while the left one points ahead.
  Observations poses = Poses(kAsExpected);
  poses.marks[3].seen = poses.marks[1].seen;
  EXPECT_THAT(RefusalOf(poses), HasSubstr("the right hand, arms ahead, is"));
}

TEST(Poses, SeenTooLargeAreRefused) {
  // With noise, arms may be longer than expected; 30 % is a lens, or another person.
  Observations poses = Poses(kAsExpected);
  for (SeenMark& mark : poses.marks) mark.seen.p_C_m *= 1.3;
  EXPECT_THAT(RefusalOf(poses), HasSubstr("Check the height"));
}

}  // namespace
}  // namespace footing::camera_pose
