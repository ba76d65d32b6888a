#pragma once

#include <cstdint>
#include <vector>

#include "common/base/result.h"
#include "daemon/simulation/engine/engine.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::eval {

/// How far a second run agrees with the recording. Nothing is rounded before the comparison.
struct FeaturesReplay {
  std::uint64_t ticks = 0;
  std::uint64_t compared = 0;  ///< Rigs' features.
  std::uint64_t equal = 0;
  std::uint64_t first_difference_sequence = 0;  ///< 0: none.
};

/// The engine of footing-sim, run a second time.
struct EngineReplay {
  std::uint64_t frames = 0;
  std::uint64_t equal = 0;
  std::uint64_t first_difference_step = 0;  ///< 0: none.
  std::uint64_t last_step = 0;
  std::uint64_t state_hash = 0;  ///< State hash of the second run after its last step.
};

/// InvalidData when the first recorded frame is too late for the engine's first inputs to be in the
/// recording.
Result<void> CheckFirstStep(std::uint64_t first_step);

/// The first effective config of a server's ticks; an empty one where it published none.
v1::EffectiveConfig ConfigOf(const std::vector<v1::Tick>& ticks);

/// Feeds the raw reports of footingd's ticks to the same code that published them.
FeaturesReplay ReplayFeatures(const std::vector<v1::Tick>& ticks);

/// Data files and settings to replay footing-sim with.
struct BipedReplayOptions {
  engine::EngineTexts texts;    ///< The data files.
  engine::EngineConfig config;  ///< With the first interface.
  bool named_track = false;     ///< The texts' track takes the place of the recorded first one.
  std::string data_folder;  ///< Where the tables of later interfaces are; empty: the built-in ones.
};

/// Feeds the applied inputs of footing-sim's ticks to a new engine, on the recorded tracks.
/// InvalidData when the recording does not begin with the simulation's first step, or lacks a whole
/// track and none is named.
Result<EngineReplay> ReplayBiped(const std::vector<v1::Tick>& ticks,
                                 const BipedReplayOptions& options);

}  // namespace footing::eval
