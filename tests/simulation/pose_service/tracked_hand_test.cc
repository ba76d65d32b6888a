#include "daemon/simulation/pose_service/tracked_hand.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "common/camera/find.h"
#include "common/base/units.h"
#include "common/virtual/camera/random_scene.h"
#include "common/virtual/camera/render.h"

namespace footing::pose_service {
namespace {

v1::HandSample Sample(const std::string& tracker, const Eigen::Vector3d& p_W_m,
                      const Eigen::Vector3d& sd_m) {
  v1::HandSample sample;
  sample.set_tracker(tracker);
  sample.set_confidence(1);
  sample.mutable_position_m()->set_x(p_W_m.x());
  sample.mutable_position_m()->set_y(p_W_m.y());
  sample.mutable_position_m()->set_z(p_W_m.z());
  sample.mutable_sd_m()->set_x(sd_m.x());
  sample.mutable_sd_m()->set_y(sd_m.y());
  sample.mutable_sd_m()->set_z(sd_m.z());
  return sample;
}

const Eigen::Vector3d kHere(0.2, 0.6, 1.3);
constexpr std::int64_t kNowNs = 7'000'000'000;

TEST(TrackedHand, EachTrackerCountsAlongTheAxisThatItKnows) {
  TrackedHand hand;
  hand.Add(Sample("front", kHere, {0.1, 0.01, 0.01}), 7, kNowNs);
  hand.Add(Sample("side", kHere + Eigen::Vector3d(0.01, 0.01, 0.01), {0.01, 0.1, 0.01}), 7, kNowNs);
  const TrackedHand::Fused fused = hand.At(kNowNs);
  ASSERT_TRUE(fused.hand.valid);
  // Weights 1 : 100 along x, 100 : 1 along y, 1 : 1 along z.
  const Eigen::Vector3d off_m = fused.hand.p_W_m - kHere;
  EXPECT_NEAR(off_m.x(), 0.01 * 100 / 101, 1e-9);
  EXPECT_NEAR(off_m.y(), 0.01 / 101, 1e-9);
  EXPECT_NEAR(off_m.z(), 0.01 / 2, 1e-9);
  EXPECT_NEAR(fused.hand.sd_m.z(), 0.01 / std::sqrt(2), 1e-9);
  EXPECT_EQ(fused.trackers, (std::set<std::string>{"front", "side"}));
}

TEST(TrackedHand, ContradictionMakesItLessCertain) {
  TrackedHand hand;
  const Eigen::Vector3d sd_m = Eigen::Vector3d::Constant(0.01);
  hand.Add(Sample("a", kHere, sd_m), 7, kNowNs);
  hand.Add(Sample("b", kHere + Eigen::Vector3d(0.3, 0, 0), sd_m), 7, kNowNs);
  // Each is 15 deviations from the middle: chi squared 450 of 3 degrees of freedom.
  EXPECT_NEAR(hand.At(kNowNs).hand.sd_m.x(), 0.01 / std::sqrt(2) * std::sqrt(450.0 / 3), 1e-6);
}

/// A level Move that points along W's x and swings along y from 12 s on, and the camera, which sees
/// its sphere until some time.
void Swing(double seen_until_s, double to_s, bool simulated, TrackedHand& hand) {
  constexpr double kReachM = 0.2, kRadps = 6;
  const double ahead_m = simulated ? 0 : 0.1125;
  for (double t_s = 10; t_s < to_s; t_s += 0.005) {
    const double swing = t_s < 12 ? 0 : kReachM * std::sin(kRadps * (t_s - 12));
    v1::MotionSample sample;
    sample.set_device(4);
    sample.set_simulated(simulated);
    sample.set_sampled_ns(SecondsToNanoseconds(t_s));
    sample.mutable_specific_force_mps2()->set_x(-kRadps * kRadps * swing);
    sample.mutable_specific_force_mps2()->set_z(-9.80665);
    sample.mutable_angular_velocity_radps();
    hand.Feel(sample);
    if (t_s > seen_until_s) continue;
    v1::HandSample seen =
        Sample("camera", kHere + Eigen::Vector3d(ahead_m, swing, 0), {0.005, 0.002, 0.002});
    seen.set_sampled_ns(SecondsToNanoseconds(t_s));
    hand.Add(seen, t_s, SecondsToNanoseconds(t_s));
  }
}

TEST(TrackedHand, AMoveBridgesWhatTheCameraDoesNotSee) {
  TrackedHand with, without;
  with.Bind(4);
  for (TrackedHand* hand : {&with, &without}) Swing(18, 18.3, true, *hand);
  const std::int64_t seen_ns = SecondsToNanoseconds(18), now_ns = SecondsToNanoseconds(18.3);
  EXPECT_FALSE(without.At(now_ns, now_ns).hand.valid);
  const TrackedHand::Fused fused = with.At(now_ns, now_ns);
  ASSERT_TRUE(fused.hand.valid);
  EXPECT_EQ(fused.trackers, std::set<std::string>{"camera"});
  const Eigen::Vector3d truth_m = kHere + Eigen::Vector3d(0, 0.2 * std::sin(6 * 6.3), 0);
  EXPECT_LT((fused.hand.p_W_m - truth_m).norm(), 0.03);
  EXPECT_GT(fused.hand.sd_m.x(), with.At(seen_ns, seen_ns).hand.sd_m.x());
  with.Bind(5);
  EXPECT_FALSE(with.At(now_ns, now_ns).hand.valid);
}

TEST(TrackedHand, ARealMoveIsHeldBehindItsSphereAsSoonAsItsHeadingIsKnown) {
  TrackedHand real;
  real.Bind(4);
  Swing(11, 11, false, real);
  std::int64_t now_ns = SecondsToNanoseconds(11);
  EXPECT_NEAR(real.At(now_ns, now_ns).hand.p_W_m.x(), kHere.x() + 0.1125, 0.01) << "at rest";
  real = TrackedHand();
  real.Bind(4);
  Swing(18, 18, false, real);
  now_ns = SecondsToNanoseconds(18);
  EXPECT_NEAR(real.At(now_ns, now_ns).hand.p_W_m.x(), kHere.x(), 0.02);
}

TEST(TrackedHand, ATrackerThatIsSilentIsLeftOut) {
  TrackedHand hand;
  const Eigen::Vector3d sd_m = Eigen::Vector3d::Constant(0.01);
  hand.Add(Sample("camera", kHere, sd_m), 7, kNowNs);
  const std::int64_t later_ns = kNowNs + SecondsToNanoseconds(0.16);
  hand.Add(Sample("kinect", kHere + Eigen::Vector3d(0.1, 0, 0), 4 * sd_m), 7.16, later_ns);
  EXPECT_NEAR(hand.At(later_ns).hand.p_W_m.x(), kHere.x() + 0.1, 1e-9);
  EXPECT_EQ(hand.At(later_ns).trackers, std::set<std::string>{"kinect"});
  EXPECT_FALSE(hand.At(later_ns + SecondsToNanoseconds(0.16)).hand.valid);
}

TEST(TrackedHand, AnotherTrackerTooManyReplacesTheOneHeardLongestAgo) {
  TrackedHand hand;
  for (int i = 0; i < 5; ++i) {
    hand.Add(Sample(std::to_string(i), kHere, Eigen::Vector3d::Constant(0.01)), 7, kNowNs + i);
  }
  EXPECT_EQ(hand.At(kNowNs + 4).trackers, (std::set<std::string>{"1", "2", "3", "4"}));
}

TEST(CountedPoint, ItsInformationIsTheTrackersTimesItsConfidence) {
  v1::HandSample sample = Sample("camera", kHere, {0.01, 0.02, 0.03});
  sample.mutable_covariance_m2()->set_x(0.0001);
  sample.set_confidence(0.25);
  const CountedPoint point(sample);
  EXPECT_LT((point.sd_m - Eigen::Vector3d(0.02, 0.04, 0.06)).norm(), 1e-12);
  EXPECT_NEAR(point.covariance_m2.x(), 0.0004, 1e-15);
}

TEST(CountedPoint, IsNeverBetterThanTwoMillimetresNorWorseThanAMetre) {
  v1::HandSample sample = Sample("camera", kHere, {1e-6, 0.5, 0.5});
  EXPECT_EQ(CountedPoint(sample).sd_m.x(), 0.002);
  sample.set_confidence(1e-9);
  const CountedPoint point(sample);
  EXPECT_TRUE(point.sd_m.allFinite());
  EXPECT_LE(point.sd_m.maxCoeff(), 1);
}

/// Of a magenta sphere at a good exposure times `exposure`, with a halo, in front of a camera that
/// stands ahead of the person and looks back.
struct Sphere {
  double nees = 0, counted_nees = 0;  // Of depth.
  int saturated = 0, found = 0;

