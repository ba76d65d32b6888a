#pragma once

#include <string>
#include <vector>

#include "clients/study/plan/protocol.h"
#include "common/stream/device.h"

namespace footing::study::gate {

/// What a participant commands the character with.
struct Played {
  std::string interface;         ///< Name of a stream::UserInterface.
  std::string turn_by = "head";  ///< Of the interface leg: head, trunk or feet.
};

/// The roles that an interface needs. The joystick is a Nunchuk on the Wiimote of either hand: its
/// list has the right hand alone, for which the left hand may stand.
std::vector<stream::DeviceRole> RolesOf(const Played& played);

/// Whether a device that the interface needs is simulated.
bool AnySimulated(const Played& played, const std::vector<stream::DeviceStatus>& devices);

/// What keeps a trial from beginning, one sentence each with the remedy; empty: nothing.
std::vector<std::string> Problems(const plan::DeviceGate& gate, const Played& played,
                                  const std::vector<stream::DeviceStatus>& devices);

/// What does not keep a trial from beginning, but makes the interface worse, one sentence each with
/// the remedy: a shin or trunk worn without a mounting, a board that is not tared.
std::vector<std::string> Warnings(const Played& played,
                                  const std::vector<stream::DeviceStatus>& devices);

}  // namespace footing::study::gate
