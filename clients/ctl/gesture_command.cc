#include "clients/ctl/gesture_command.h"

#include <algorithm>

#include "clients/ctl/guided.h"

namespace footing::ctl {

Result<std::vector<stream::DeviceRole>> BodyRoles(const std::vector<std::string>& names) {
  std::vector<stream::DeviceRole> roles;
  for (const std::string& name : names) {
    const stream::DeviceRole role = stream::RoleNamed(name);
    if (role == stream::DeviceRole::kLeftBoard || role == stream::DeviceRole::kRightBoard ||
        role == stream::DeviceRole::kUnspecified) {
      return UsageError("--worn " + name +
                        ": not a role of a remote; must be one of: left_hand right_hand left_leg "
                        "right_leg head trunk editor left_upper_arm right_upper_arm left_forearm "
                        "right_forearm");
    }
    if (std::find(roles.begin(), roles.end(), role) != roles.end()) {
      return UsageError("--worn names " + name + " twice");
    }
    roles.push_back(role);
  }
  return roles;
}

Result<void> AssignByGesture(Session& session, const std::string& rig,
                             const std::vector<stream::DeviceRole>& body_roles, bool script,
                             const Shared& shared) {
  guide::SetUpOptions options;
  options.rig = rig;
  options.body_roles = body_roles;
  const auto results = RunGuided(session, options, {guide::Item::kRoles}, PromptOptions{script});
  if (!results) return results.error();
  if (results->empty()) return NoDevice("rig " + rig + " has no device; see footing-ctl devices");
  nlohmann::ordered_json out{{"rig", rig}, {"items", nlohmann::ordered_json::array()}};
  std::string text;
  for (const auto& item : *results) {
    out["items"].push_back(ToJson(item));
    text += (text.empty() ? "" : "\n") + ToText(item);
  }
  Print(out, text, shared);
  for (const auto& item : *results) {
    if (!item.passed) return Failure(ToText(item));
  }
  return {};
}

}  // namespace footing::ctl
