#include "daemon/simulation/gait_service/effective_config.h"

#include "common/model/sha256.h"
#include "daemon/simulation/serving/effective_settings.h"

namespace footing::gait_service {
namespace {

using nlohmann::ordered_json;

std::string HashOf(const std::string& text) { return model::Hex(model::Sha256(text)); }

}  // namespace

EffectiveConfig::EffectiveConfig(const serving::Config& common, const Config& config,
                                 const engine::EngineTexts& texts,
                                 const engine::EngineConfig& engine) {
  json_ = serving::EffectiveSettings(common, "gait", config);
  json_["step_s"] = engine.step_s;
  json_["sha256"] = {{engine::kBipedFile, HashOf(texts.biped)}};
  for (const engine::GainText& gains : texts.gains) {
    json_["sha256"][gains.origin] = HashOf(gains.text);
  }
  SetInterface(0, engine.interface, texts.mapping,
               config.mapping_table.empty() ? kBuiltInTable : config.mapping_table);
}

void EffectiveConfig::SetInterface(std::uint64_t number, const mapping::InterfaceOptions& options,
                                   const std::string& table, const std::string& table_by) {
  const ordered_json values = ordered_json::parse(table, nullptr, false, true);
  const bool table_rolls =
      options.interface == stream::UserInterface::kLeg && values.value("camera_roll", false);
  json_["interface"] = {{"number", number},
                        {"name", stream::Name(options.interface)},
                        {"turn_by", stream::Name(options.leg.turn_by)},
                        {"camera_roll", options.leg.camera_roll || table_rolls},
                        {"boards_may_be_left", options.boards_may_be_left},
                        {"table_by", table_by},
                        {"table_sha256", HashOf(table)},
                        {"table", values}};
}

v1::EffectiveConfig EffectiveConfig::Message() const {
  v1::EffectiveConfig message;
  message.set_json(json_.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  return message;
}

std::string TableIn(const v1::EffectiveConfig& message, std::uint64_t interface_number) {
  const ordered_json json = ordered_json::parse(message.json(), nullptr, false);
  if (!json.is_object() || !json.contains("interface")) return "";
  const ordered_json& interface = json["interface"];
  if (!interface.is_object() || interface.value("number", ordered_json()) != interface_number ||
      !interface.contains("table")) {
    return "";
  }
  return interface["table"].dump();
}

}  // namespace footing::gait_service
