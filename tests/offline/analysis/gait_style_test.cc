#include "daemon/offline/analysis/gait_style.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

namespace footing::style {
namespace {

constexpr double kStepS = 0.001, kSpeedMps = 1.2, kStepTimeS = 0.5;
constexpr double kBobM = 0.04, kRollRad = 0.07, kYawRad = 0.05, kNodRad = 0.02, kLeanRad = 0.01;
constexpr double kTurnRadps = 0.5, kTorqueNm = 2, kFootRadiusM = 0.02, kSlideM = 0.003;
/// The right foot's steps last longer by this.
constexpr double kLimpS = 0.05;

/// A made walk, `time_s` after a touchdown of the left foot, whose pelvis swings in known phases:
/// a leg rolls on its foot, and slides by kSlideM over its stance.
engine::EngineOutput MadeWalk(double time_s, double limp_s) {
  const double stride_s = 2 * kStepTimeS + limp_s;
  const double strides = std::floor(time_s / stride_s);
  const double in_stride_s = time_s - strides * stride_s;
  const bool left = in_stride_s < kStepTimeS;
  const double step_s = left ? kStepTimeS : kStepTimeS + limp_s;
  const double phase = (left ? in_stride_s : in_stride_s - kStepTimeS) / step_s;
  const double side = left ? 1 : -1;

  engine::EngineOutput output;
  output.time_s = time_s;
  output.gait.gait = stream::Gait::kWalk;
  output.gait.steps = static_cast<std::uint64_t>(2 * strides) + (left ? 1 : 2);
  output.p_WC_m = {kSpeedMps * time_s, 0, 0.85 - kBobM / 2 * std::cos(2 * kPi * phase)};
  output.v_WC_mps = {kSpeedMps, 0, 0};
  const double pitch = kLeanRad + kNodRad * std::cos(2 * kPi * phase);
  const double roll = side * kRollRad * std::sin(kPi * phase);
  const double yaw = -side * kYawRad * std::cos(kPi * phase);
  output.links[0].orientation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY());
  for (std::size_t leg = 0; leg < 2; ++leg) {
    const bool carries = (leg == 0) == left;
    const double since_s = carries ? phase * step_s : phase * step_s + step_s;
    // To and fro, so that the angle stays small.
    const double turn_rad = kTurnRadps * std::fabs(std::fmod(time_s, 2.0) - 1);
    output.links[2 + 2 * leg].orientation =
        output.links[0].orientation * Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY());
    output.contacts[leg].touching = carries || phase < 0.2;
    const double stance_m = 0.1 + kSlideM * since_s / (1.2 * kStepTimeS);
    output.contacts[leg].position_m = {kSpeedMps * (time_s - since_s), leg == 0 ? 0.1 : -0.1,
                                       carries ? -0.001 : 0};
    output.contacts[leg].position_m.x() += stance_m;
    output.links[1 + 2 * leg].position_m =
        output.contacts[leg].position_m + Eigen::Vector3d(0, 0, 0.9);
    output.joint_efforts[4 * leg + 2] = kTorqueNm;
  }
  return output;
}

GaitStyle Measured(double limp_s = 0) {
  StyleMeter meter(kStepS);
  for (int i = 0; i < 10000; ++i) meter.Add(MadeWalk(i * kStepS, limp_s));
  return meter.Report();
}

TEST(GaitStyle, MeasuresTheSwingsOfAMadeWalkAndTheirPhases) {
  const GaitStyle style = Measured();
  EXPECT_GT(style.steps, 15);
  EXPECT_NEAR(style.speed_mps, kSpeedMps, 1e-3);
  EXPECT_NEAR(style.cadence_hz, 1 / kStepTimeS, 1e-3);
  EXPECT_NEAR(style.step_length_m, kSpeedMps * kStepTimeS, 1e-3);
  EXPECT_NEAR(style.step_width_m, 0.2, 1e-6);
  EXPECT_NEAR(style.bob_m, kBobM, 1e-4);
  EXPECT_NEAR(style.bob_low_phase, 0, 0.01);
  EXPECT_NEAR(style.lean_rad, kLeanRad, 2e-3);
  EXPECT_NEAR(style.pitch.amplitude_rad, kNodRad, 1e-3);
  EXPECT_NEAR(style.pitch.peak_phase, 0, 0.02);
  EXPECT_NEAR(style.roll.amplitude_rad, kRollRad, 1e-3);
  EXPECT_NEAR(style.roll.peak_phase, 0.5, 0.02);
  EXPECT_NEAR(style.yaw.amplitude_rad, kYawRad, 1e-3);
  EXPECT_NEAR(style.yaw.peak_phase, 0, 0.02);
  EXPECT_NEAR(style.double_support_share, 0.2, 0.01);
  EXPECT_EQ(style.flight_share, 0);
  EXPECT_NEAR(style.penetration_m, 0.001, 1e-9);
  EXPECT_NEAR(style.jerk_rms_mps3, 0, 1e-6);
  EXPECT_NEAR(style.asymmetry, 0, 1e-3);
  // Both hips' power over the speed.
  EXPECT_NEAR(style.work_n, 2 * kTorqueNm * kTurnRadps / kSpeedMps, 1e-2);
}

