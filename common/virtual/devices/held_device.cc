#include "common/virtual/devices/held_device.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/edit.h"

namespace footing::virtual_sensors {
namespace {

constexpr double kStrapShare = 0.5;  // Share of the way along its segment.

/// At a point of a joint. R_SW: of the T-pose.
HeldCourse FollowPoint(const body::Body& body, const motion::Motion& motion,
                       const body::Point& point, const Eigen::Matrix3d& R_SW_T, double cutoff_hz) {
  const body::Skeleton& skeleton = body.skeleton;
  const auto j = static_cast<std::size_t>(point.joint);
  body::Kinematics at(skeleton);
  body::ComputeKinematics(skeleton, body::TPose(skeleton, body.landmarks), at);
  const Eigen::Matrix3d R_SJ = R_SW_T * at.R_WJ[j];

  const motion::Motion smooth = motion::Smoothed(motion, cutoff_hz);
  const motion::MotionRates rates = motion::Rates(smooth);
  body::JointVelocities velocities(skeleton);
  body::JointAccelerations accelerations(skeleton);
  HeldCourse course;
  course.specific_force_S_mps2.resize(3, smooth.frames());
  course.angular_velocity_S_radps.resize(3, smooth.frames());
  for (Eigen::Index i = 0; i < smooth.frames(); ++i) {
    body::ComputeKinematics(skeleton, smooth.q.col(i), at);
    body::ComputeVelocities(skeleton, at, rates.q_dot.col(i), velocities);
    body::ComputeAccelerations(skeleton, at, rates.q_dot.col(i), rates.q_ddot.col(i), velocities,
                               accelerations);
    const Eigen::Vector3d r = at.R_WJ[j] * point.p_J_m;
    const Eigen::Vector3d& w = velocities.w_WJ[j];
    const Eigen::Vector3d a =
        accelerations.a_WJ[j] + accelerations.alpha_WJ[j].cross(r) + w.cross(w.cross(r));
    const Eigen::Matrix3d R_SW = R_SJ * at.R_WJ[j].transpose();
    course.specific_force_S_mps2.col(i) = R_SW * (a + Eigen::Vector3d(0, 0, kStandardGravityMps2));
    course.angular_velocity_S_radps.col(i) = R_SW * w;
  }
  return course;
}

}  // namespace

HeldCourse FollowFist(const body::Body& body, const motion::Motion& motion, int side,
                      double cutoff_hz) {
  return FollowPoint(body, motion, body::Fist(body, side), Eigen::Matrix3d::Identity(), cutoff_hz);
}

HeldCourse FollowSegment(const body::Body& body, const motion::Motion& motion, int side,
                         ArmSegment segment, double cutoff_hz) {
  const auto joint_of = [&](body::Landmark left) {
    return body.landmarks[side == 0 ? left : body::Mirrored(left)];
  };
  const int elbow = joint_of(body::Landmark::kLeftElbow);
  const bool upper = segment == ArmSegment::kUpperArm;
  const int joint = upper ? joint_of(body::Landmark::kLeftShoulder) : elbow;
  const body::Point fist = body::Fist(body, side);
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  const auto j = static_cast<std::size_t>(joint);
  const Eigen::Vector3d end_W_m =
      upper ? at.p_WJ[static_cast<std::size_t>(elbow)] : body::Place(fist, at);
  const Eigen::Vector3d middle_J_m =
      kStrapShare * (at.R_WJ[j].transpose() * (end_W_m - at.p_WJ[j]));
  const Eigen::Matrix3d R_WS =
      Eigen::AngleAxisd((side == 0 ? 0.5 : -0.5) * std::numbers::pi, Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  return FollowPoint(body, motion, {joint, middle_J_m}, R_WS.transpose(), cutoff_hz);
}

HeldCourse FollowJoint(const body::Body& body, const motion::Motion& motion, int joint,
                       const Eigen::Vector3d& beside_W_m, double cutoff_hz) {
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  const Eigen::Vector3d beside_J_m =
      at.R_WJ[static_cast<std::size_t>(joint)].transpose() * beside_W_m;
  return FollowPoint(body, motion, {joint, beside_J_m}, Eigen::Matrix3d::Identity(), cutoff_hz);
}

HeldErrorConfig HeldErrors::None() {
  HeldErrorConfig none;
  none.force_noise_mps2 = none.force_count_mps2 = none.force_bias_mps2 = 0;
  none.turn_noise_radps = none.turn_count_radps = none.turn_bias_radps = 0;
  none.turn_walk_radps_rt_s = none.gain_spread = none.grip_tilt_rad = none.grip_heading_rad = 0;
  return none;
}

HeldErrors::HeldErrors(const HeldErrorConfig& config) : config_(config), random_(config.seed) {
  const Eigen::Vector3d tilt = noise::NormalVector(config.grip_tilt_rad, random_);
  grip_ = Eigen::AngleAxisd(tilt.x(), Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(tilt.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(config.grip_heading_rad * random_.Normal(), Eigen::Vector3d::UnitZ())
              .toRotationMatrix();
  if (config.rolled) {
    grip_ = Eigen::AngleAxisd(random_.Uniform(-std::numbers::pi, std::numbers::pi),
                              Eigen::Vector3d::UnitX()) *
            grip_;
  }
  force_gain_ = Eigen::Vector3d::Ones() + noise::NormalVector(config.gain_spread, random_);
  turn_gain_ = Eigen::Vector3d::Ones() + noise::NormalVector(config.gain_spread, random_);
  force_bias_ = noise::NormalVector(config.force_bias_mps2, random_);
  turn_bias_ = noise::NormalVector(config.turn_bias_radps, random_);
}

HeldReading HeldErrors::Advance(const Eigen::Vector3d& specific_force_mps2,
                                const Eigen::Vector3d& angular_velocity_radps, double step_s) {
  const auto counted = [](double value, double count) {
    return count > 0 ? count * std::round(value / count) : value;
  };
  turn_bias_ += noise::NormalVector(config_.turn_walk_radps_rt_s * std::sqrt(step_s), random_);
  HeldReading reading;
  reading.specific_force_S_mps2 = force_gain_.cwiseProduct(grip_ * specific_force_mps2) +
                                  force_bias_ +
                                  noise::NormalVector(config_.force_noise_mps2, random_);
  reading.angular_velocity_S_radps = turn_gain_.cwiseProduct(grip_ * angular_velocity_radps) +
                                     turn_bias_ +
                                     noise::NormalVector(config_.turn_noise_radps, random_);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double& force = reading.specific_force_S_mps2(axis);
    reading.clipped = reading.clipped || std::abs(force) >= config_.force_range_mps2;
    force = std::clamp(counted(force, config_.force_count_mps2), -config_.force_range_mps2,
                       config_.force_range_mps2);
    double& turn = reading.angular_velocity_S_radps(axis);
    turn = counted(turn, config_.turn_count_radps);
  }
  return reading;
}

}  // namespace footing::virtual_sensors
