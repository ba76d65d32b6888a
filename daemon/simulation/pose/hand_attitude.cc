#include "daemon/simulation/pose/hand_attitude.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/base/units.h"

namespace footing::arms {
namespace {

constexpr double kMeanS = 4;                            // Of the T-pose.
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

void HandAttitude::Align() {
  if (rested_s_ < kLeastRestS || mean_force_S_.norm() < kTPoseForceMps2) return;
  const Eigen::Vector3d up_S = mean_force_S_.normalized();
  if ((Eigen::Vector3d::UnitX() - up_S.x() * up_S).norm() < 1e-3) return;  // Upright: no heading.
  filter_.Start(mean_force_S_, bias_S_, kTPoseBiasSd);
  R_ST_ = (R_WF_ * filter_.R_WS()).transpose();
  state_ = {};
  state_.valid = true;
}

}  // namespace footing::arms
