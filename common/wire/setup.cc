#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::wire {

v1::BoardPose ToProto(const stream::BoardPose& value) {
  v1::BoardPose message;
  message.set_x_m(Finite(value.x_m));
  message.set_y_m(Finite(value.y_m));
  message.set_yaw_rad(Finite(value.yaw_rad));
  return message;
}

stream::BoardPose FromProto(const v1::BoardPose& message) {
  stream::BoardPose value;
  value.x_m = Finite(message.x_m());
  value.y_m = Finite(message.y_m());
  value.yaw_rad = Finite(message.yaw_rad());
  return value;
}

v1::BoardGeometry ToProto(const stream::BoardGeometry& value) {
  v1::BoardGeometry message;
  message.set_plate_x_m(Finite(value.plate_x_m));
  message.set_plate_y_m(Finite(value.plate_y_m));
  message.set_sensor_distance_x_m(Finite(value.sensor_distance_x_m));
  message.set_sensor_distance_y_m(Finite(value.sensor_distance_y_m));
  return message;
}

stream::BoardGeometry FromProto(const v1::BoardGeometry& message) {
  stream::BoardGeometry value;
  value.plate_x_m = Finite(message.plate_x_m());
  value.plate_y_m = Finite(message.plate_y_m());
  value.sensor_distance_x_m = Finite(message.sensor_distance_x_m());
  value.sensor_distance_y_m = Finite(message.sensor_distance_y_m());
  return value;
}

v1::BoardLayout ToProto(const stream::BoardLayout& value) {
  v1::BoardLayout message;
  message.set_rig(Utf8(value.rig));
  *message.mutable_left() = ToProto(value.left);
  *message.mutable_right() = ToProto(value.right);
  message.set_gap_mm(Finite(value.gap_mm));
  message.set_preset(Utf8(value.preset));
  if (value.left_geometry) *message.mutable_left_geometry() = ToProto(*value.left_geometry);
  if (value.right_geometry) *message.mutable_right_geometry() = ToProto(*value.right_geometry);
  return message;
}

stream::BoardLayout FromProto(const v1::BoardLayout& message) {
  stream::BoardLayout value;
  value.rig = message.rig();
  value.left = FromProto(message.left());
  value.right = FromProto(message.right());
  value.gap_mm = Finite(message.gap_mm());
  value.preset = message.preset();
  if (message.has_left_geometry()) value.left_geometry = FromProto(message.left_geometry());
  if (message.has_right_geometry()) value.right_geometry = FromProto(message.right_geometry());
  return value;
}

v1::SetupItem ToProto(const stream::SetupItem& value) {
  v1::SetupItem message;
  message.set_name(Utf8(value.name));
  message.set_serial(Utf8(value.serial));
  message.set_passed(value.passed);
  message.set_wall_time_ns(value.wall_time_ns);
  message.set_residual(Finite(value.residual));
  message.set_unit(Utf8(value.unit));
  message.set_note(Utf8(value.note));
  message.set_stale(value.stale);
  return message;
}

stream::SetupItem FromProto(const v1::SetupItem& message) {
  stream::SetupItem value;
  value.name = message.name();
  value.serial = message.serial();
  value.passed = message.passed();
  value.wall_time_ns = message.wall_time_ns();
  value.residual = Finite(message.residual());
  value.unit = message.unit();
  value.note = message.note();
  value.stale = message.stale();
  return value;
}

v1::RigSetup ToProto(const stream::RigSetup& value) {
  v1::RigSetup message;
  message.set_rig(Utf8(value.rig));
  *message.mutable_layout() = ToProto(value.layout);
  for (const auto& one : value.items) *message.add_items() = ToProto(one);
  for (const auto& one : value.mountings) {
    v1::DeviceMounting& mounting = *message.add_mountings();
    mounting.set_serial(Utf8(one.serial));
    *mounting.mutable_rotation() = ToProto(one.rotation_MS);
    mounting.set_residual_rad(Finite(one.residual_rad));
  }
  return message;
}

stream::RigSetup FromProto(const v1::RigSetup& message) {
  stream::RigSetup value;
  value.rig = message.rig();
  value.layout = FromProto(message.layout());
  for (const auto& one : message.items()) value.items.push_back(FromProto(one));
  for (const auto& one : message.mountings()) {
    value.mountings.push_back(
        {one.serial(), FromProto(one.rotation()), Finite(one.residual_rad())});
  }
  return value;
}

}  // namespace footing::wire
