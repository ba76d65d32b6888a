#include "daemon/simulation/pose/inertial_track.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "common/virtual/devices/noise.h"

namespace footing::inertial {
namespace {

constexpr double kGravityMps2 = 9.80665, kReadingS = 1.0 / 175, kFrameS = 1.0 / 60;
constexpr double kSwingRadps = 5;  // 0.8 Hz.
const Eigen::Vector3d kReach_m(0.15, 0.1, 0.2), kBehind_rad(0, 1.1, 2.3);

/// A hand that rests for 2 s and then swings along all axes while it rolls to and fro; its heading
/// is 1 rad from W's.
struct Swing {
  Eigen::Vector3d p_W_m{0.2, 0.5, 1.2}, v_W_mps{0, 0, 0}, a_W_mps2{0, 0, 0}, w_S_radps{0, 0, 0};
  Eigen::Matrix3d R_WS = Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()).toRotationMatrix();

  explicit Swing(double time_s) {
    const double t_s = time_s - 2;
    if (t_s < 0) return;
    // The swing sets in slowly.
    const double w = kSwingRadps, in = 1 - std::exp(-t_s * t_s),
                 in1 = 2 * t_s * std::exp(-t_s * t_s),
                 in2 = (2 - 4 * t_s * t_s) * std::exp(-t_s * t_s);
    for (int k = 0; k < 3; ++k) {
      const double s = std::sin(w * t_s + kBehind_rad(k)), c = std::cos(w * t_s + kBehind_rad(k));
      p_W_m(k) += kReach_m(k) * in * s;
      v_W_mps(k) = kReach_m(k) * (in1 * s + in * w * c);
      a_W_mps2(k) = kReach_m(k) * (in2 * s + 2 * in1 * w * c - in * w * w * s);
    }
    const double angle_rad = 0.8 * in * std::sin(w * t_s);
    w_S_radps.x() = 0.8 * (in1 * std::sin(w * t_s) + in * w * std::cos(w * t_s));
    R_WS = R_WS * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
  }
};

/// Feeds a track with a swing: readings with noise and biases, observations with noise.
class Person {
 public:
  explicit Person(const Eigen::Vector3d& p_SP_m = Eigen::Vector3d::Zero())
      : track(p_SP_m), p_SP_m_(p_SP_m) {}

  /// To a time; observations by `seen`, which may change or leave one out.
  using Seen = std::function<std::optional<Eigen::Vector3d>(double time_s, Eigen::Vector3d p_W_m)>;
  void Until(double end_s, const Seen& seen) {
    for (; time_s_ < end_s; time_s_ += kReadingS) {
      const Swing at(time_s_);
      arms::HandReading reading;
      reading.specific_force_S_mps2 =
          at.R_WS.transpose() * (at.a_W_mps2 + Eigen::Vector3d(0, 0, kGravityMps2)) +
          Eigen::Vector3d(0.1, -0.08, 0.05) + Noise(0.06);
      reading.angular_velocity_S_radps =
          at.w_S_radps + Eigen::Vector3d(0.006, -0.004, 0.005) + Noise(0.006);
      track.Feel(kEpochS + time_s_, reading);
      if (time_s_ < frame_s_ + 0.02) continue;
      const Swing then(frame_s_);
      const auto p_W_m = seen(frame_s_, then.p_W_m + then.R_WS * p_SP_m_);
      if (p_W_m)
        track.See(kEpochS + frame_s_, {*p_W_m + kSdM.cwiseProduct(Noise(1)), Covariance()});
      frame_s_ += kFrameS;
    }
  }

  Track::State Now() const { return track.At(kEpochS + time_s_); }
  double OffM() const { return (Now().p_W_m - Swing(time_s_).p_W_m).norm(); }
  double VarianceM2() const { return Now().covariance.diagonal().head<3>().sum(); }
  double Nees() const {
    const Eigen::Vector3d off_m = Now().p_W_m - Swing(time_s_).p_W_m;
    return off_m.dot(Now().covariance.topLeftCorner<3, 3>().inverse() * off_m) / 3;
  }
  double time_s() const { return time_s_; }

  Track track;
  static constexpr double kEpochS = 1000;

