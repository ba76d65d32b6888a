#include "daemon/simulation/pose/hand_attitude.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "common/base/units.h"
#include "common/virtual/devices/random.h"

namespace footing::arms {
namespace {

constexpr double kStepS = 0.01;

/// A device whose true orientation is known; its gyroscope has a bias.
struct Device {
  Eigen::Matrix3d R_WS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d bias = Eigen::Vector3d(0.01, -0.007, 0.005);
  noise::Random random{5};
  HandAttitude attitude;

  /// Turns at a rate in W and accelerates for so long.
  void Move(double seconds, const Eigen::Vector3d& w_W,
            const std::function<Eigen::Vector3d(double)>& a_W, double range_mps2 = 1e9,
            bool told = true) {
    for (int i = 0; i < std::lround(seconds / kStepS); ++i) {
      if (w_W.norm() > 0) {
        R_WS = Eigen::AngleAxisd(w_W.norm() * kStepS, w_W.normalized()) * R_WS;
      }
      HandReading reading;
      reading.angular_velocity_S_radps = R_WS.transpose() * w_W + bias;
      reading.specific_force_S_mps2 =
          R_WS.transpose() * (a_W(i * kStepS) + Eigen::Vector3d(0, 0, kStandardGravityMps2));
      for (double& value : reading.angular_velocity_S_radps) value += 0.006 * random.Normal();
      for (double& value : reading.specific_force_S_mps2) {
        value += 0.06 * random.Normal();
        if (std::abs(value) <= range_mps2) continue;
        value = std::copysign(range_mps2, value);
        reading.clipped = told;
      }
      attitude.Advance(reading, kStepS);
    }
  }
  void Rest(double seconds) {
    Move(seconds, Eigen::Vector3d::Zero(), [](double) { return Eigen::Vector3d::Zero().eval(); });
  }
  double ErrorDeg(const Eigen::Matrix3d& R_WT) const {
    const Eigen::Matrix3d wrong = attitude.state().turn_W.transpose() * (R_WS * R_WT.transpose());
    return RadiansToDegrees(std::acos(std::clamp((wrong.trace() - 1) / 2, -1.0, 1.0)));
  }
};

TEST(HandAttitude, IsInvalidUntilTheTPoseIsKnown) {
  Device device;
  EXPECT_FALSE(device.attitude.state().valid);
  device.attitude.Align();  // Of nothing.
  EXPECT_FALSE(device.attitude.state().valid);
  device.Rest(1);
  EXPECT_FALSE(device.attitude.state().valid);
  device.attitude.Align();
  EXPECT_TRUE(device.attitude.state().valid);
  EXPECT_EQ(device.attitude.state().turn_W, Eigen::Matrix3d::Identity());
}

TEST(HandAttitude, TellsTurnsInWHoweverTheDeviceLiesInTheFist) {
  for (const double tilt : {-0.5, 0.0, 0.4}) {
    Device device;
    const Eigen::Matrix3d rest =
        Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()).toRotationMatrix();
    device.R_WS = rest;
    device.Rest(5);
    device.attitude.Align();
    const auto still = [](double) { return Eigen::Vector3d::Zero().eval(); };
    device.Move(1, {0, 0, kPi / 2}, still);
    EXPECT_LT(device.ErrorDeg(rest), 0.5) << tilt;
    device.Move(1, {-kPi / 2, 0, 0}, still);
    EXPECT_LT(device.ErrorDeg(rest), 0.7) << tilt;
    EXPECT_NEAR(device.attitude.state().angular_velocity_W_radps.x(), -kPi / 2, 0.05);
    EXPECT_LT(device.attitude.state().acceleration_W_mps2.norm(), 0.4);
  }
}

TEST(HandAttitude, LearnsABiasThatChangesAfterTheTPose) {
  Device device;
  device.Rest(5);
  device.attitude.Align();
  const Eigen::Matrix3d rest = device.R_WS;
  device.bias += Eigen::Vector3d(0.01, 0, 0.01);  // A minute of it is 34 degrees about each axis.
  device.Rest(60);
  EXPECT_LT(device.ErrorDeg(rest), 2.5) << "what it turned before it knew that it rests";
  const double learned_deg = device.ErrorDeg(rest);
  device.Rest(60);
  EXPECT_LT(device.ErrorDeg(rest), learned_deg + 1);
}

TEST(HandAttitude, ShakingDoesNotTiltIt) {
  Device device;
  device.Rest(5);
  device.attitude.Align();
  const Eigen::Matrix3d rest = device.R_WS;
  device.Move(30, Eigen::Vector3d::Zero(), [](double t_s) {
    return Eigen::Vector3d(15 * std::sin(9 * t_s), 8 * std::cos(7 * t_s), 0);
  });
  EXPECT_LT(device.ErrorDeg(rest), 1.5);
}

TEST(HandAttitude, AClippedAccelerometerDoesNotTiltIt) {
  // Hard short pushes to one side, slow ones back: no mean push, but a clipped one has.
  const auto pushes = [](double t_s) {
    return Eigen::Vector3d(std::fmod(t_s, 0.5) < 0.1 ? 80 : -20, 0, 0);
  };
  double error_deg[2];
  for (const bool told : {false, true}) {
    Device device;
    device.Rest(5);
    device.attitude.Align();
    const Eigen::Matrix3d rest = device.R_WS;
    device.Move(15, Eigen::Vector3d::Zero(), pushes, 3.6 * kStandardGravityMps2, told);
    error_deg[told ? 1 : 0] = device.ErrorDeg(rest);
  }
  EXPECT_LT(error_deg[1], 1.5);
  EXPECT_GT(error_deg[0], 10);
}

TEST(HandAttitude, LeavesOutWhatIsNotFinite) {
  Device device;
  device.Rest(5);
  device.attitude.Align();
  const Eigen::Matrix3d rest = device.R_WS;
  HandReading reading;
  reading.specific_force_S_mps2.x() = std::numeric_limits<double>::quiet_NaN();
  device.attitude.Advance(reading, kStepS);
  reading = {};
  reading.angular_velocity_S_radps.y() = std::numeric_limits<double>::infinity();
  device.attitude.Advance(reading, kStepS);
  device.attitude.Advance({}, 0);
  device.Rest(1);
  EXPECT_LT(device.ErrorDeg(rest), 0.5);
}

}  // namespace
}  // namespace footing::arms
