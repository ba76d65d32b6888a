#include "daemon/simulation/pose/inertial_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "common/base/rotation.h"
#include "common/base/units.h"
#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::inertial {
namespace {

// Where each error begins.
constexpr int kPlace = 0, kVelocity = 3, kTilt = 6, kHeading = 8, kTurnBias = 10, kForceBias = 13;

// Errors of a device such as a PS Move or a Wiimote with MotionPlus: docs/hands.md has them.
constexpr double kForceNoise = 4e-5;       // m^2/s^3: 0.06 m/s^2, 100 readings a second.
constexpr double kTurnNoise = 4e-7;        // rad^2/s: 0.006 rad/s.
constexpr double kGainError = 0.01;        // Every axis of both sensors.
constexpr double kForceBiasSdMps2 = 0.15;  // Bias, and the gain's share of gravity.
constexpr double kTurnBiasSdRadps = 0.02;  // 1 degree/s: nobody has held it still.
constexpr double kTurnBiasWalk = 1e-7;     // rad^2/s^3: 0.0003 rad/s after a second.
constexpr double kHeadingWalk = 1e-5;      // 1/s: gains take cosine and sine off the unit circle.
// The errors of gains as white noise: a hand turns back, so that most of them cancel. This and the
// next two are chosen by NEES on CMU 13.
constexpr double kGainLastsS = 0.02;
constexpr double kBiasChangesPerRad = 0.1;  // Gain's share of gravity, whose axes turn.
constexpr double kLeansS = 0.1;             // Gravity in an unknown direction, alike.
// Changes not felt yet: acceleration and turn change by as much as they are within 0.1 s, and those
// of a hand at rest by these. Beyond the range of the accelerometer, 5 m/s^2 for 0.03 s.
constexpr double kForceSdMps2 = 1, kTurnSdRadps = 0.5, kChangesInS = 0.1;
constexpr double kClippedForce = 2 * 5 * 5 * 0.03;  // m^2/s^3.
constexpr double kSpeedSdMps = 1;                   // Speed of a hand seen once.
constexpr double kTimeSdS = 0.001;                  // Exposure time against the readings.
constexpr double kPlaceSdM = 0.00002;  // Floor for any observation: that of a near sphere.
constexpr double kArmSdShare = 0.02;   // Arm to the point: its length and direction.
constexpr double kFastestMps = 20, kLargestHeading = 1.5;  // Beyond them it has lost its way.
constexpr double kKnownHeadingSdRad = 0.2, kKnownHeadingOff = 0.2;

double Square(double x) { return x * x; }

/// The error of a value that is held, whose deviation otherwise is `sd`, grows from 0 like a random
/// walk: its variance in a second.
double Held(double sd) { return Square(sd) * 2 / kChangesInS; }

}  // namespace

Eigen::Matrix3d Filter::HeadingMatrix() const {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix.topLeftCorner<2, 2>() << heading_.x(), -heading_.y(), heading_.y(), heading_.x();
  return matrix;
}

double Filter::heading_sd_rad() const {
  // Across the vector of cosine and sine.
  const double length = heading_.norm();
  if (length < 1e-6) return kPi;
  const Eigen::Vector2d across(-heading_.y() / length, heading_.x() / length);
  const Eigen::Matrix2d variance = covariance_.block<2, 2>(kHeading, kHeading);
  return std::min(kPi, std::sqrt(std::max(0.0, across.dot(variance * across))) / length);
}

Eigen::Vector3d Filter::InWorld(const Eigen::Vector3d& v_G, Rows& by_errors) const {
  const Eigen::Matrix3d C = HeadingMatrix();
  by_errors.middleCols<2>(kTilt) = -(C * CrossMatrix(v_G)).leftCols<2>();
  by_errors.block<2, 2>(0, kHeading) << v_G.x(), -v_G.y(), v_G.y(), v_G.x();
  return C * v_G;
}

Filter::Rows Filter::Sensitivity(Eigen::Vector3d& p_WP_m) const {
  Rows H = Rows::Zero();
  H.leftCols<3>().setIdentity();
  p_WP_m = p_W_m_ + InWorld(R_GS_ * p_SP_m_, H);
  return H;
}

