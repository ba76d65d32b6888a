#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::wire {

v1::NunchukSample ToProto(const stream::NunchukSample& value) {
  v1::NunchukSample message;
  message.set_device(value.device);
  message.set_report_count(value.report_count);
  message.set_received_ns(value.received_ns);
  message.set_sampled_ns(value.sampled_ns);
  message.set_stick_x(Finite(value.stick_x));
  message.set_stick_y(Finite(value.stick_y));
  message.set_c(value.c);
  message.set_z(value.z);
  *message.mutable_specific_force_mps2() = ToProto(value.specific_force_mps2);
  message.set_clipped_axes(value.clipped_axes);
  message.set_repeated(value.repeated);
  message.set_uncalibrated(value.uncalibrated);
  message.set_simulated(value.simulated);
  return message;
}

stream::NunchukSample FromProto(const v1::NunchukSample& message) {
  stream::NunchukSample value;
  value.device = message.device();
  value.report_count = message.report_count();
  value.received_ns = message.received_ns();
  value.sampled_ns = message.sampled_ns();
  value.stick_x = Finite(message.stick_x());
  value.stick_y = Finite(message.stick_y());
  value.c = message.c();
  value.z = message.z();
  value.specific_force_mps2 = FromProto(message.specific_force_mps2());
  value.clipped_axes = message.clipped_axes();
  value.repeated = message.repeated();
  value.uncalibrated = message.uncalibrated();
  value.simulated = message.simulated();
  return value;
}

v1::GamepadSample ToProto(const stream::GamepadSample& value) {
  v1::GamepadSample message;
  message.set_device(value.device);
  message.set_report_count(value.report_count);
  message.set_received_ns(value.received_ns);
  message.set_sampled_ns(value.sampled_ns);
  message.set_left_x(Finite(value.left_x));
  message.set_left_y(Finite(value.left_y));
  message.set_right_x(Finite(value.right_x));
  message.set_right_y(Finite(value.right_y));
  message.set_left_trigger(Finite(value.left_trigger));
  message.set_right_trigger(Finite(value.right_trigger));
  message.set_buttons(value.buttons);
  message.set_repeated(value.repeated);
  message.set_uncalibrated(value.uncalibrated);
  message.set_simulated(value.simulated);
  return message;
}

stream::GamepadSample FromProto(const v1::GamepadSample& message) {
  stream::GamepadSample value;
  value.device = message.device();
  value.report_count = message.report_count();
  value.received_ns = message.received_ns();
  value.sampled_ns = message.sampled_ns();
  value.left_x = Finite(message.left_x());
  value.left_y = Finite(message.left_y());
  value.right_x = Finite(message.right_x());
  value.right_y = Finite(message.right_y());
  value.left_trigger = Finite(message.left_trigger());
  value.right_trigger = Finite(message.right_trigger());
  value.buttons = message.buttons();
  value.repeated = message.repeated();
  value.uncalibrated = message.uncalibrated();
  value.simulated = message.simulated();
  return value;
}

v1::CameraPoint ToProto(const stream::CameraPoint& value) {
  v1::CameraPoint message;
  message.set_x(value.x);
  message.set_y(value.y);
  message.set_size(value.size);
  return message;
}

stream::CameraPoint FromProto(const v1::CameraPoint& message) {
  stream::CameraPoint value;
  value.x = message.x();
  value.y = message.y();
  value.size = message.size();
  return value;
}

v1::CameraSample ToProto(const stream::CameraSample& value) {
  v1::CameraSample message;
  message.set_device(value.device);
  message.set_received_ns(value.received_ns);
  message.set_sampled_ns(value.sampled_ns);
  for (const auto& one : value.points) *message.add_points() = ToProto(one);
  message.set_simulated(value.simulated);
  return message;
}

stream::CameraSample FromProto(const v1::CameraSample& message) {
  stream::CameraSample value;
  value.device = message.device();
  value.received_ns = message.received_ns();
  value.sampled_ns = message.sampled_ns();
  for (const auto& one : message.points()) value.points.push_back(FromProto(one));
  value.simulated = message.simulated();
  return value;
}

}  // namespace footing::wire
