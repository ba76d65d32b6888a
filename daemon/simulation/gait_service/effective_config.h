#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/gait_service/config.h"
#include "daemon/simulation/serving/config.h"
#include "footing/v1/character.pb.h"

namespace footing::gait_service {

/// What the gait engine really runs with, as the channel "config" publishes it: so that a recording
/// can be understood when program, tables and gains have changed. docs/protocol.md lists its keys.
class EffectiveConfig {
 public:
  EffectiveConfig(const serving::Config& common, const Config& config,
                  const engine::EngineTexts& texts, const engine::EngineConfig& engine);

  /// The interface in force, with the number of its change and the text of its table, which has
  /// been read; `table_by` says who gave the table.
  void SetInterface(std::uint64_t number, const mapping::InterfaceOptions& options,
                    const std::string& table, const std::string& table_by);

  v1::EffectiveConfig Message() const;

 private:
  nlohmann::ordered_json json_;
};

inline constexpr const char* kBuiltInTable = "built-in";

/// The table of the interface of that number in the recorded messages of the channel; empty where
/// they do not have it.
std::string TableIn(const v1::EffectiveConfig& message, std::uint64_t interface_number);

}  // namespace footing::gait_service
