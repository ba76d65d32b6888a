#pragma once

#include <string>
#include <vector>

#include "clients/ctl/commands.h"

namespace footing::ctl {

/// Roles of --worn. UsageError for an unknown role, a board's role, or one that comes twice.
Result<std::vector<stream::DeviceRole>> BodyRoles(const std::vector<std::string>& names);

/// `assign --gesture`: "Step on the left board now.", "Shake the left wrist now." The session needs
/// GuidedChannels().
Result<void> AssignByGesture(Session& session, const std::string& rig,
                             const std::vector<stream::DeviceRole>& body_roles, bool script,
                             const Shared& shared);

}  // namespace footing::ctl
