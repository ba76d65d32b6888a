#include "clients/camera/tracking.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "common/camera/find.h"
#include "common/virtual/camera/render.h"
#include "daemon/sensor/mounting/hands.h"

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
  const auto frames = ToHandFrames(FacingThePerson(), FacingThePerson().X_WC,
                                   {OneEstimate(), OneEstimate()}, 1'000, 21'000);
  ASSERT_EQ(frames.size(), 2u);
  ASSERT_EQ(hands::Problem(frames[0]), "");
  const stream::TrackedPoint& point = frames[0].points.at(0);
  EXPECT_EQ(point.role, stream::DeviceRole::kLeftHand);
  EXPECT_LT((point.position_m - Eigen::Vector3d(2 - 1.9, 0.3, 1 - 0.2)).norm(), 1e-12);
  EXPECT_NEAR(point.sd_m.x(), 5e-3, 1e-9);  // The camera's depth.
  EXPECT_NEAR(point.sd_m.y(), 1e-4, 1e-9);
  EXPECT_NEAR(point.sd_m.z(), 2e-4, 1e-9);
  EXPECT_NEAR(point.covariance_m2.x(), -3e-7, 1e-12);
  EXPECT_NEAR(frames[0].age_ns, 20'000, 1);
}

TEST(Observation, CarriesThePoseByWhichItIsInTheWorld) {
  const auto camera = FacingThePerson();
  const auto frame = ToHandFrames(camera, camera.X_WC, {OneEstimate(), OneEstimate()}, 0, 0)[1];
  ASSERT_TRUE(frame.tracker_pose);
  EXPECT_EQ(frame.tracker_pose->position_m, camera.X_WC->translation());
  EXPECT_TRUE(frame.tracker_pose->rotation.toRotationMatrix().isApprox(camera.X_WC->linear()));
  const auto plain = ToHandFrames(camera, {}, {OneEstimate(), OneEstimate()}, 0, 0)[1];
  EXPECT_EQ(plain.points[0].position_m, OneEstimate().p_C_m);
  EXPECT_TRUE(plain.tracker_pose->rotation.isApprox(Eigen::Quaterniond::Identity()));
}

TEST(Observation, SaysWhichSphereIsNotSeen) {
  const auto frames =
      ToHandFrames(FacingThePerson(), FacingThePerson().X_WC, {std::nullopt, OneEstimate()}, 0, 0);
  ASSERT_EQ(frames.size(), 2u);
  ASSERT_EQ(hands::Problem(frames[0]), "");
  EXPECT_EQ(frames[0].points.at(0).confidence, 0);
  EXPECT_EQ(frames[0].points.at(0).role, stream::DeviceRole::kLeftHand);
  EXPECT_EQ(frames[1].points.at(0).confidence, 0.9);
}

TEST(Observation, ASphereOnTheHeadIsThatJoint) {
  frames::CameraFile camera = FacingThePerson();
  camera.spheres[1].role = stream::DeviceRole::kHead;
  const auto frames = ToHandFrames(camera, camera.X_WC, {OneEstimate(), OneEstimate()}, 0, 0);
  ASSERT_EQ(hands::Problem(frames[1]), "");
  EXPECT_EQ(frames[1].points.at(0).role, stream::DeviceRole::kUnspecified);
  EXPECT_EQ(frames[1].points.at(0).joint, stream::BodyJoint::kHead);
}

TEST(Observation, IsAsOldAsTheRowOnWhichTheSphereIs) {
  frames::CameraFile camera = FacingThePerson();
  sphere::Estimate low = OneEstimate(), high = OneEstimate();
  low.centre_px.y() = camera.lens.height - 1;
  high.centre_px.y() = 0;
  const auto frames = ToHandFrames(camera, camera.X_WC, {low, high}, 0, 20'000'000);
  // Half the readout after the middle row, and before it.
  EXPECT_NEAR(frames[0].age_ns, 20'000'000 - 1e9 * camera.readout_s / 2, 2);
  EXPECT_NEAR(frames[1].age_ns, 20'000'000 + 1e9 * camera.readout_s / 2, 2);
  // One that is not seen has no row; the middle one's time counts.
  const auto unseen = ToHandFrames(camera, camera.X_WC, {low, std::nullopt}, 0, 20'000'000);
  EXPECT_EQ(unseen[1].age_ns, 20'000'000);
}

TEST(Observation, OfEachOfTwoFastSpheresIsItsPlaceAtItsTime) {
  // Both fall at 4 m/s, one seen near the upper edge, one near the lower edge: 11 ms apart, 43 mm.
  const frames::CameraFile camera = FacingThePerson();
  const Eigen::Vector3d v_C_mps(0, 4, 0);
  virtual_camera::Scene scene;
  scene.balls.resize(2);
  scene.balls[0].p_C_m = {-0.3, -0.6, 2};
  scene.balls[1].p_C_m = {0.3, 0.6, 2};
  scene.balls[1].colour_dn = {40, 170, 160};
  for (auto& ball : scene.balls) ball.v_C_mps = v_C_mps;
  noise::Random random(7);
  const auto mosaic = virtual_camera::Render(scene, random);
  std::vector<sphere::Target> targets(2);
  targets[1].colour_dn = scene.balls[1].colour_dn;
  sphere::Finder finder(camera.lens, targets, camera.settings);
  const auto found =
      finder.Find({sphere::PixelFormat::kSgrbg8, mosaic.width, mosaic.height, mosaic.bytes});
  constexpr std::int64_t kExposedNs = 1'000'000'000, kNowNs = 1'030'000'000;
  const auto frames = ToHandFrames(camera, camera.X_WC, found, kExposedNs, kNowNs);
  ASSERT_EQ(frames.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto samples = hands::ToSamples(frames[i], kNowNs, "rig");
    ASSERT_EQ(samples.size(), 1u);
    ASSERT_GT(samples[0].confidence, 0.5) << i;
    const double after_s = 1e-9 * static_cast<double>(samples[0].sampled_ns - kExposedNs);
    const Eigen::Vector3d truth_C_m = scene.balls[i].p_C_m + after_s * v_C_mps;
    const Eigen::Vector3d error_m = camera.X_WC->inverse() * samples[0].position_m - truth_C_m;
    // Across the line of sight.
    EXPECT_LT(error_m.cross(truth_C_m.normalized()).norm(), 1e-3) << i;
  }
}

TEST(Observation, OfAPlaceThatFootingdWouldRefuseIsNotSeen) {
  sphere::Estimate far = OneEstimate();
  far.p_C_m.z() = 15;
  const auto frames =
      ToHandFrames(FacingThePerson(), FacingThePerson().X_WC, {far, OneEstimate()}, 0, 0);
  EXPECT_EQ(hands::Problem(frames[0]), "");
  EXPECT_EQ(frames[0].points[0].confidence, 0);
}

}  // namespace
}  // namespace footing::camera
