#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "common/base/units.h"
#include "common/virtual/devices/noise.h"
#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::arms {
namespace {

using Eigen::Vector3d;

constexpr double kTickS = 0.01;
const Vector3d kUp(0, 0, kStandardGravityMps2);

/// A level device that rests, with this bias of its gyroscope.
void Rest(AttitudeFilter& filter, double seconds, const Vector3d& bias) {
  for (int i = 0; i < std::lround(seconds / kTickS); ++i)
    filter.Advance({.specific_force_S_mps2 = kUp, .angular_velocity_S_radps = bias}, kTickS);
}

double LeanDeg(const AttitudeFilter& filter) {
  return RadiansToDegrees(std::acos(std::clamp(filter.R_WS()(2, 2), -1.0, 1.0)));
}

TEST(AttitudeFilter, StartsLevelWithXForward) {
  AttitudeFilter filter;
  // Pitched nose down by 0.3 rad: up is forward and up in S.
  filter.Start(kStandardGravityMps2 * Vector3d(-std::sin(0.3), 0, std::cos(0.3)), Vector3d::Zero(),
               0);
  const Eigen::Matrix3d expected = Eigen::AngleAxisd(0.3, Vector3d::UnitY()).toRotationMatrix();
  EXPECT_LT((filter.R_WS() - expected).norm(), 1e-12);
}

TEST(AttitudeFilter, LearnsTheBiasOfAllAxesAtRest) {
  const Vector3d bias(0.01, -0.008, 0.006);
  AttitudeFilter filter;
  filter.Start(kUp, Vector3d::Zero(), DegreesToRadians(0.5));
  Rest(filter, 20, bias);
  EXPECT_LT((filter.bias_S_radps() - bias).norm(), 5e-4);
  AttitudeFilter without({.bias_in_rest = false, .bias_in_motion = false});
  without.Start(kUp, Vector3d::Zero(), DegreesToRadians(0.5));
  Rest(without, 20, bias);
  EXPECT_EQ(without.bias_S_radps(), Vector3d::Zero());
}

/// A MotionPlus that nobody calibrated is some 16 degrees/s off.
TEST(AttitudeFilter, KeepsALargeBiasThatItStartsWith) {
  const Vector3d bias(0.2, -0.1, 0.28);
  AttitudeFilter filter;
  filter.Start(kUp, bias, DegreesToRadians(0.1));
  Rest(filter, 20, bias + Vector3d(0, 0, 0.002));
  EXPECT_LT((filter.bias_S_radps() - bias).norm(), 0.003);
  const Eigen::Matrix3d R = filter.R_WS();
  EXPECT_LT(RadiansToDegrees(std::abs(std::atan2(R(1, 0), R(0, 0)))), 1);
}

TEST(AttitudeFilter, LearnsALevelBiasInMotionFromItsCorrections) {
  // Swung to and fro about the vertical, so it never rests; the bias is about x and y.
  const Vector3d bias(0.01, -0.008, 0);
  const auto swing = [&](AttitudeFilter& filter) {
    filter.Start(kUp, Vector3d::Zero(), DegreesToRadians(0.5));
    for (int i = 0; i < 6000; ++i) {
      const double rate = 0.5 * std::cos(2 * kPi * i * kTickS);
      filter.Advance(
          {.specific_force_S_mps2 = kUp, .angular_velocity_S_radps = Vector3d(0, 0, rate) + bias},
          kTickS);
    }
  };
  AttitudeFilter learns, without({.bias_in_motion = false});
  swing(learns);
  swing(without);
  EXPECT_LT((learns.bias_S_radps() - bias).norm(), 0.3 * bias.norm());
  EXPECT_LT(LeanDeg(learns), 0.5 * LeanDeg(without));
}

TEST(AttitudeFilter, LearnsAGainInMotionFromItsCorrections) {
  // Whole turns about a level axis: 2 % too much of them is a lean of 7 degrees a turn.
  const auto turn = [](AttitudeFilter& filter) {
    filter.Start(kUp, Vector3d::Zero(), DegreesToRadians(0.03));
    double sum = 0;
    for (int i = 0; i < 9000; ++i) {
      const double rate = 3 * std::sin(0.1 * kPi * i * kTickS);
      const double angle = 30 / kPi * (1 - std::cos(0.1 * kPi * (i + 0.5) * kTickS));
      const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix();
      filter.Advance({.specific_force_S_mps2 = R.transpose() * kUp,
                      .angular_velocity_S_radps = Vector3d(1.02 * rate, 0, 0)},
                     kTickS);
      const Vector3d up = filter.R_WS().transpose() * Vector3d::UnitZ();
      sum += std::acos(std::clamp(up.dot(R.transpose() * Vector3d::UnitZ()), -1.0, 1.0));
    }
    return sum / 9000;
  };
  AttitudeFilter learns, without({.gain_in_motion = false});
  const double lean = turn(learns);
  EXPECT_LT(lean, 0.7 * turn(without));
  EXPECT_NEAR(learns.gain_errors().x(), 0.02, 0.01);
  EXPECT_EQ(without.gain_errors(), Vector3d::Zero());
}

TEST(AttitudeFilter, TakesNoSlowTurnForABias) {
  // 4 degrees/s about the vertical is no bias of a gyroscope.
  AttitudeFilter filter;
  filter.Start(kUp, Vector3d::Zero(), DegreesToRadians(0.5));
  Rest(filter, 20, {0, 0, DegreesToRadians(4)});
  EXPECT_LT(filter.bias_S_radps().norm(), DegreesToRadians(0.1));
}

TEST(AttitudeFilter, StaysWhereItIsWhileClipped) {
  AttitudeFilter filter, unfrozen({.frozen_s = 0});
  for (AttitudeFilter* const one : {&filter, &unfrozen}) {
    one->Start(kUp, Vector3d::Zero(), 0);
    for (int i = 0; i < 100; ++i) {
      one->Advance({.specific_force_S_mps2 = kUp + Vector3d(35, 0, 0), .clipped = true}, kTickS);
    }
  }
  EXPECT_LT(LeanDeg(filter), 0.01);
  EXPECT_GT(LeanDeg(unfrozen), 5);
  EXPECT_GT(filter.inclination_sd_rad(), 0);
}

TEST(AttitudeFilter, ReportsAHeadingThatGetsLessCertain) {
  AttitudeFilter filter;
  filter.Start(kUp, Vector3d::Zero(), DegreesToRadians(0.1));
  double last = 0;
  for (int minute = 1; minute <= 3; ++minute) {
    for (int i = 0; i < 6000; ++i) {  // In motion: a bias about the vertical is not seen.
      const double rate = std::cos(2 * kPi * i * kTickS);
      filter.Advance({.specific_force_S_mps2 = kUp, .angular_velocity_S_radps = {0, 0, rate}},
                     kTickS);
    }
    EXPECT_GT(filter.heading_sd_rad(), last);
    last = filter.heading_sd_rad();
  }
  // 0.1 degrees/s for three minutes, and what a bias moves meanwhile.
  EXPECT_GT(last, DegreesToRadians(18));
  EXPECT_LT(last, DegreesToRadians(60));
  EXPECT_LT(filter.inclination_sd_rad(), DegreesToRadians(1));
}

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
  device.attitude.Align();  // Without any reading.
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

/// A segment that rests in the T-pose, then turns about W's axes: its device at any angle.
class SegmentDevice {
 public:
  SegmentDevice(const SquatTurn& turn, const Eigen::Matrix3d& R_JS) : attitude(turn), R_JS_(R_JS) {}

