#include "clients/view/scene/signs.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace footing::scene {
namespace {

constexpr std::int64_t kSeenNs = 5'000'000'000;

stream::HandSample Sample(stream::DeviceRole role, double confidence) {
  stream::HandSample sample;
  sample.rig = "main";
  sample.tracker = "camera";
  sample.role = role;
  sample.confidence = confidence;
  sample.position_m = {0.3, 0.4, 1.2};
  sample.sd_m = {0.02, 0.001, 0.005};
  return sample;
}

BodySigns SignsOf(const std::vector<SeenHand>& hands) {
  BodySigns signs;
  AddHandSigns(hands, "main", kSeenNs, signs);
  return signs;
}

TEST(HandSigns, AnObservationIsAnEllipsoidOfTwoDeviations) {
  const Eigen::Matrix3f axes = HandEllipsoid(Sample(stream::DeviceRole::kLeftHand, 1));
  const Eigen::Matrix3f square = axes * axes.transpose();
  EXPECT_NEAR(square(0, 0), 0.04 * 0.04, 1e-6);
  EXPECT_NEAR(square(2, 2), 0.01 * 0.01, 1e-6);
  EXPECT_NEAR(square(1, 1), 0.008 * 0.008, 1e-6);  // The least that can be seen.
  // Variance of depth along a line of sight that is turned: the long axis lies along it.
  stream::HandSample turned = Sample(stream::DeviceRole::kLeftHand, 1);
  turned.sd_m = {0.02, 0.02, 0.001};
  turned.covariance_m2.x() = 0.0004 * 0.99;
  const Eigen::Matrix3f long_axes = HandEllipsoid(turned);
  Eigen::Index longest = 0;
  long_axes.colwise().norm().maxCoeff(&longest);
  const Eigen::Vector3f along = long_axes.col(longest).normalized();
  EXPECT_NEAR(std::abs(along.dot(Eigen::Vector3f(1, 1, 0).normalized())), 1, 1e-3);
}

TEST(HandSigns, WhatIsHiddenOrLostIsNamedWhereItIs) {
  std::vector<SeenHand> hands;
  TakeHand(Sample(stream::DeviceRole::kLeftHand, 0.9), kSeenNs, hands);
  EXPECT_EQ(SignsOf(hands).solid.balls.size(), 1u);
  EXPECT_TRUE(SignsOf(hands).labels.empty());
  stream::HandSample hidden = Sample(stream::DeviceRole::kRightHand, 0.4);
  hidden.occluded = true;
  TakeHand(hidden, kSeenNs, hands);
  ASSERT_EQ(SignsOf(hands).labels.size(), 1u);
  EXPECT_EQ(SignsOf(hands).labels[0].text, "right hand partly hidden");
  stream::HandSample lost = Sample(stream::DeviceRole::kLeftHand, 0);
  lost.position_m.setZero();
  TakeHand(lost, kSeenNs, hands);
  ASSERT_EQ(hands.size(), 2u);
  ASSERT_EQ(SignsOf(hands).labels.size(), 2u);
  EXPECT_EQ(SignsOf(hands).labels[0].text, "left hand not seen");
  EXPECT_NEAR(SignsOf(hands).labels[0].at_m.z(), 1.2, 1e-6);
}

TEST(HandSigns, JointsHaveTheirOwnEllipsoidsAndSayWhatIsHidden) {
  std::vector<SeenHand> points;
  const auto take = [&](stream::BodyJoint joint, double confidence, bool occluded) {
    stream::HandSample sample = Sample(stream::DeviceRole::kUnspecified, confidence);
    sample.joint = joint;
    sample.occluded = occluded;
    TakeHand(sample, kSeenNs, points);
  };
  take(stream::BodyJoint::kHead, 1, false);
  take(stream::BodyJoint::kLeftKnee, 0.5, true);
  take(stream::BodyJoint::kRightFoot, 1, false);
  take(stream::BodyJoint::kRightFoot, 0, false);
  TakeHand(Sample(stream::DeviceRole::kUnspecified, 1), kSeenNs, points);  // A hand of no body.
  const BodySigns signs = SignsOf(points);
  EXPECT_EQ(signs.solid.balls.size(), 3u);
  ASSERT_EQ(signs.labels.size(), 2u);
  EXPECT_EQ(signs.labels[0].text, "left knee hidden");
  EXPECT_EQ(signs.labels[1].text, "right foot not seen");
}

TEST(HandSigns, NothingIsShownOfATrackerThatIsSilentOrOfAnotherRig) {
  std::vector<SeenHand> hands;
  TakeHand(Sample(stream::DeviceRole::kLeftHand, 0.9), kSeenNs - 600'000'000, hands);
  EXPECT_TRUE(SignsOf(hands).solid.balls.empty());
  stream::HandSample other = Sample(stream::DeviceRole::kLeftHand, 0.9);
  other.rig = "second";
  TakeHand(other, kSeenNs, hands);
  EXPECT_TRUE(SignsOf(hands).solid.balls.empty());
  // Never seen, so without a place.
  std::vector<SeenHand> none;
  TakeHand(Sample(stream::DeviceRole::kLeftHand, 0), kSeenNs, none);
  EXPECT_TRUE(SignsOf(none).solid.balls.empty());
}

}  // namespace
}  // namespace footing::scene
