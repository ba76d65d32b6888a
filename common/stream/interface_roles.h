#pragma once

#include <vector>

#include "common/stream/device.h"
#include "common/stream/user_interface.h"

namespace footing::stream {

/// The roles of an interface's devices, left before right; none for kUnspecified. The joystick is a
/// Nunchuk on the Wiimote of either hand: its list has the right hand alone, for which the left
/// hand may stand. `turn_by` is of the interface leg.
std::vector<DeviceRole> RolesOf(UserInterface interface, TurnSource turn_by);

}  // namespace footing::stream
