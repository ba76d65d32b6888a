#include "clients/camera/observation.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "daemon/sensor/hands/hands.h"

namespace footing::camera {
namespace {

/// A camera at (2, 0, 1) that looks along -x of W: its z is -x, its x is +y, its y is -z.
frames::CameraFile FacingThePerson() {
  frames::CameraFile camera;
  camera.X_WC = Eigen::Isometry3d::Identity();
  camera.X_WC->linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  camera.X_WC->translation() << 2, 0, 1;
  camera.spheres = {{stream::DeviceRole::kLeftHand, {}}, {stream::DeviceRole::kRightHand, {}}};
  return camera;
}

/// One axis each, so that it can be followed through the turn.
sphere::Estimate OneEstimate() {
  sphere::Estimate estimate;
  estimate.p_C_m = {0.3, 0.2, 1.9};
  estimate.covariance_m2 = Eigen::Vector3d(1e-8, 4e-8, 2.5e-5).asDiagonal();
  estimate.covariance_m2(0, 2) = estimate.covariance_m2(2, 0) = 3e-7;
  estimate.confidence = 0.9;
  estimate.centre_px = {400, 239.5};
  return estimate;
}

TEST(Observation, IsInTheWorldWithItsWholeCovariance) {
  const auto frame = ToHandFrame(FacingThePerson(), FacingThePerson().X_WC,
                                 {OneEstimate(), OneEstimate()}, 1'000, 21'000);
  ASSERT_EQ(hands::Problem(frame), "");
  const stream::TrackedPoint& point = frame.points.at(0);
  EXPECT_EQ(point.role, stream::DeviceRole::kLeftHand);
  EXPECT_LT((point.position_m - Eigen::Vector3d(2 - 1.9, 0.3, 1 - 0.2)).norm(), 1e-12);
  EXPECT_NEAR(point.sd_m.x(), 5e-3, 1e-9);  // The camera's depth.
  EXPECT_NEAR(point.sd_m.y(), 1e-4, 1e-9);
  EXPECT_NEAR(point.sd_m.z(), 2e-4, 1e-9);
  EXPECT_NEAR(point.covariance_m2.x(), -3e-7, 1e-12);
  EXPECT_NEAR(frame.age_ns, 20'000, 1);
}

TEST(Observation, CarriesThePoseByWhichItIsInTheWorld) {
  const auto camera = FacingThePerson();
  const auto frame = ToHandFrame(camera, camera.X_WC, {OneEstimate(), OneEstimate()}, 0, 0);
  ASSERT_TRUE(frame.tracker_pose);
  EXPECT_EQ(frame.tracker_pose->position_m, camera.X_WC->translation());
  EXPECT_TRUE(frame.tracker_pose->rotation.toRotationMatrix().isApprox(camera.X_WC->linear()));
  const auto plain = ToHandFrame(camera, {}, {OneEstimate(), OneEstimate()}, 0, 0);
  EXPECT_EQ(plain.points[0].position_m, OneEstimate().p_C_m);
  EXPECT_TRUE(plain.tracker_pose->rotation.isApprox(Eigen::Quaterniond::Identity()));
}

TEST(Observation, SaysWhichSphereIsNotSeen) {
  const auto frame =
      ToHandFrame(FacingThePerson(), FacingThePerson().X_WC, {std::nullopt, OneEstimate()}, 0, 0);
  ASSERT_EQ(hands::Problem(frame), "");
  ASSERT_EQ(frame.points.size(), 2u);
  EXPECT_EQ(frame.points[0].confidence, 0);
  EXPECT_EQ(frame.points[0].role, stream::DeviceRole::kLeftHand);
  EXPECT_EQ(frame.points[1].confidence, 0.9);
}

TEST(Observation, IsAsOldAsTheRowOnWhichTheSphereIs) {
  frames::CameraFile camera = FacingThePerson();
  sphere::Estimate low = OneEstimate();
  low.centre_px.y() = camera.lens.height - 1;
  // Half the readout after the middle row.
  const auto frame = ToHandFrame(camera, camera.X_WC, {low, std::nullopt}, 0, 20'000'000);
  EXPECT_NEAR(frame.age_ns, 20'000'000 - 1e9 * camera.readout_s / 2, 2);
}

TEST(Observation, OfAPlaceThatFootingdWouldRefuseIsNotSeen) {
  sphere::Estimate far = OneEstimate();
  far.p_C_m.z() = 15;
  const auto frame =
      ToHandFrame(FacingThePerson(), FacingThePerson().X_WC, {far, OneEstimate()}, 0, 0);
  EXPECT_EQ(hands::Problem(frame), "");
  EXPECT_EQ(frame.points[0].confidence, 0);
}

}  // namespace
}  // namespace footing::camera