  Sphere(double distance_m, double exposure) {
    noise::Random random(31);
    Eigen::Matrix3d R_WC;
    R_WC << 0, 0, -1, 1, 0, 0, 0, -1, 0;
    const Eigen::Vector3d camera_m(2.5, 0, 1.1);
    sphere::Finder finder(sphere::Lens(), {sphere::Target()}, sphere::Settings());
    for (int i = 0; i < 8; ++i) {
      virtual_camera::Scene scene;
      virtual_camera::Ball& ball = scene.balls.emplace_back();
      ball.p_C_m = virtual_camera::PlaceInView(scene.lens, distance_m, 0.8, random);
      ball.colour_dn *= exposure;
      ball.halo = 0.08;
      const auto image = virtual_camera::Render(scene, random);
      const auto seen =
          finder.Find({sphere::PixelFormat::kSgrbg8, image.width, image.height, image.bytes})[0];
      if (!seen) continue;
      ++found;
      saturated += seen->is_saturated ? 1 : 0;
      Add(R_WC * seen->covariance_m2 * R_WC.transpose(), camera_m + R_WC * seen->p_C_m,
          camera_m + R_WC * ball.p_C_m, camera_m, *seen);
    }
    nees /= found;
    counted_nees /= found;
  }

 private:
  void Add(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& p_W_m,
           const Eigen::Vector3d& truth_m, const Eigen::Vector3d& camera_m,
           const sphere::Estimate& seen) {
    v1::HandSample sample = Sample("camera", p_W_m, covariance.diagonal().cwiseSqrt());
    sample.mutable_covariance_m2()->set_x(covariance(0, 1));
    sample.mutable_covariance_m2()->set_y(covariance(0, 2));
    sample.mutable_covariance_m2()->set_z(covariance(1, 2));
    sample.set_confidence(seen.confidence);
    sample.set_saturated(seen.is_saturated);
    sample.mutable_tracker_pose()->set_x_m(camera_m.x());
    sample.mutable_tracker_pose()->set_z_m(camera_m.z());
    sample.mutable_tracker_pose()->set_qw(1);
    // Along the line of sight: across it no point counts as better than 2 mm.
    const Eigen::Vector3d sight = (truth_m - camera_m).normalized();
    const double error2_m2 = std::pow(sight.dot(p_W_m - truth_m), 2);
    nees += error2_m2 / sight.dot(covariance * sight);
    const CountedPoint point(sample);
    Eigen::Matrix3d counted = point.sd_m.cwiseAbs2().asDiagonal();
    counted(0, 1) = counted(1, 0) = point.covariance_m2.x();
    counted(0, 2) = counted(2, 0) = point.covariance_m2.y();
    counted(1, 2) = counted(2, 1) = point.covariance_m2.z();
    counted_nees += error2_m2 / sight.dot(counted * sight);
  }
};

TEST(CountedPoint, ASphereAtTheSensorsLimitCountsForWhatItIsWorth) {
  for (const double distance_m : {1.0, 3.0}) {
    for (const double exposure : {2.0, 4.0}) {
      const Sphere sphere(distance_m, exposure);
      ASSERT_GT(sphere.found, 6) << distance_m << " m, " << exposure;
      EXPECT_EQ(sphere.saturated, sphere.found);
      EXPECT_LE(sphere.counted_nees, sphere.nees) << "its own covariance is taken for too large";
      EXPECT_LE(sphere.counted_nees, 1.2) << distance_m << " m, " << exposure;
      EXPECT_GE(sphere.counted_nees, 0.1) << distance_m << " m, " << exposure;
    }
  }
}

}  // namespace
}  // namespace footing::pose_service
