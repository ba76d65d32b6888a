#include "common/wire/fields.h"

namespace footing::wire {

template <typename Way>
void Fields(Way way, const stream::Link&) {
  FOOTING_FIELD(name);
  FOOTING_FIELD(parent);
  FOOTING_MESSAGE(size_m);
}
FOOTING_BOTH_WAYS(Link)

template <typename Way>
void Fields(Way way, const stream::Skeleton&) {
  FOOTING_FIELD(character);
  FOOTING_FIELD(name);
  FOOTING_REPEATED(links);
  if constexpr (Way::kOut) {
    for (const auto& point : way.value.contact_points) way.message.add_contact_points(Utf8(point));
  } else {
    const auto& points = way.message.contact_points();
    way.value.contact_points.assign(points.begin(), points.end());
  }
}
FOOTING_BOTH_WAYS(Skeleton)

template <typename Way>
void Fields(Way way, const stream::LinkPose&) {
  FOOTING_MESSAGE(position_m);
  FOOTING_MESSAGE(orientation);
}
FOOTING_BOTH_WAYS(LinkPose)

v1::Contact ToProto(const stream::Contact& value) {
  v1::Contact message;
  message.set_touching(value.touching);
  *message.mutable_position_m() = ToProto(value.position_m);
  message.set_normal_force_n(Finite(value.normal_force_n));
  return message;
}

v1::GaitState ToProto(const stream::GaitState& value) {
  v1::GaitState message;
  message.set_gait(static_cast<v1::Gait>(value.gait));
  message.set_commanded_gait(static_cast<v1::Gait>(value.commanded_gait));
  message.set_pending(value.pending);
  message.set_phase(value.phase);
  message.set_commanded_speed_mps(Finite(value.commanded_speed_mps));
  message.set_commanded_height_m(Finite(value.commanded_height_m));
  message.set_commanded_turn_rad(Finite(value.commanded_turn_rad));
  message.set_speed_mps(Finite(value.speed_mps));
  message.set_heading_rad(Finite(value.heading_rad));
  message.set_steps(value.steps);
  message.set_falls(value.falls);
  *message.mutable_failures() = ToProto(value.failures);
  message.set_operator_put_backs(value.operator_put_backs);
  message.set_distance_m(Finite(value.distance_m));
  message.set_commanded_by_stream(value.commanded_by_stream);
  message.set_next_foothold_x_m(Finite(value.next_foothold_m.x()));
  message.set_next_foothold_y_m(Finite(value.next_foothold_m.y()));
  return message;
}

}  // namespace footing::wire
