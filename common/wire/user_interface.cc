#include "common/wire/fields.h"

namespace footing::wire {

template <typename Way>
void Fields(Way way, const stream::InterfaceState&) {
  FOOTING_ENUM(UserInterface, interface);
  FOOTING_ENUM(Activity, activity);
  FOOTING_ENUM(Gait, gait);
  FOOTING_ENUM(Gait, next_gait);
  FOOTING_FIELD(next_share);
  FOOTING_FIELD(frequency_valid);
  FOOTING_FIELD(frequency_hz);
  FOOTING_FIELD(border_hz);
  FOOTING_FIELD(phase_valid);
  FOOTING_FIELD(phase_rad);
  FOOTING_FIELD(together_rad);
  FOOTING_FIELD_OF(forearms.valid, elevation_valid);
  FOOTING_FIELD_OF(forearms.elevation_rad, elevation_rad);
  FOOTING_FIELD_OF(forearms.bent_rad, bent_rad);
  FOOTING_FIELD_OF(stick.valid, stick_valid);
  FOOTING_FIELD_OF(stick.x, stick_x);
  FOOTING_FIELD_OF(stick.y, stick_y);
  FOOTING_FIELD(load_valid);
  FOOTING_FIELD(left_share);
  FOOTING_FIELD_OF(turn.valid, turn_valid);
  FOOTING_ENUM_OF(TurnSource, turn.source, turn_source);
  FOOTING_FIELD_OF(turn.share, turn_share);
  FOOTING_FIELD(missing_roles);
  FOOTING_FIELD(unmounted_roles);
  FOOTING_FIELD(view_roll_rad);
}
FOOTING_BOTH_WAYS(InterfaceState)

}  // namespace footing::wire
