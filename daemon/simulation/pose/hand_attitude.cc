#include "daemon/simulation/pose/hand_attitude.h"

#include <algorithm>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "common/base/rotation.h"
#include "common/base/units.h"

namespace footing::arms {
namespace {

constexpr double kLeastForceMps2 = 1;

// VQF, table 2, in rad and s.
constexpr double kBiasSdInMotion = DegreesToRadians(0.1);
constexpr double kBiasSdInRest = DegreesToRadians(0.03);
constexpr double kBiasForgottenS = 100;  // A bias known exactly is off by 0.1 degrees/s after it.
constexpr double kBiasForgottenSd = DegreesToRadians(0.1);
constexpr double kLargestBias = DegreesToRadians(2);
constexpr double kVerticalFactor = 1e-4;
constexpr double kRestFilterS = 0.5;
constexpr double kRestTurn = DegreesToRadians(2);
constexpr double kRestForceMps2 = 0.5;

// Sources of the reported deviations: a consumer gyroscope's noise, 0.02 degrees/s/sqrt(Hz), and
// gain error, 1 %; what is left of a bias that is not watched; the inclination of a filter that
// runs freely.
constexpr double kNoiseRadPerSqrtS = DegreesToRadians(0.02);
constexpr double kGainError = 0.01;
constexpr double kLargestGain = 0.05;
constexpr double kInclinationSd = DegreesToRadians(0.6);

/// The nearest rotation, after small errors of rounding.
Eigen::Matrix3d Rotation(const Eigen::Matrix3d& R) {
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

/// Level heading: W's x is S's x without its upright part.
Eigen::Matrix3d LevelStart(const Eigen::Vector3d& up_S) {
  Eigen::Vector3d ahead_S = Eigen::Vector3d::UnitX() - up_S.x() * up_S;
  if (ahead_S.norm() < 1e-3) ahead_S = Eigen::Vector3d::UnitY() - up_S.y() * up_S;
  Eigen::Matrix3d R_SW;
  R_SW.col(0) = ahead_S.normalized();
  R_SW.col(1) = up_S.cross(R_SW.col(0));
  R_SW.col(2) = up_S;
  return R_SW.transpose();
}

double Square(double x) { return x * x; }

}  // namespace

void AttitudeFilter::Start(const Eigen::Vector3d& force_S_mps2, const Eigen::Vector3d& bias_S_radps,
                           double bias_sd_radps) {
  *this = AttitudeFilter(options_);
  R_WG_ = LevelStart(force_S_mps2.normalized());
  start_bias_S_ = bias_S_radps;
  variance_.diagonal().head<3>().setConstant(Square(bias_sd_radps));
  variance_.diagonal().tail<3>().setConstant(options_.gain_in_motion ? Square(kGainError) : 0);
  force_G_.Start(force_S_mps2);
  turned_error_.Start(Eigen::Vector3d::Zero());
  Jacobian turned = Jacobian::Zero();
  turned.leftCols<3>() = R_WG_;
  turned_.Start(turned);
  rest_force_S_.Start(force_S_mps2);
  rest_turn_S_.Start(Eigen::Vector3d::Zero());
}

void AttitudeFilter::Advance(const HandReading& measured, double step_s) {
  if (!measured.specific_force_S_mps2.allFinite() ||
      !measured.angular_velocity_S_radps.allFinite() || !(step_s > 0)) {
    return;
  }
  HandReading reading = measured;
  reading.angular_velocity_S_radps -= start_bias_S_;
  const bool rests = Rests(reading, step_s);
  const Eigen::Vector3d& turn_S = reading.angular_velocity_S_radps;
  Integrate(Corrected(turn_S), step_s);
  const Eigen::Matrix3d before = R_WG_;
  Correct(reading, step_s);
  // The lean of the mean force before it was corrected, as a turn about W's level axes.
  const Eigen::Vector3d up_W = (before * force_G_.value()).normalized();
  FollowErrors(turn_S, Eigen::Vector3d(-up_W.y(), up_W.x(), 0), rests, step_s);
  Spread(reading, step_s);
}

bool AttitudeFilter::Rests(const HandReading& reading, double step_s) {
  const Eigen::Vector3d& force = reading.specific_force_S_mps2;
  const Eigen::Vector3d& turn = reading.angular_velocity_S_radps;
  const Eigen::Vector3d mean_force = rest_force_S_.Advance(force, kRestFilterS, step_s);
  const Eigen::Vector3d mean_turn = rest_turn_S_.Advance(turn, kRestFilterS, step_s);
  const bool still = (force - mean_force).norm() < kRestForceMps2 &&
                     (turn - mean_turn).norm() < kRestTurn &&
                     mean_turn.cwiseAbs().maxCoeff() < kLargestBias;
  rest_s_ = still ? rest_s_ + step_s : 0;
  return rest_s_ >= kRestS;
}

void AttitudeFilter::Integrate(const Eigen::Vector3d& turn_S, double step_s) {
  R_GS_ = Rotation(R_GS_ * Turned(turn_S * step_s));
}

void AttitudeFilter::Correct(const HandReading& reading, double step_s) {
  if (reading.clipped && options_.frozen_s > 0) {
    held_s_ = options_.frozen_s;
    force_G_.Start(R_WG_.transpose() * Eigen::Vector3d(0, 0, kStandardGravityMps2));
  }
  if (!reading.clipped || options_.frozen_s <= 0)
    force_G_.Advance(R_GS_ * reading.specific_force_S_mps2, options_.gravity_s, step_s);
  if (held_s_ > 0) {
    held_s_ -= step_s;
    return;
  }
  const Eigen::Vector3d up_W = R_WG_ * force_G_.value();
  if (up_W.norm() < kLeastForceMps2) return;
  R_WG_ = Rotation(LeastTurn(up_W, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R_WG_);
}

/// The Kalman filter of VQF's appendix: rows are the bias at rest or, in motion, what the
/// corrections about the level axes say of the turn that bias and gains have made in W.
void AttitudeFilter::FollowErrors(const Eigen::Vector3d& turn_S, const Eigen::Vector3d& lean_W,
                                  bool rests, double step_s) {
  const Eigen::Matrix3d R = R_WS();
  Jacobian turned;
  turned << R, R * turn_S.asDiagonal();
  const Eigen::Vector3d mean_error =
      turned_error_.Advance(turned * errors_, options_.gravity_s, step_s);
  const Jacobian mean_turned = turned_.Advance(turned, options_.gravity_s, step_s);
  const double forget = Square(kBiasForgottenSd) * step_s / kBiasForgottenS;
  variance_.diagonal().head<3>().array() += forget;
  Jacobian H = Jacobian::Zero();
  Eigen::Vector3d error, weight;
  const auto noise_for = [forget](double sd) { return Square(Square(sd)) / forget + Square(sd); };
  if (rests && options_.bias_in_rest) {
    H.leftCols<3>().setIdentity();
    error = rest_turn_S_.value() - errors_.head<3>();
    weight.setConstant(noise_for(kBiasSdInRest));
  } else if (options_.bias_in_motion && held_s_ <= 0) {
    H = mean_turned;
    H.row(2).tail<3>().setZero();
    error = lean_W / step_s + mean_error - H * errors_;
    error.z() = -H.row(2).dot(errors_);
    weight.setConstant(noise_for(kBiasSdInMotion));
    weight.z() /= kVerticalFactor;
  } else {
    return;
  }
  error = error.cwiseMax(-kLargestBias).cwiseMin(kLargestBias);
  Eigen::Matrix3d S = H * variance_ * H.transpose();
  S += weight.asDiagonal();
  const Eigen::Matrix<double, 6, 3> K = variance_ * H.transpose() * S.inverse();
  errors_ += K * error;
  errors_.head<3>() = errors_.head<3>().cwiseMax(-kLargestBias).cwiseMin(kLargestBias);
  errors_.tail<3>() = errors_.tail<3>().cwiseMax(-kLargestGain).cwiseMin(kLargestGain);
  variance_ -= (K * H * variance_).eval();
}

void AttitudeFilter::Spread(const HandReading& reading, double step_s) {
  const Eigen::Matrix3d R = R_WS();
  const Eigen::Matrix3d variance_W = R * variance_.topLeftCorner<3, 3>() * R.transpose();
  heading_drift_rad_ += std::sqrt(std::max(0.0, variance_W(2, 2))) * step_s;
  heading_noise_rad2_ += Square(kNoiseRadPerSqrtS) * step_s;
  heading_turned_rad_ += R.row(2).dot(Corrected(reading.angular_velocity_S_radps)) * step_s;
  if (held_s_ > 0) {
    frozen_drift_rad_ += std::sqrt(std::max(0.0, variance_W(0, 0) + variance_W(1, 1))) * step_s;
  } else {
    frozen_drift_rad_ *= std::exp(-step_s / options_.gravity_s);
  }
}

double AttitudeFilter::heading_sd_rad() const {
  return std::sqrt(Square(heading_drift_rad_) + heading_noise_rad2_ +
                   Square(kGainError * heading_turned_rad_));
}

double AttitudeFilter::inclination_sd_rad() const {
  return std::hypot(kInclinationSd, frozen_drift_rad_);
}

namespace {

constexpr double kMeanS = 4;                            // Longest mean over the T-pose.
constexpr double kLeastRestS = 1;                       // Less of it shows nothing.
constexpr double kTPoseForceMps2 = 1;                   // Less of it shows no upright.
constexpr double kTPoseBiasSd = DegreesToRadians(0.1);  // Nobody holds the arms quite still.

}  // namespace

HandAttitude::HandAttitude(double heading_rad)
    : R_WF_(Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix()) {}

void HandAttitude::Advance(const HandReading& reading, double step_s) {
  if (!reading.specific_force_S_mps2.allFinite() || !reading.angular_velocity_S_radps.allFinite() ||
      !(step_s > 0)) {
    return;
  }
  if (!state_.valid) {
    rested_s_ = std::min(rested_s_ + step_s, kMeanS);
    const double share = std::min(1.0, step_s / rested_s_);
    mean_force_S_ += share * (reading.specific_force_S_mps2 - mean_force_S_);
    bias_S_ += share * (reading.angular_velocity_S_radps - bias_S_);
    return;
  }
  filter_.Advance(reading, step_s);
  const Eigen::Matrix3d R_WS = R_WF_ * filter_.R_WS();
  state_.turn_W = R_WS * R_ST_;
  state_.acceleration_W_mps2 = R_WS * reading.specific_force_S_mps2;
  state_.acceleration_W_mps2.z() -= kStandardGravityMps2;
  state_.angular_velocity_W_radps =
      R_WS * (reading.angular_velocity_S_radps - filter_.bias_S_radps());
  state_.heading_sd_rad = filter_.heading_sd_rad();
  state_.inclination_sd_rad = filter_.inclination_sd_rad();
}

void HandAttitude::BeginTPose() {
  rested_s_ = 0;  // The next reading has the whole of the means.
}

void HandAttitude::Align(bool heading_matters) {
  if (rested_s_ < kLeastRestS || mean_force_S_.norm() < kTPoseForceMps2) return;
  const Eigen::Vector3d up_S = mean_force_S_.normalized();
  // Upright: no heading.
  if (heading_matters && (Eigen::Vector3d::UnitX() - up_S.x() * up_S).norm() < 1e-3) return;
  filter_.Start(mean_force_S_, bias_S_, kTPoseBiasSd);
  R_ST_ = (R_WF_ * filter_.R_WS()).transpose();
  state_ = {};
  state_.valid = true;
}

bool IsSquat(double com_height_m, double t_pose_height_m, double left_load_n, double right_load_n) {
  constexpr double kSunkTo = 0.94;      // Six centimetres: more than the height is uncertain by.
  constexpr double kLeastShare = 0.25;  // On each foot.
  const double load_n = left_load_n + right_load_n;
  return load_n > 0 && std::min(left_load_n, right_load_n) > kLeastShare * load_n &&
         com_height_m < kSunkTo * t_pose_height_m;
}

namespace {

constexpr double kBentRad = 0.17;    // A smaller bend shows little of its axis.
constexpr double kEnoughRadS = 0.1;  // Half a second of that and a little more.
constexpr double kMostRadS = 3;      // A few squats; by later ones the heading has drifted.
constexpr double kAgreement = 0.9;   // Bends that are 25 degrees apart show nothing.
constexpr double kLeanSdRad = 0.07;  // How a sensor slips, and how a body sways, in a bend.

}  // namespace

void SegmentAttitude::Align() {
  attitude_.Align(/*heading_matters=*/turn_.about_left == 0);
  bent_F_.setZero();
  bent_rad_s_ = bent_rad2_s_ = 0;
  state_ = {};
}

void SegmentAttitude::Watch(const Eigen::Vector3d& up_F, double step_s) {
  const double bent_rad = std::atan2(up_F.head<2>().norm(), up_F.z());
  if (bent_rad < kBentRad || bent_rad_s_ >= kMostRadS) return;
  bent_F_ += bent_rad * step_s * Eigen::Vector2d(-up_F.y(), up_F.x()).normalized();
  bent_rad_s_ += bent_rad * step_s;
  bent_rad2_s_ += Square(bent_rad) * step_s;
}

double SegmentAttitude::heading_rad() const {
  const Eigen::Vector2d left_F = turn_.about_left * bent_F_;
  return std::numbers::pi / 2 + turn_.to_left_rad - std::atan2(left_F.y(), left_F.x());
}

double SegmentAttitude::mounting_sd_rad() const {
  return std::hypot(turn_.sd_rad, kLeanSdRad * bent_rad_s_ / bent_rad2_s_);
}

void SegmentAttitude::Advance(const HandReading& reading, double step_s, bool squats) {
  attitude_.Advance(reading, step_s);
  const HandState& turned = attitude_.state();
  if (!turned.valid) return;
  if (turn_.about_left == 0) {
    state_ = turned;
    state_.heading_sd_rad = std::hypot(turned.heading_sd_rad, turn_.sd_rad);
    return;
  }
  if (squats) Watch(turned.turn_W.col(2), step_s);
  state_.valid = bent_rad_s_ >= kEnoughRadS && bent_F_.norm() > kAgreement * bent_rad_s_;
  if (!state_.valid) return;
  const Eigen::Matrix3d R_WF =
      Eigen::AngleAxisd(heading_rad(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  state_ = turned;
  state_.turn_W = R_WF * turned.turn_W * R_WF.transpose();
  state_.acceleration_W_mps2 = R_WF * turned.acceleration_W_mps2;
  state_.angular_velocity_W_radps = R_WF * turned.angular_velocity_W_radps;
  state_.heading_sd_rad = std::hypot(turned.heading_sd_rad, mounting_sd_rad());
}

}  // namespace footing::arms
