#pragma once

#include <string>
#include <vector>

#include "clients/study/plan/protocol.h"
#include "common/stream/device.h"

namespace footing::study::gate {

/// The roles that an interface needs. The joystick is a Nunchuk on the Wiimote of either hand: its
/// list has the right hand alone, for which the left hand may stand.
std::vector<stream::DeviceRole> RolesOf(const std::string& interface);

/// Whether a device that the interface needs is simulated.
bool AnySimulated(const std::string& interface, const std::vector<stream::DeviceStatus>& devices);

/// What keeps a trial from beginning, one sentence each with the remedy; empty: nothing.
std::vector<std::string> Problems(const plan::DeviceGate& gate, const std::string& interface,
                                  const std::vector<stream::DeviceStatus>& devices);

}  // namespace footing::study::gate
