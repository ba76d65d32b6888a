#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::wire {
namespace {

v1::DeviceFeatures DeviceToProto(const stream::DeviceFeatures& value) {
  v1::DeviceFeatures message;
  message.set_device(value.device);
  message.set_role(static_cast<v1::DeviceRole>(value.role));
  message.set_moving(value.moving);
  message.set_frequency_valid(value.frequency_valid);
  message.set_frequency_hz(Finite(value.frequency_hz));
  message.set_amplitude_valid(value.amplitude_valid);
  message.set_amplitude_mps2(Finite(value.amplitude_mps2));
  message.set_inclination_valid(value.inclination_valid);
  message.set_roll_rad(Finite(value.roll_rad));
  message.set_pitch_rad(Finite(value.pitch_rad));
  message.set_held(value.held);
  message.set_simulated(value.simulated);
  return message;
}

stream::DeviceFeatures DeviceFromProto(const v1::DeviceFeatures& message) {
  stream::DeviceFeatures value;
  value.device = message.device();
  if (v1::DeviceRole_IsValid(message.role())) {
    value.role = static_cast<stream::DeviceRole>(message.role());
  }
  value.moving = message.moving();
  value.frequency_valid = message.frequency_valid();
  value.frequency_hz = Finite(message.frequency_hz());
  value.amplitude_valid = message.amplitude_valid();
  value.amplitude_mps2 = Finite(message.amplitude_mps2());
  value.inclination_valid = message.inclination_valid();
  value.roll_rad = Finite(message.roll_rad());
  value.pitch_rad = Finite(message.pitch_rad());
  value.held = message.held();
  value.simulated = message.simulated();
  return value;
}

}  // namespace

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

v1::MotionSample ToProto(const stream::MotionSample& value) {
  v1::MotionSample message;
  message.set_device(value.device);
  message.set_report_count(value.report_count);
  message.set_received_ns(value.received_ns);
  message.set_sampled_ns(value.sampled_ns);
  *message.mutable_specific_force_mps2() = ToProto(value.specific_force_mps2);
  *message.mutable_filtered_mps2() = ToProto(value.filtered_mps2);
  message.set_clipped_axes(value.clipped_axes);
  message.set_repeated(value.repeated);
  message.set_uncalibrated(value.uncalibrated);
  message.set_simulated(value.simulated);
  message.set_buttons(value.buttons);
  if (value.has_angular_velocity) {
    *message.mutable_angular_velocity_radps() = ToProto(value.angular_velocity_radps);
  }
  message.set_angular_velocity_clipped(value.angular_velocity_clipped);
  message.set_gyroscope_uncalibrated(value.gyroscope_uncalibrated);
  if (value.has_magnetic_field) {
    *message.mutable_magnetic_field() = ToProto(value.magnetic_field);
  }
  message.set_trigger(Finite(value.trigger));
  message.set_temperature_c(Finite(value.temperature_c));
  if (!value.gyroscope_bias_radps.isZero(0)) {
    *message.mutable_gyroscope_bias_radps() = ToProto(value.gyroscope_bias_radps);
  }
  return message;
}

stream::MotionSample FromProto(const v1::MotionSample& message) {
  stream::MotionSample value;
  value.device = message.device();
  value.report_count = message.report_count();
  value.received_ns = message.received_ns();
  value.sampled_ns = message.sampled_ns();
  value.specific_force_mps2 = FromProto(message.specific_force_mps2());
  value.filtered_mps2 = FromProto(message.filtered_mps2());
  value.clipped_axes = message.clipped_axes();
  value.repeated = message.repeated();
  value.uncalibrated = message.uncalibrated();
  value.simulated = message.simulated();
  value.buttons = message.buttons();
  value.has_angular_velocity = message.has_angular_velocity_radps();
  value.angular_velocity_radps = FromProto(message.angular_velocity_radps());
  value.angular_velocity_clipped = message.angular_velocity_clipped();
  value.gyroscope_uncalibrated = message.gyroscope_uncalibrated();
  value.has_magnetic_field = message.has_magnetic_field();
  value.magnetic_field = FromProto(message.magnetic_field());
  value.trigger = Finite(message.trigger());
  value.temperature_c = Finite(message.temperature_c());
  value.gyroscope_bias_radps = FromProto(message.gyroscope_bias_radps());
  return value;
}

v1::RigFeatures ToProto(const stream::RigFeatures& value) {
  v1::RigFeatures message;
  message.set_rig(Utf8(value.rig));
  for (const auto& device : value.devices) *message.add_devices() = DeviceToProto(device);
  for (const auto& pair : value.pairs) {
    v1::PairFeatures& out = *message.add_pairs();
    out.set_left_device(pair.left_device);
    out.set_right_device(pair.right_device);
    out.set_phase_valid(pair.phase_valid);
    out.set_phase_rad(Finite(pair.phase_rad));
  }
  message.set_newest_received_ns(value.newest_received_ns);
  message.set_decoded_ns(value.decoded_ns);
  message.set_computed_ns(value.computed_ns);
  return message;
}

stream::RigFeatures FromProto(const v1::RigFeatures& message) {
  stream::RigFeatures value;
  value.rig = message.rig();
  for (const auto& device : message.devices()) value.devices.push_back(DeviceFromProto(device));
  for (const auto& pair : message.pairs()) {
    value.pairs.push_back(
        {pair.left_device(), pair.right_device(), pair.phase_valid(), Finite(pair.phase_rad())});
  }
  value.newest_received_ns = message.newest_received_ns();
  value.decoded_ns = message.decoded_ns();
  value.computed_ns = message.computed_ns();
  return value;
}

v1::BoardSample ToProto(const stream::BoardSample& value) {
  v1::BoardSample message;
  message.set_device(value.device);
  message.set_report_count(value.report_count);
  message.set_received_ns(value.received_ns);
  message.set_sampled_ns(value.sampled_ns);
  message.set_top_left_n(Finite(value.top_left_n));
  message.set_top_right_n(Finite(value.top_right_n));
  message.set_bottom_left_n(Finite(value.bottom_left_n));
  message.set_bottom_right_n(Finite(value.bottom_right_n));
  message.set_total_n(Finite(value.total_n));
  message.set_cop_valid(value.cop_valid);
  message.set_cop_x_m(Finite(value.cop_x_m));
  message.set_cop_y_m(Finite(value.cop_y_m));
  message.set_contact(value.contact);
  message.set_repeated(value.repeated);
  message.set_uncalibrated(value.uncalibrated);
  message.set_simulated(value.simulated);
  message.set_tared(value.tared);
  return message;
}

stream::BoardSample FromProto(const v1::BoardSample& message) {
  stream::BoardSample value;
  value.device = message.device();
  value.report_count = message.report_count();
  value.received_ns = message.received_ns();
  value.sampled_ns = message.sampled_ns();
  value.top_left_n = Finite(message.top_left_n());
  value.top_right_n = Finite(message.top_right_n());
  value.bottom_left_n = Finite(message.bottom_left_n());
  value.bottom_right_n = Finite(message.bottom_right_n());
  value.total_n = Finite(message.total_n());
  value.cop_valid = message.cop_valid();
  value.cop_x_m = Finite(message.cop_x_m());
  value.cop_y_m = Finite(message.cop_y_m());
  value.contact = message.contact();
  value.repeated = message.repeated();
  value.uncalibrated = message.uncalibrated();
  value.simulated = message.simulated();
  value.tared = message.tared();
  return value;
}

}  // namespace footing::wire
