#include "common/wire/fields.h"

namespace footing::wire {

template <typename Way>
void Fields(Way way, const stream::ContactCell&) {
  FOOTING_FIELD_OF(position_m.x(), x_m);
  FOOTING_FIELD_OF(position_m.y(), y_m);
  FOOTING_FIELD_OF(position_m.z(), z_m);
  FOOTING_FIELD(load_n);
}
FOOTING_BOTH_WAYS(ContactCell)

template <typename Way>
void Fields(Way way, const stream::ContactFrame&) {
  FOOTING_FIELD(source);
  FOOTING_FIELD(rig);
  FOOTING_FIELD(age_ns);
  FOOTING_FIELD(sent_ns);
  FOOTING_ENUM(ContactBody, body);
  if constexpr (Way::kOut) {
    for (const auto& cell : way.value.cells) *way.message.add_cells() = ToProto(cell);
  } else {
    for (const v1::ContactCell& cell : way.message.cells()) {  // With what is not finite.
      way.value.cells.push_back({{cell.x_m(), cell.y_m(), cell.z_m()}, cell.load_n()});
    }
  }
  FOOTING_FIELD(simulated);
}
FOOTING_BOTH_WAYS(ContactFrame)

template <typename Way>
void Fields(Way way, const stream::ContactSample&) {
  FOOTING_FIELD(rig);
  FOOTING_FIELD(source);
  FOOTING_ENUM(ContactBody, body);
  FOOTING_FIELD(received_ns);
  FOOTING_FIELD(sampled_ns);
  FOOTING_REPEATED(cells);
  FOOTING_FIELD(simulated);
}
FOOTING_BOTH_WAYS(ContactSample)

}  // namespace footing::wire
