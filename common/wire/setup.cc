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

template <typename Way>
void Fields(Way way, const stream::DeviceMounting&) {
  FOOTING_FIELD(serial);
  FOOTING_MESSAGE_OF(rotation_MS, rotation);
  FOOTING_FIELD(residual_rad);
}
FOOTING_BOTH_WAYS(DeviceMounting)

template <typename Way>
void Fields(Way way, const stream::SetupPrompt&) {
  FOOTING_FIELD(item);
  FOOTING_FIELD(text);
  FOOTING_ENUM(Gesture, gesture);
  FOOTING_ENUM(DeviceRole, role);
  FOOTING_FIELD(number);
}
FOOTING_BOTH_WAYS(SetupPrompt)

template <typename Way>
void Fields(Way way, const stream::RigSetup&) {
  FOOTING_FIELD(rig);
  FOOTING_MESSAGE(layout);
  FOOTING_REPEATED(items);
  FOOTING_REPEATED(mountings);
  FOOTING_OPTIONAL(prompt);
}
FOOTING_BOTH_WAYS(RigSetup)

}  // namespace footing::wire
