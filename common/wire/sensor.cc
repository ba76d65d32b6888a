#include "common/wire/fields.h"

namespace footing::wire {

template <typename Way>
void Fields(Way way, const stream::DeviceFeatures&) {
  FOOTING_FIELD(device);
  FOOTING_ENUM(DeviceRole, role);
  FOOTING_FIELD(moving);
  FOOTING_FIELD(frequency_valid);
  FOOTING_FIELD(frequency_hz);
  FOOTING_FIELD(amplitude_valid);
  FOOTING_FIELD(amplitude_mps2);
  FOOTING_FIELD(inclination_valid);
  FOOTING_FIELD(roll_rad);
  FOOTING_FIELD(pitch_rad);
  FOOTING_FIELD(held);
  FOOTING_FIELD(simulated);
  FOOTING_FIELD(swing_valid);
  FOOTING_FIELD(swing_rad);
}
FOOTING_BOTH_WAYS(DeviceFeatures)

template <typename Way>
void Fields(Way way, const stream::PairFeatures&) {
  FOOTING_FIELD(left_device);
  FOOTING_FIELD(right_device);
  FOOTING_FIELD(phase_valid);
  FOOTING_FIELD(phase_rad);
  FOOTING_FIELD(phase_held);
}
FOOTING_BOTH_WAYS(PairFeatures)

v1::Vector3 ToProto(const Eigen::Vector3d& value) {
  v1::Vector3 message;
  message.set_x(Finite(value.x()));
  message.set_y(Finite(value.y()));
  message.set_z(Finite(value.z()));
  return message;
}

Eigen::Vector3d FromProto(const v1::Vector3& message) {
  return {Finite(message.x()), Finite(message.y()), Finite(message.z())};
}

v1::Quaternion ToProto(const Eigen::Quaterniond& value) {
  v1::Quaternion message;
  const bool whole = value.coeffs().allFinite();
  message.set_w(whole ? value.w() : 1.0);
  message.set_x(whole ? value.x() : 0.0);
  message.set_y(whole ? value.y() : 0.0);
  message.set_z(whole ? value.z() : 0.0);
  return message;
}

Eigen::Quaterniond FromProto(const v1::Quaternion& message) {
  const Eigen::Quaterniond value(message.w(), message.x(), message.y(), message.z());
  const bool rotation = value.coeffs().allFinite() && value.squaredNorm() > 0;
  return rotation ? value : Eigen::Quaterniond::Identity();
}

template <typename Way>
void Fields(Way way, const stream::MotionSample&) {
  FOOTING_FIELD(device);
  FOOTING_FIELD(report_count);
  FOOTING_FIELD(received_ns);
  FOOTING_FIELD(sampled_ns);
  FOOTING_MESSAGE(specific_force_mps2);
  FOOTING_MESSAGE(filtered_mps2);
  FOOTING_FIELD(clipped_axes);
  FOOTING_FIELD(repeated);
  FOOTING_FIELD(uncalibrated);
  FOOTING_FIELD(simulated);
  FOOTING_FIELD(buttons);
  FOOTING_FLAGGED(has_angular_velocity, angular_velocity_radps);
  FOOTING_FIELD(angular_velocity_clipped);
  FOOTING_FIELD(gyroscope_uncalibrated);
  FOOTING_FLAGGED(has_magnetic_field, magnetic_field);
  FOOTING_FIELD(trigger);
  FOOTING_FIELD(temperature_c);
  const bool unbiased = Way::kOut && way.value.gyroscope_bias_radps.isZero(0);
  if (!unbiased) {
    FOOTING_MESSAGE(gyroscope_bias_radps);
  }
}
FOOTING_BOTH_WAYS(MotionSample)

template <typename Way>
void Fields(Way way, const stream::RigFeatures&) {
  FOOTING_FIELD(rig);
  FOOTING_REPEATED(devices);
  FOOTING_REPEATED(pairs);
  FOOTING_FIELD(newest_received_ns);
  FOOTING_FIELD(decoded_ns);
  FOOTING_FIELD(computed_ns);
}
FOOTING_BOTH_WAYS(RigFeatures)

template <typename Way>
void Fields(Way way, const stream::BoardSample&) {
  FOOTING_FIELD(device);
  FOOTING_FIELD(report_count);
  FOOTING_FIELD(received_ns);
  FOOTING_FIELD(sampled_ns);
  FOOTING_FIELD(top_left_n);
  FOOTING_FIELD(top_right_n);
  FOOTING_FIELD(bottom_left_n);
  FOOTING_FIELD(bottom_right_n);
  FOOTING_FIELD(total_n);
  FOOTING_FIELD(cop_valid);
  FOOTING_FIELD(cop_x_m);
  FOOTING_FIELD(cop_y_m);
  FOOTING_FIELD(contact);
  FOOTING_FIELD(repeated);
  FOOTING_FIELD(uncalibrated);
  FOOTING_FIELD(simulated);
  FOOTING_FIELD(tared);
}
FOOTING_BOTH_WAYS(BoardSample)

}  // namespace footing::wire