  void Rest(double seconds) { Turn(Vector3d::Zero(), seconds); }
  /// At this rate about axes of W.
  void Turn(const Vector3d& rate_W_radps, double seconds, bool squats = false) {
    for (int i = 0; i < std::lround(seconds / kTickS); ++i) {
      const Eigen::Matrix3d R_SW = (R_WJ * R_JS_).transpose();
      attitude.Advance({R_SW * kUp, R_SW * rate_W_radps + Vector3d(0.02, -0.01, 0.015)}, kTickS,
                       squats);
      R_WJ = Turned(kTickS * rate_W_radps) * R_WJ;
    }
  }
  /// Down, this deep, and up: its way ahead, or back, is so far to the left.
  void Squat(double about_left, double deep_rad, double to_left_rad) {
    constexpr double kDownS = 1.5;
    const Vector3d way =
        about_left * deep_rad / kDownS * Vector3d(-std::sin(to_left_rad), std::cos(to_left_rad), 0);
    Turn(way, kDownS, true);
    Rest(0.3);
    Turn(-way, kDownS, true);
  }
  double ErrorDeg() const {
    const Eigen::AngleAxisd off(attitude.state().turn_W * R_WJ.transpose());
    return RadiansToDegrees(off.angle());
  }

  SegmentAttitude attitude;
  Eigen::Matrix3d R_WJ = Eigen::Matrix3d::Identity();

