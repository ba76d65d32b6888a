#include "clients/skeleton/statistics.h"

#include <string>

#include "common/base/units.h"

namespace footing::skeleton {

using nlohmann::ordered_json;

ordered_json ToJson(const Tracker& tracker, const Cost& cost) {
  const TrackerCounts& counts = tracker.counts();
  const DecoderCounts& decoder = tracker.decoder_counts();
  ordered_json json = {{"seconds", cost.seconds},
                       {"cpu_share", cost.seconds > 0 ? cost.cpu_s / cost.seconds : 0},
                       {"packets", counts.packets},
                       {"bytes", counts.bytes},
                       {"dropped_packets", cost.dropped_packets},
                       {"rejected_packets", counts.rejected_packets},
                       {"messages", decoder.messages},
                       {"unknown_messages", decoder.unknown},
                       {"rejected_joints", decoder.rejected},
                       {"late_joints", decoder.late},
                       {"skeletons", counts.skeletons},
                       {"overtaken_skeletons", counts.overtaken},
                       {"published", cost.published},
                       {"hand_frames", cost.hand_frames},
                       {"dropped_hand_frames", cost.dropped_hand_frames},
                       {"advice", tracker.Advice()},
                       {"people", ordered_json::array()}};
  for (const auto& [user, person] : counts.people) {
    const auto of = [&verdicts = person.verdicts](Verdict verdict) {
      return verdicts[static_cast<std::size_t>(verdict)];
    };
    json["people"].push_back({{"user", user},
                              {"dialect", NameOf(person.dialect)},
                              {"skeletons", person.skeletons},
                              {"joints", person.joints},
                              {"inferred_joints", person.inferred},
                              {"absent_joints", of(Verdict::kAbsent)},
                              {"bone_rejected", of(Verdict::kBone)},
                              {"speed_rejected", of(Verdict::kSpeed)},
                              {"fault_rejected", of(Verdict::kFault)},
                              {"advice", tracker.AdviceOf(user)}});
  }
  if (const auto& camera = tracker.camera()) {
    json["camera"] = {{"x_m", camera->p_W_m.x()},
                      {"y_m", camera->p_W_m.y()},
                      {"z_m", camera->p_W_m.z()},
                      {"yaw_deg", RadiansToDegrees(camera->yaw_rad)},
                      {"pitch_deg", RadiansToDegrees(camera->pitch_rad)},
                      {"roll_deg", RadiansToDegrees(camera->roll_rad)}};
  }
  return json;
}

ordered_json ToJson(const WebCounts& web) {
  return {{"pages", web.pages},
          {"frames", web.frames},
          {"found", web.found},
          {"packets", web.packets},
          {"refused", web.refused}};
}

std::string ToText(const ordered_json& json) {
  std::string text = json["packets"].dump() + " packets, " + json["skeletons"].dump() +
                     " skeletons, " + json["hand_frames"].dump() + " frames of hands sent\n";
  if (const auto advice = json["advice"].get<std::string>(); !advice.empty()) text += advice + "\n";
  for (const auto& person : json["people"]) {
    text += "person " + person["user"].dump() + " (" + person["dialect"].get<std::string>() +
            "): " + person["skeletons"].dump() + " skeletons, " + person["joints"].dump() +
            " joints, " + person["bone_rejected"].dump() + " rejected by bone length, " +
            person["speed_rejected"].dump() + " by speed";
    if (const auto advice = person["advice"].get<std::string>(); !advice.empty())
      text += "; " + advice;
    text += "\n";
  }
  return text;
}

}  // namespace footing::skeleton
