#include "daemon/simulation/arms/hand_attitude.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/units/units.h"

namespace footing::arms {
namespace {

constexpr double kMeanS = 4;       // Of the T-pose.
constexpr double kLeastRestS = 1;  // Less of it shows nothing.
constexpr double kGravityS = 1.5;  // Twice, one after the other: 3 s in all.
constexpr double kFrozenS = 3;     // After a clipped reading.
constexpr double kLeastForceMps2 = 1;

Eigen::Matrix3d Turned(const Eigen::Vector3d& angle) {
  const double norm = angle.norm();
  if (norm < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(norm, angle / norm).toRotationMatrix();
}

/// The nearest rotation, after small errors of rounding.
Eigen::Matrix3d Rotation(const Eigen::Matrix3d& R) {
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

}  // namespace

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
  const Eigen::Vector3d turn_S = reading.angular_velocity_S_radps - bias_S_;
  R_GS_ = Rotation(R_GS_ * Turned(0.5 * (turn_S + last_turn_S_) * step_s));
  last_turn_S_ = turn_S;
  Correct(reading, step_s);
  const Eigen::Matrix3d R_WS = R_WG_ * R_GS_;
  state_.turn_W = R_WS * R_ST_;
  state_.acceleration_W_mps2 = R_WS * reading.specific_force_S_mps2;
  state_.acceleration_W_mps2.z() -= kStandardGravityMps2;
  state_.angular_velocity_W_radps = R_WS * turn_S;
}

void HandAttitude::Correct(const HandReading& reading, double step_s) {
  if (reading.clipped) {
    held_s_ = kFrozenS;
    slow_G_ = up_G_ = R_WG_.transpose() * Eigen::Vector3d(0, 0, kStandardGravityMps2);
  }
  if (held_s_ > 0) {
    held_s_ -= step_s;
    return;
  }
  const double share = 1 - std::exp(-step_s / kGravityS);
  slow_G_ += share * (R_GS_ * reading.specific_force_S_mps2 - slow_G_);
  up_G_ += share * (slow_G_ - up_G_);
  const Eigen::Vector3d up_W = R_WG_ * up_G_;
  if (up_W.norm() < kLeastForceMps2) return;
  R_WG_ = Rotation(
      Eigen::Quaterniond::FromTwoVectors(up_W, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
      R_WG_);
}

void HandAttitude::BeginTPose() {
  rested_s_ = 0;  // The next reading has the whole of the means.
}

void HandAttitude::Align() {
  if (rested_s_ < kLeastRestS || mean_force_S_.norm() < kLeastForceMps2) return;
  const Eigen::Vector3d up_S = mean_force_S_.normalized();
  Eigen::Vector3d ahead_S = Eigen::Vector3d::UnitX() - up_S.x() * up_S;
  if (ahead_S.norm() < 1e-3) return;  // Held upright: no heading.
  ahead_S.normalize();
  R_ST_.col(0) = ahead_S;
  R_ST_.col(1) = up_S.cross(ahead_S);
  R_ST_.col(2) = up_S;
  R_GS_.setIdentity();
  R_WG_ = R_ST_.transpose();
  slow_G_ = up_G_ = mean_force_S_;
  last_turn_S_.setZero();
  held_s_ = 0;
  state_ = {};
  state_.valid = true;
}

}  // namespace footing::arms
