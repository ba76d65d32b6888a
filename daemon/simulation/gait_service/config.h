#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/runtime/config.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/mapping/any_interface.h"
#include "daemon/simulation/serving/simulation_thread.h"
#include "footing/v1/character.pb.h"

namespace footing::gait_service {

/// Settings of the gait engine's service.
struct Config {
  std::string interface = "wrist";
  std::string turn_by = "head";     ///< For the interface leg: head, feet or trunk.
  bool camera_roll = false;         ///< Likewise: the picture follows the head.
  bool boards_may_be_left = false;  ///< For the interface boards: both feet may leave them.
  std::string gaits = "best";       ///< Controllers of the gaits: best or paper.
  std::string mapping_table;        ///< Path, of the interface; empty: the built-in one.
  std::string track = "endless";    ///< Name of a built-in track, or a path.
  double frame_rate_hz = 100;       ///< CharacterFrames a second.
  double features_timeout_s = 0.5;
  double fall_shown_s = 0.7;
  double put_back_distance_m = 3;

  void Bind(config::Binder& binder);
};

/// Usage error that lists what there is when the interface or what turns is unknown.
Result<void> Check(const Config& config);

/// The gaits' controllers that an effective config of a recording names; "best" where it has none.
std::string GaitsIn(const v1::EffectiveConfig& message);

/// Source of turns in the interface leg, by its number in the protocol; kUnspecified for others.
stream::TurnSource LegTurnSource(int number);

/// The interface that a checked config asks for.
mapping::InterfaceOptions OptionsOf(const Config& config);

/// Effective settings of the gait engine, as the channel "config" publishes it: so that a recording
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

namespace footing::engine_files {

/// Track, interface and tables whose files ReadTexts reads.
struct Wish {
  std::string track = "plain";  ///< Name of a built-in track, or a path.
  stream::UserInterface interface = stream::UserInterface::kWrist;
  std::string mapping_table = "";  ///< Path of the interface's table; empty: the built-in one.
  std::string data_folder = "";  ///< Where the built-in files are; empty: where FindDataFile looks.
  std::string gaits = "best";    ///< "paper": the gaits as the paper prints them.
  /// Gain tables to read after the built-in ones; a later one replaces what an earlier one had for
  /// its gaits.
  std::vector<std::string> more_gains = {};
};

/// Usage error unless it is best or paper.
Result<void> CheckGaits(const std::string& gaits);

/// The texts of the files that the engine runs on. Fails with one line that names the file.
Result<engine::EngineTexts> ReadTexts(const Wish& wish = {});

/// An interface with its built-in table. Fails with one line that names the file.
Result<mapping::AnyInterface> ReadInterface(const mapping::InterfaceOptions& options,
                                            const std::string& data_folder = "");

}  // namespace footing::engine_files