 private:
  Eigen::Matrix3d R_JS_;
};

TEST(SegmentAttitude, TheFirstSquatShowsWhichWayADeviceAtAnyAngleFaces) {
  noise::Random random(5);
  for (int trial = 0; trial < 40; ++trial) {
    const Eigen::Matrix3d R_JS = Turned(noise::NormalVector(2, random));
    const SquatTurn turn{trial % 2 == 0 ? 1.0 : -1.0, trial % 3 * 0.2};
    SegmentDevice device(turn, R_JS);
    device.Rest(4);
    device.attitude.Align();
    device.Rest(1);
    EXPECT_FALSE(device.attitude.state().valid) << "which way it faces is not known yet";
    device.Squat(turn.about_left, 1, turn.to_left_rad);
    ASSERT_TRUE(device.attitude.state().valid) << trial;
    device.Turn({0, 0, 0.5}, 1.2);
    device.Turn({0.6, 0, 0}, 1);
    EXPECT_LT(device.ErrorDeg(), 2.5) << trial;
    EXPECT_GT(device.attitude.state().heading_sd_rad, 0.12);
  }
}

TEST(SegmentAttitude, WhatAHandHoldsNeedsNoSquat) {
  const SquatTurn in_fist{0, 0, 0.1};
  SegmentDevice device(in_fist, Turned({0.3, 0, 0}));
  device.Rest(4);
  device.attitude.Align();
  device.Turn({0, 0, 0.5}, 1.2);
  device.Turn({0.6, 0, 0}, 1);
  ASSERT_TRUE(device.attitude.state().valid);
  EXPECT_LT(device.ErrorDeg(), 2.5);
  EXPECT_GT(device.attitude.state().heading_sd_rad, 0.1) << "as far as a grip is off";
}

TEST(SegmentAttitude, StatesHowWellASquatShowedItsHeading) {
  const SquatTurn turn{-1, 0.14, 0.16};
  for (const double deep_rad : {0.25, 0.5, 1.2}) {
    double nees = 0;
    constexpr int kTrials = 20;
    for (int seed = 1; seed <= kTrials; ++seed) {
      noise::Random random(seed);
      const Eigen::Matrix3d R_JS = Turned(noise::NormalVector(2, random));
      SegmentDevice device(turn, R_JS);
      device.Rest(4);
      device.attitude.Align();
      // Who squats differs from the mean, and leans to a side.
      const double way_rad = turn.to_left_rad + turn.sd_rad * random.Normal() +
                             std::atan2(0.05 * random.Normal(), deep_rad);
      device.Squat(turn.about_left, deep_rad, way_rad);
      ASSERT_TRUE(device.attitude.state().valid) << deep_rad;
      const Vector3d ahead_W = R_JS.col(0);  // The device's x in the T-pose.
      const double off_rad = std::remainder(
          device.attitude.heading_rad() - std::atan2(ahead_W.y(), ahead_W.x()), 2 * kPi);
      nees += std::pow(off_rad / device.attitude.mounting_sd_rad(), 2) / kTrials;
    }
    EXPECT_GT(nees, 0.4) << deep_rad;
    EXPECT_LT(nees, 1.7) << deep_rad;
  }
}

TEST(SegmentAttitude, ADeeperSquatShowsItMoreSurely) {
  SegmentDevice device({}, Eigen::Matrix3d::Identity());
  device.Rest(4);
  device.attitude.Align();
  device.Squat(1, 0.25, 0);
  ASSERT_TRUE(device.attitude.state().valid);
  const double shallow_rad = device.attitude.mounting_sd_rad();
  EXPECT_GT(shallow_rad, 0.3);
  device.Squat(1, 0.9, 0);
  EXPECT_LT(device.attitude.mounting_sd_rad(), 0.6 * shallow_rad);
  device.Squat(1, 0.9, 0);
  EXPECT_GT(device.attitude.mounting_sd_rad(), SquatTurn{}.sd_rad) << "people differ";
}

TEST(SegmentAttitude, OnlyASquatShowsAHeading) {
  SegmentDevice device({}, Eigen::Matrix3d::Identity());
  device.Rest(4);
  device.attitude.Align();
  for (int i = 0; i < 10; ++i) {
    device.Turn({0, 0, 1}, 1);
    device.Turn({0.6, 0, 0}, 1);  // To a side, and back.
    device.Turn({-0.6, 0, 0}, 1);
    device.Turn({0.1, 0, 0}, 1, true);  // A bend that shows nothing.
    device.Turn({-0.1, 0, 0}, 1, true);
  }
  EXPECT_FALSE(device.attitude.state().valid);
}

TEST(SegmentAttitude, BendsThatContradictEachOtherShowNone) {
  SegmentDevice device({}, Eigen::Matrix3d::Identity());
  device.Rest(4);
  device.attitude.Align();
  device.Squat(1, 0.5, 0);
  ASSERT_TRUE(device.attitude.state().valid);
  device.Squat(1, 0.5, 2);
  EXPECT_FALSE(device.attitude.state().valid);
}

TEST(SegmentAttitude, ADeviceThatPointsUpIsAlignedToo) {
  Eigen::Matrix3d R_JS;  // Its x is up.
  R_JS << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  SegmentDevice device({}, R_JS);
  device.Rest(4);
  device.attitude.Align();
  device.Squat(1, 1.2, 0);
  ASSERT_TRUE(device.attitude.state().valid);
  EXPECT_LT(device.ErrorDeg(), 2);
}

TEST(IsSquat, NeedsBothFeetAndALowerCentreOfMass) {
  EXPECT_TRUE(IsSquat(0.8, 1, 300, 300));
  EXPECT_FALSE(IsSquat(0.97, 1, 300, 300)) << "stands";
  EXPECT_FALSE(IsSquat(0.8, 1, 600, 20)) << "on one leg";
  EXPECT_FALSE(IsSquat(0.8, 1, 0, 0)) << "in the air";
}

}  // namespace
}  // namespace footing::arms
