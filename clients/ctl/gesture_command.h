#pragma once

#include <string>

#include "clients/ctl/commands.h"

namespace footing::ctl {

/// `assign --gesture`: "step on the left board now", "shake the left wrist one". The session needs
/// GuidedChannels().
Result<void> AssignByGesture(Session& session, const std::string& rig, bool script,
                             const Shared& shared);

}  // namespace footing::ctl
