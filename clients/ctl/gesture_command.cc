#include "clients/ctl/gesture_command.h"

#include "clients/ctl/guided.h"

namespace footing::ctl {

Result<void> AssignByGesture(Session& session, const std::string& rig, bool script,
                             const Shared& shared) {
  guide::Wishes wishes;
  wishes.rig = rig;
  const auto results = RunGuided(session, wishes, {guide::Item::kRoles}, Talk{script});
  if (!results) return results.error();
  if (results->empty()) return NoDevice("rig " + rig + " has no device: footing-ctl devices");
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
