#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::wire {

v1::Skeleton ToProto(const stream::Skeleton& value) {
  v1::Skeleton message;
  message.set_character(value.character);
  message.set_name(Utf8(value.name));
  for (const auto& link : value.links) {
    v1::Link& out = *message.add_links();
    out.set_name(Utf8(link.name));
    out.set_parent(link.parent);
    *out.mutable_size_m() = ToProto(link.size_m);
  }
  for (const auto& point : value.contact_points) message.add_contact_points(Utf8(point));
  return message;
}

stream::Skeleton FromProto(const v1::Skeleton& message) {
  stream::Skeleton value;
  value.character = message.character();
  value.name = message.name();
  for (const auto& link : message.links()) {
    value.links.push_back({link.name(), link.parent(), FromProto(link.size_m())});
  }
  value.contact_points.assign(message.contact_points().begin(), message.contact_points().end());
  return value;
}

v1::LinkPose ToProto(const stream::LinkPose& value) {
  v1::LinkPose message;
  *message.mutable_position_m() = ToProto(value.position_m);
  *message.mutable_orientation() = ToProto(value.orientation);
  return message;
}

stream::LinkPose FromProto(const v1::LinkPose& message) {
  return {FromProto(message.position_m()), FromProto(message.orientation())};
}

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
