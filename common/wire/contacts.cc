#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::wire {
namespace {

stream::ContactBody BodyOf(v1::ContactBody body) {
  return v1::ContactBody_IsValid(body) ? static_cast<stream::ContactBody>(body)
                                       : stream::ContactBody::kUnspecified;
}

template <typename Message>
void AddCells(const std::vector<stream::ContactCell>& cells, Message& message) {
  for (const stream::ContactCell& cell : cells) {
    v1::ContactCell& out = *message.add_cells();
    out.set_x_m(Finite(cell.position_m.x()));
    out.set_y_m(Finite(cell.position_m.y()));
    out.set_z_m(Finite(cell.position_m.z()));
    out.set_load_n(Finite(cell.load_n));
  }
}

}  // namespace

v1::ContactFrame ToProto(const stream::ContactFrame& value) {
  v1::ContactFrame message;
  message.set_source(Utf8(value.source));
  message.set_rig(Utf8(value.rig));
  message.set_age_ns(value.age_ns);
  message.set_body(static_cast<v1::ContactBody>(value.body));
  AddCells(value.cells, message);
  message.set_simulated(value.simulated);
  return message;
}

stream::ContactFrame FromProto(const v1::ContactFrame& message) {
  stream::ContactFrame value;
  value.source = message.source();
  value.rig = message.rig();
  value.age_ns = message.age_ns();
  value.body = BodyOf(message.body());
  for (const v1::ContactCell& cell : message.cells()) {
    value.cells.push_back({{cell.x_m(), cell.y_m(), cell.z_m()}, cell.load_n()});
  }
  value.simulated = message.simulated();
  return value;
}

v1::ContactSample ToProto(const stream::ContactSample& value) {
  v1::ContactSample message;
  message.set_rig(Utf8(value.rig));
  message.set_source(Utf8(value.source));
  message.set_body(static_cast<v1::ContactBody>(value.body));
  message.set_received_ns(value.received_ns);
  message.set_sampled_ns(value.sampled_ns);
  AddCells(value.cells, message);
  message.set_simulated(value.simulated);
  return message;
}

stream::ContactSample FromProto(const v1::ContactSample& message) {
  stream::ContactSample value;
  value.rig = message.rig();
  value.source = message.source();
  value.body = BodyOf(message.body());
  value.received_ns = message.received_ns();
  value.sampled_ns = message.sampled_ns();
  for (const v1::ContactCell& cell : message.cells()) {
    value.cells.push_back(
        {{Finite(cell.x_m()), Finite(cell.y_m()), Finite(cell.z_m())}, Finite(cell.load_n())});
  }
  value.simulated = message.simulated();
  return value;
}

}  // namespace footing::wire