void Filter::Start(const Observation& seen, const Eigen::Matrix3d& R_GS, double tilt_sd_rad) {
  *this = Filter(p_SP_m_);
  R_GS_ = R_GS;
  covariance_.setZero();
  covariance_.diagonal().segment<2>(kTilt).setConstant(Square(tilt_sd_rad));
  covariance_.diagonal().segment<2>(kHeading).setConstant(0.5);
  covariance_.diagonal().segment<3>(kTurnBias).setConstant(Square(kTurnBiasSdRadps));
  covariance_.diagonal().segment<3>(kForceBias).setConstant(Square(kForceBiasSdMps2));
  covariance_.block<3, 3>(kVelocity, kVelocity).diagonal().setConstant(Square(kSpeedSdMps));
  // The device is where its point was seen, less the arm between them, with the arm's errors.
  Rows by_errors = Rows::Zero();
  p_W_m_ = seen.p_W_m - InWorld(R_GS_ * p_SP_m_, by_errors);
  const Eigen::Matrix<double, kErrors, 3> cross = -covariance_ * by_errors.transpose();
  covariance_.topLeftCorner<3, 3>() = seen.covariance_m2 - by_errors * cross;
  covariance_.block<kErrors - 3, 3>(3, 0) = cross.bottomRows<kErrors - 3>();
  covariance_.block<3, kErrors - 3>(0, 3) = cross.bottomRows<kErrors - 3>().transpose();
}

void Filter::Advance(const arms::HandReading& from, const arms::HandReading& to, double step_s,
                     Trust trust) {
  const Eigen::Vector3d turn_S =
      0.5 * (from.angular_velocity_S_radps + to.angular_velocity_S_radps) - turn_bias_S_radps_;
  const Eigen::Matrix3d before = R_GS_;
  R_GS_ =
      Eigen::Quaterniond(before * arms::Turned(turn_S * step_s)).normalized().toRotationMatrix();
  const Eigen::Vector3d force_G =
      0.5 * (before * (from.specific_force_S_mps2 - force_bias_S_mps2_) +
             R_GS_ * (to.specific_force_S_mps2 - force_bias_S_mps2_));
  Rows by_errors = Rows::Zero();  // Derivatives of a_W by the errors.
  const Eigen::Vector3d a_W =
      InWorld(force_G, by_errors) - Eigen::Vector3d(0, 0, kStandardGravityMps2);
  by_errors.middleCols<3>(kForceBias) = -HeadingMatrix() * R_GS_;
  Covariance F = Covariance::Identity();
  F.block<3, 3>(kPlace, kVelocity).diagonal().setConstant(step_s);
  F.topRows<3>() += 0.5 * step_s * step_s * by_errors;
  F.middleRows<3>(kVelocity) += step_s * by_errors;
  F.block<2, 3>(kTilt, kTurnBias) = -step_s * R_GS_.topRows<2>();
  F.block<2, 3>(kHeading, kTurnBias) =
      -step_s * Eigen::Vector2d(-heading_.y(), heading_.x()) * R_GS_.row(2);
  covariance_ = (F * covariance_ * F.transpose()).eval();

  p_W_m_ += step_s * v_W_mps_ + 0.5 * step_s * step_s * a_W;
  v_W_mps_ += step_s * a_W;
  AddNoise(to, force_G, step_s, trust);
}

