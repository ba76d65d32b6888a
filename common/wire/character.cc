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

template <typename Way>
void Fields(Way way, const stream::Contact&) {
  FOOTING_FIELD(touching);
  FOOTING_MESSAGE(position_m);
  FOOTING_FIELD(normal_force_n);
}
FOOTING_BOTH_WAYS(Contact)

template <typename Way>
void Fields(Way way, const stream::GaitState&) {
  FOOTING_ENUM(Gait, gait);
  FOOTING_ENUM(Gait, commanded_gait);
  FOOTING_FIELD(pending);
  if constexpr (Way::kOut) way.message.set_phase(way.value.phase);  // Of static storage: out only.
  FOOTING_FIELD(commanded_speed_mps);
  FOOTING_FIELD(commanded_height_m);
  FOOTING_FIELD(commanded_turn_rad);
  FOOTING_FIELD(speed_mps);
  FOOTING_FIELD(heading_rad);
  FOOTING_FIELD(steps);
  FOOTING_FIELD(falls);
  FOOTING_MESSAGE(failures);
  FOOTING_FIELD(operator_put_backs);
  FOOTING_FIELD(distance_m);
  FOOTING_FIELD(commanded_by_stream);
  FOOTING_FIELD_OF(next_foothold_m.x(), next_foothold_x_m);
  FOOTING_FIELD_OF(next_foothold_m.y(), next_foothold_y_m);
}
FOOTING_BOTH_WAYS(GaitState)

template <typename Way>
void Fields(Way way, const stream::ResponseStages&) {
  FOOTING_ENUM(Gait, from);
  FOOTING_ENUM(Gait, to);
  FOOTING_FIELD(report_received_ns);
  FOOTING_FIELD(decoded_ns);
  FOOTING_FIELD(features_computed_ns);
  FOOTING_FIELD(features_received_ns);
  FOOTING_FIELD(command_ns);
  FOOTING_FIELD(contact_ns);
  FOOTING_FIELD(first_frame_ns);
}
FOOTING_BOTH_WAYS(ResponseStages)

}  // namespace footing::wire