TEST(GaitStyle, SeesALimp) {
  // Steps of 0.5 and 0.55 s: they differ by 0.05 / 0.525.
  EXPECT_NEAR(Measured(kLimpS).asymmetry, kLimpS / (kStepTimeS + kLimpS / 2), 5e-3);
}

TEST(GaitStyle, AFootThatRollsDoesNotSlide) {
  StyleMeter rolls(kStepS), slides(kStepS);
  for (int i = 0; i < 2000; ++i) {
    const double time_s = i * kStepS, turn_rad = kTurnRadps * time_s;
    engine::EngineOutput output;
    output.gait.steps = static_cast<std::uint64_t>(i / 500);
    output.p_WC_m.x() = time_s;
    output.contacts[0].touching = i % 500 < 400;
    output.links[2].orientation = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY());
    output.contacts[0].position_m = {kFootRadiusM * turn_rad, 0, 0};
    rolls.Add(output);
    output.contacts[0].position_m.x() += kSlideM * std::fmod(time_s, 0.5) / 0.4;
    slides.Add(output);
  }
  EXPECT_NEAR(rolls.Report().slide_max_m, 0, 1e-5);
  EXPECT_NEAR(slides.Report().slide_max_m, kSlideM, 1e-4);
}

TEST(PublishedCurves, AreAlexandersAndOrendurffs) {
  // u = 0.25 g^0.5 stride^1.67 h^-1.17 at the cadence's own stride.
  for (const double speed_mps : {0.5, 1.2, 3.0, 6.0}) {
    const double stride_m = 2 * speed_mps / AlexanderCadence(speed_mps, 0.9);
    EXPECT_NEAR(
        0.25 * std::sqrt(kStandardGravityMps2) * std::pow(stride_m, 1.67) * std::pow(0.9, -1.17),
        speed_mps, 1e-9);
  }
  EXPECT_DOUBLE_EQ(OrendurffBob(0.7), 0.0274);
  EXPECT_DOUBLE_EQ(OrendurffBob(1.6), 0.0483);
}

TEST(PublishedCurves, AreSaundersPelvisInAFreeWalkAndSmallerInASlowOne) {
  const PelvisReference free = SaundersPelvis(1.2), slow = SaundersPelvis(0.5);
  EXPECT_NEAR(RadiansToDegrees(free.roll.amplitude_rad), 5, 1e-9);
  EXPECT_NEAR(RadiansToDegrees(free.yaw.amplitude_rad), 4, 1e-9);
  const double step_share = (0.5 / AlexanderCadence(0.5, 1)) / (1.2 / AlexanderCadence(1.2, 1));
  EXPECT_NEAR(slow.yaw.amplitude_rad, step_share * free.yaw.amplitude_rad, 1e-12);
  EXPECT_EQ(SaundersPelvis(0).roll.amplitude_rad, 0);
}

TEST(PublishedCurves, AreAsFarAwayAsAmplitudeAndPhaseSay) {
  EXPECT_NEAR(Distance(3, 0.2, 3, 0.2, 0.5), 0, 1e-12);
  EXPECT_NEAR(Distance(5, 0.2, 3, 0.2, 0.5), 2, 1e-12);
  EXPECT_NEAR(Distance(3, 0.2, 3, 1.2, 0.5), 6, 1e-12);  // The other side's step.
  EXPECT_NEAR(Distance(3, 0, 4, 0.25, 1), 5, 1e-12);
  EXPECT_NEAR(Distance(0, 0.7, 4, 0, 1), 4, 1e-12);
}

}  // namespace
}  // namespace footing::style
