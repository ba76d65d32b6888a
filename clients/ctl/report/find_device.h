#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/stream/device.h"

namespace footing::ctl::display {

/// The device that a person names: by serial (any case), by its number, by RIG/ROLE, or by ROLE
/// alone where only one rig has it. A device that is lost counts only by its serial or number.
/// NoDevice with a list of what there is otherwise.
Result<stream::DeviceStatus> FindDevice(const std::vector<stream::DeviceStatus>& devices,
                                        const std::string& name);

/// The boards for a command to all of them.
struct Boards {
  std::vector<stream::DeviceStatus> there;
  /// Lost ones with a role that no other device has taken.
  std::vector<stream::DeviceStatus> lost;
};
Boards BoardsOf(const std::vector<stream::DeviceStatus>& devices);

/// Those of `now` whose rig or role is another one than `before`.
std::vector<stream::DeviceStatus> Reassigned(const std::vector<stream::DeviceStatus>& before,
                                             const std::vector<stream::DeviceStatus>& now);

/// "main/left_hand" into its two parts. Usage error with the roles that there are otherwise.
Result<std::pair<std::string, stream::DeviceRole>> ParseRigRole(const std::string& text);

}  // namespace footing::ctl::display
