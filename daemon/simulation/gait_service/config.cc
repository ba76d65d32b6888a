#include "daemon/simulation/gait_service/config.h"

#include <utility>

#include "common/base/json_text.h"
#include "common/model/model.h"
#include "common/runtime/files.h"
#include "common/stream/leg_turn.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/serving/simulation_thread.h"

namespace footing::gait_service {

void Config::Bind(config::Binder& binder) {
  binder.Text("interface", interface,
              "User interface of the gait engine: " + stream::UserInterfaceNames());
  binder.Text("turn_by", turn_by,
              "Body part that steers with the interface leg: head, feet or trunk");
  binder.Flag("camera_roll", camera_roll, "Roll the picture with the head, with the interface leg");
  binder.Flag("boards_may_be_left", boards_may_be_left,
              "Let both feet leave the boards in a jump, with the interface boards; the person may "
              "fall beside a board");
  binder.Text("gaits", gaits,
              "Controllers of the gaits: best, plain without style and foresight, or paper for the "
              "state machines and equations as the gait paper prints them");
  binder.Text("mapping_table", mapping_table,
              "Mapping table of the interface, JSON file, such as one of footing-study ranges "
              "(empty: the built-in one)");
  binder.Text("track", track, "Track of the gait engine: a built-in name, or a JSON file");
  binder.Number("frame_rate_hz", frame_rate_hz, 10, 200, "Rate of character frames, Hz");
  binder.Number("features_timeout_s", features_timeout_s, 0.1, 5,
                "Time without new features after which the character steps in place, s");
  binder.Number("fall_shown_s", fall_shown_s, 0, 10,
                "Time from a failure until the character is put back on its feet, s");
  binder.Number("put_back_distance_m", put_back_distance_m, 0, 20,
                "Distance by which a fallen character is put back along the track, m");
}

Result<void> Check(const Config& config) {
  if (stream::UserInterfaceNamed(config.interface) == stream::UserInterface::kUnspecified) {
    return UsageError("unknown --interface " + config.interface +
                      "; there are: " + stream::UserInterfaceNames());
  }
  if (const auto gaits = engine_files::CheckGaits(config.gaits); !gaits) return gaits.error();
  if (stream::LegTurnSourceNamed(config.turn_by) == stream::TurnSource::kUnspecified) {
    return UsageError("unknown turn_by " + config.turn_by + "; there are: head, feet, trunk");
  }
  return {};
}

stream::TurnSource LegTurnSource(int number) {
  for (const auto source : stream::kLegTurnSources) {
    if (number == static_cast<int>(source)) return source;
  }
  return stream::TurnSource::kUnspecified;
}

mapping::InterfaceOptions OptionsOf(const Config& config) {
  return {.interface = stream::UserInterfaceNamed(config.interface),
          .leg = {.turn_by = stream::LegTurnSourceNamed(config.turn_by),
                  .camera_roll = config.camera_roll},
          .boards_may_be_left = config.boards_may_be_left};
}

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
  for (const engine::GainText& gains : texts.style) {
    json_["sha256"][gains.origin] = HashOf(gains.text);
  }
  if (!texts.choices.text.empty()) {
    json_["sha256"][texts.choices.origin] = HashOf(texts.choices.text);
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

std::string GaitsIn(const v1::EffectiveConfig& message) {
  return text::SettingIn(message.json(), "gaits").value_or("best");
}

}  // namespace footing::gait_service

namespace footing::engine_files {

Result<void> CheckGaits(const std::string& gaits) {
  if (gaits == "best" || gaits == "plain" || gaits == "paper") return {};
  return UsageError("unknown --gaits " + gaits + "; there are: best, plain, paper");
}

Result<engine::EngineTexts> ReadTexts(const Wish& wish) {
  engine::EngineTexts texts;
  auto biped = config::ReadDataFile(engine::kBipedFile, wish.data_folder);
  if (!biped) return biped.error();
  auto mapping_table =
      wish.mapping_table.empty()
          ? config::ReadDataFile(mapping::MappingFileOf(wish.interface), wish.data_folder)
          : config::ReadTextFile(wish.mapping_table);
  if (!mapping_table) return mapping_table.error();
  auto track = config::ReadNamedOrPath(wish.track, "tracks", wish.data_folder);
  if (!track) return track.error();
  // The engine does not know the names of the files.
  if (const auto parsed = terrain::ParseTrack(*track, wish.track); !parsed) return parsed.error();
  if (!wish.mapping_table.empty()) {
    const auto mapped =
        mapping::AnyInterface::Create({.interface = wish.interface}, *mapping_table);
    if (!mapped) {
      return Error{mapped.error().kind,
                   wish.mapping_table + ", in place of " + mapped.error().message};
    }
  }
  texts.biped = std::move(*biped);
  texts.mapping = std::move(*mapping_table);
  texts.track = std::move(*track);
  if (const auto known = CheckGaits(wish.gaits); !known) return known.error();
  std::vector<std::string> tables(engine::kGainFiles.begin(), engine::kGainFiles.end());
  if (wish.gaits == "paper") {
    tables.insert(tables.end(), engine::kPaperGainFiles.begin(), engine::kPaperGainFiles.end());
  }
  for (const std::string& name : tables) {
    auto gains = config::ReadDataFile(name, wish.data_folder);
    if (!gains) return gains.error();
    texts.gains.push_back({name, std::move(*gains)});
  }
  for (const std::string& path : wish.more_gains) {
    auto gains = config::ReadTextFile(path);
    if (!gains) return gains.error();
    texts.gains.push_back({path, std::move(*gains)});
  }
  const bool styled = wish.gaits == "best" && wish.more_gains.empty();
  if (!styled) return texts;
  for (const char* name : engine::kStyleFiles) {
    auto gains = config::ReadDataFile(name, wish.data_folder);
    if (!gains) return gains.error();
    texts.style.push_back({name, std::move(*gains)});
  }
  auto choices = config::ReadDataFile(engine::kChoicesFile, wish.data_folder);
  if (!choices) return choices.error();
  texts.choices = {engine::kChoicesFile, std::move(*choices)};
  return texts;
}

Result<mapping::AnyInterface> ReadInterface(const mapping::InterfaceOptions& options,
                                            const std::string& data_folder) {
  const auto table = config::ReadDataFile(mapping::MappingFileOf(options.interface), data_folder);
  if (!table) return table.error();
  return mapping::AnyInterface::Create(options, *table);
}

}  // namespace footing::engine_files
