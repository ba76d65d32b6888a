#pragma once

#include <cstdint>
#include <vector>

#include "common/stream/character.h"
#include "common/stream/device.h"

namespace footing::stream {

/// The roles of an interface's devices, left before right; none for kUnspecified. The joystick is a
/// Nunchuk on the Wiimote of either hand: its list has the right hand alone, for which the left
/// hand may stand. `turn_by` is of the interface leg.
std::vector<DeviceRole> RolesOf(UserInterface interface, TurnSource turn_by);

/// The lamps that show a role, bits 0 to 3: left hand 1, right hand 2, left leg 3, right leg 4,
/// head 1 and 4, trunk 1 and 3, editor 2 and 3, left upper arm 1 and 2, right upper arm 2 and 4,
/// left forearm 1 to 3, right forearm 2 to 4, pelvis 1, 3 and 4, left thigh 1, 2 and 4, right thigh
/// 3 and 4. A board has the first lamp alone: lit on the left
/// one, dark on the right one. 0 without a role.
std::uint32_t LedsOf(DeviceRole role);

/// Whether it has what the joystick interface reads: the stick of a Nunchuk, or one of its own.
bool HasStick(const DeviceStatus& device);

}  // namespace footing::stream
