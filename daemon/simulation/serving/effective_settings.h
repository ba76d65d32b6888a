#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "common/runtime/config.h"
#include "daemon/simulation/serving/config.h"

namespace footing::serving {

/// What every engine says on the channel "config": program, version, its name and all settings.
template <typename EngineConfig>
nlohmann::ordered_json EffectiveSettings(Config common, const char* engine, EngineConfig config) {
  config::Binder binder;
  common.Bind(binder);
  config.Bind(binder);
  return {{"program", "footing-sim"},
          {"version", common.version},
          {"engine", engine},
          {"settings", nlohmann::ordered_json::parse(binder.Print())}};
}

}  // namespace footing::serving