void Filter::AddNoise(const arms::HandReading& reading, const Eigen::Vector3d& force_G,
                      double step_s, Trust trust) {
  const double turn_radps = (reading.angular_velocity_S_radps - turn_bias_S_radps_).norm();
  const double motion_mps2 = (force_G - Eigen::Vector3d(0, 0, kStandardGravityMps2)).norm();
  // A tilt and a heading that are both unknown leave gravity in an unknown direction.
  const double tilt_variance = covariance_.diagonal().segment<2>(kTilt).sum();
  const double heading_variance = covariance_.diagonal().segment<2>(kHeading).sum();
  double force =
      kForceNoise + 2 * kGainLastsS * Square(kGainError * motion_mps2) +
      2 * kLeansS * Square(kStandardGravityMps2) * tilt_variance * std::min(1.0, heading_variance);
  double turn = kTurnNoise + 2 * kGainLastsS * Square(kGainError * turn_radps);
  if (trust == Trust::kClipped) force += kClippedForce;
  const double t = step_s;
  double place = force * t * t * t / 3, both = force * t * t / 2, velocity = force * t;
  if (trust == Trust::kHeld) {
    const double walk = Held(std::hypot(kForceSdMps2, motion_mps2));
    place += walk * t * t * t * t * t / 20;
    both += walk * t * t * t * t / 8;
    velocity += walk * t * t * t / 3;
    turn += Held(std::hypot(kTurnSdRadps, turn_radps)) * t * t / 3;
  }
  auto noise = covariance_.diagonal();
  noise.segment<3>(kPlace).array() += place;
  noise.segment<3>(kVelocity).array() += velocity;
  for (int axis = 0; axis < 3; ++axis) {
    covariance_(kPlace + axis, kVelocity + axis) += both;
    covariance_(kVelocity + axis, kPlace + axis) += both;
  }
  noise.segment<2>(kTilt).array() += turn * step_s;
  const Eigen::Vector2d across(-heading_.y(), heading_.x());
  covariance_.block<2, 2>(kHeading, kHeading) += turn * step_s * across * across.transpose();
  noise.segment<2>(kHeading).array() += kHeadingWalk * step_s;
  noise.segment<3>(kTurnBias).array() += kTurnBiasWalk * step_s;
  // The gain's share of gravity is another one for every attitude.
  noise.segment<3>(kForceBias).array() +=
      2 * kBiasChangesPerRad * Square(kGainError * kStandardGravityMps2) * turn_radps * step_s;
}

Eigen::Matrix3d Filter::Uncertainty(const Observation& seen) const {
  const double variance_m2 = Square(kPlaceSdM) + Square(kArmSdShare) * p_SP_m_.squaredNorm();
  return seen.covariance_m2 + variance_m2 * Eigen::Matrix3d::Identity() +
         Square(kTimeSdS) * v_W_mps_ * v_W_mps_.transpose();
}

bool Filter::IsPlausible() const {
  return covariance_.allFinite() && v_W_mps_.norm() < kFastestMps &&
         heading_.norm() < kLargestHeading;
}

bool Filter::KnowsHeading() const {
  return heading_sd_rad() < kKnownHeadingSdRad && std::abs(heading_.norm() - 1) < kKnownHeadingOff;
}

double Filter::Distance(const Observation& seen) const {
  Eigen::Vector3d p_WP_m;
  const Rows H = Sensitivity(p_WP_m);
  const Eigen::Matrix3d S = H * covariance_ * H.transpose() + Uncertainty(seen);
  const Eigen::Vector3d off_m = seen.p_W_m - p_WP_m;
  return off_m.dot(S.ldlt().solve(off_m));
}

void Filter::Update(const Observation& seen) {
  Eigen::Vector3d p_WP_m;
  const Rows H = Sensitivity(p_WP_m);
  const Eigen::Matrix3d R = Uncertainty(seen);
  const Eigen::Matrix3d S = H * covariance_ * H.transpose() + R;
  const Eigen::Matrix<double, kErrors, 3> K = S.ldlt().solve(H * covariance_).transpose();
  const Eigen::Matrix<double, kErrors, 1> errors = K * (seen.p_W_m - p_WP_m);
  const Covariance kept = Covariance::Identity() - K * H;
  covariance_ = (kept * covariance_ * kept.transpose() + K * R * K.transpose()).eval();
  p_W_m_ += errors.segment<3>(kPlace);
  v_W_mps_ += errors.segment<3>(kVelocity);
  R_GS_ = arms::Turned({errors(kTilt), errors(kTilt + 1), 0}) * R_GS_;
  heading_ += errors.segment<2>(kHeading);
  turn_bias_S_radps_ += errors.segment<3>(kTurnBias);
  force_bias_S_mps2_ += errors.segment<3>(kForceBias);
}

}  // namespace footing::inertial
