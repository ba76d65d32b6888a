#include "common/wire/fields.h"

namespace footing::wire {

template <typename Way>
void Fields(Way way, const stream::BoardPose&) {
  FOOTING_FIELD(x_m);
  FOOTING_FIELD(y_m);
  FOOTING_FIELD(yaw_rad);
}
FOOTING_BOTH_WAYS(BoardPose)

template <typename Way>
void Fields(Way way, const stream::BoardGeometry&) {
  FOOTING_FIELD(plate_x_m);
  FOOTING_FIELD(plate_y_m);
  FOOTING_FIELD(sensor_distance_x_m);
  FOOTING_FIELD(sensor_distance_y_m);
}
FOOTING_BOTH_WAYS(BoardGeometry)

template <typename Way>
void Fields(Way way, const stream::BoardLayout&) {
  FOOTING_FIELD(rig);
  FOOTING_MESSAGE(left);
  FOOTING_MESSAGE(right);
  FOOTING_FIELD(gap_mm);
  FOOTING_FIELD(preset);
  FOOTING_OPTIONAL(left_geometry);
  FOOTING_OPTIONAL(right_geometry);
}
FOOTING_BOTH_WAYS(BoardLayout)

template <typename Way>
void Fields(Way way, const stream::SetupItem&) {
  FOOTING_FIELD(name);
  FOOTING_FIELD(serial);
  FOOTING_FIELD(passed);
  FOOTING_FIELD(wall_time_ns);
  FOOTING_FIELD(residual);
  FOOTING_FIELD(unit);
  FOOTING_FIELD(note);
  FOOTING_FIELD(stale);
}
FOOTING_BOTH_WAYS(SetupItem)

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
