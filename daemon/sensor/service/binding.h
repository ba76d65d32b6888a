#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/stream/device.h"
#include "daemon/sensor/kinds/kind_options.h"

namespace footing::sensor {

/// What a device is: its role on a rig (what one person wears or stands on).
struct Binding {
  std::string rig;
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;

  bool operator==(const Binding&) const = default;
};

/// Usage error for a rig's name that is not 1 to 64 bytes of printable text: it goes to screens and
/// files.
Result<void> CheckRig(const std::string& rig);

/// From "rig/role", e.g. "main/left_hand".
Result<Binding> ParseBinding(const std::string& text);

/// And back.
std::string ToText(const Binding& binding);

/// The first role for a device of this placement that is free on the rig: hands, legs and head on
/// the body, left then right for boards; kUnspecified when all are taken.
stream::DeviceRole FirstFreeRole(decode::Placement placement, const std::string& rig,
                                 const std::vector<Binding>& taken);

/// A board cannot be a hand, nor a remote a board.
bool RoleFits(decode::Placement placement, stream::DeviceRole role);

}  // namespace footing::sensor
