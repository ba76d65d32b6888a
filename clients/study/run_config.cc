#include "clients/study/run_config.h"

#include <initializer_list>

namespace footing::study::bundle {
namespace {

using nlohmann::ordered_json;

/// An allow-list: a key that a later footing-sim adds stays out until somebody has checked it.
ordered_json Only(const ordered_json& object, std::initializer_list<const char*> keys) {
  ordered_json kept = ordered_json::object();
  for (const char* key : keys) {
    if (object.is_object() && object.contains(key)) kept[key] = object[key];
  }
  return kept;
}

ordered_json AnonymousTable(ordered_json table) {
  if (!table.is_object() || !table.contains("measured")) return table;
  table["measured"] =
      Only(table["measured"], {"interface", "turn_by", "by", "simulated", "ranges"});
  return table;
}

}  // namespace

ordered_json AnonymousConfig(const std::string& json) {
  const ordered_json config = ordered_json::parse(json, nullptr, /*allow_exceptions=*/false);
  if (!config.is_object()) return nullptr;
  ordered_json kept = Only(config, {"program", "version", "engine", "step_s", "sha256"});
  if (config.contains("settings")) {
    kept["settings"] =
        Only(config["settings"], {"turn_by", "camera_roll", "boards_may_be_left", "frame_rate_hz",
                                  "features_timeout_s", "fall_shown_s", "put_back_distance_m"});
  }
  if (!config.contains("interface")) return kept;
  const ordered_json& interface = config["interface"];
  kept["interface"] = Only(interface, {"name", "turn_by", "camera_roll", "boards_may_be_left"});
  if (interface.is_object() && interface.contains("table")) {
    kept["interface"]["table"] = AnonymousTable(interface["table"]);
  }
  return kept;
}

}  // namespace footing::study::bundle
