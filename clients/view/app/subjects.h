#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "footing/v1/command.pb.h"

namespace footing::view {

/// The commands that put each subject file in place, in their order.
Result<std::vector<v1::Command>> SubjectCommands(const std::vector<std::string>& files);

/// Forgets the T-pose of the first character.
v1::Command TPoseCommand();

}  // namespace footing::view