 private:
  inline static const Eigen::Vector3d kSdM{0.004, 0.0005, 0.0005};  // Depth along x.
  static Eigen::Matrix3d Covariance() { return kSdM.cwiseAbs2().asDiagonal(); }
  Eigen::Vector3d Noise(double sd) {
    return sd * Eigen::Vector3d(random_.Normal(), random_.Normal(), random_.Normal());
  }

  Eigen::Vector3d p_SP_m_;
  noise::Random random_{5};
  double time_s_ = 0, frame_s_ = 0;
};

std::optional<Eigen::Vector3d> Plainly(double, Eigen::Vector3d p_W_m) { return p_W_m; }
std::optional<Eigen::Vector3d> NotAtAll(double, Eigen::Vector3d) { return std::nullopt; }

TEST(InertialTrack, FollowsAHandWhoseHeadingItDidNotKnow) {
  Person person;
  person.Until(12, Plainly);
  ASSERT_TRUE(person.Now().valid);
  EXPECT_LT(person.OffM(), 0.01);
  EXPECT_LT((person.Now().v_W_mps - Swing(person.time_s()).v_W_mps).norm(), 0.1);
  EXPECT_EQ(person.track.refused(), 0u);
}

TEST(InertialTrack, BridgesHalfASecondAndSaysHowUncertainItIs) {
  Person person;
  double nees = 0, furthest_m = 0;
  int holes = 0;
  for (double end_s = 8; end_s < 30; end_s += 2.3, ++holes) {
    person.Until(end_s, Plainly);
    const double seen_m2 = person.VarianceM2();
    person.Until(end_s + 0.5, NotAtAll);
    ASSERT_TRUE(person.Now().valid);
    EXPECT_GT(person.VarianceM2(), 4 * seen_m2);
    nees += person.Nees();
    furthest_m = std::max(furthest_m, person.OffM());
  }
  EXPECT_LT(furthest_m, 0.1);  // On a path of about 1.2 m.
  EXPECT_LT(nees / holes, 2.5);
  EXPECT_GT(nees / holes, 0.05);
  person.Until(person.time_s() + 0.2, NotAtAll);
  EXPECT_FALSE(person.Now().valid);
}

TEST(InertialTrack, RefusesALampThatTheReadingsContradict) {
  Person person;
  person.Until(10, Plainly);
  person.Until(10.2, [](double, Eigen::Vector3d p_W_m) -> std::optional<Eigen::Vector3d> {
    return p_W_m + Eigen::Vector3d(0, 0.4, 0);
  });
  EXPECT_GT(person.track.refused(), 8u);
  EXPECT_LT(person.OffM(), 0.05);
  person.Until(11, Plainly);
  EXPECT_LT(person.OffM(), 0.02) << "and the hand is taken again";
}

TEST(InertialTrack, StartsAgainWhereTheHandStays) {
  Person person;
  person.Until(10, Plainly);
  person.Until(14, [](double, Eigen::Vector3d p_W_m) -> std::optional<Eigen::Vector3d> {
    return p_W_m + Eigen::Vector3d(0, 1, 0);  // The camera was moved.
  });
  ASSERT_TRUE(person.Now().valid);
  EXPECT_NEAR(person.Now().p_W_m.y() - Swing(person.time_s()).p_W_m.y(), 1, 0.05);
}

TEST(InertialTrack, ReportsTheDeviceWhenAPointAheadOfItIsSeen) {
  Person person({0.11, 0, 0});
  person.Until(2, Plainly);
  EXPECT_FALSE(person.Now().valid) << "its heading is not known yet";
  person.Until(14, Plainly);
  EXPECT_LT(person.OffM(), 0.02);
}

TEST(InertialTrack, IsNotValidWithoutReadings) {
  Person person;
  person.Until(5, Plainly);
  EXPECT_TRUE(person.Now().valid);
  EXPECT_FALSE(person.track.At(Person::kEpochS + person.time_s() + 0.15).valid);
  person.track.Feel(1, {});  // Another clock.
  EXPECT_FALSE(person.track.At(1).valid);
  person.track.Feel(1.005, {});
  person.track.See(1.005, {});
  EXPECT_FALSE(person.track.At(1.005).valid);
}

}  // namespace
}  // namespace footing::inertial
