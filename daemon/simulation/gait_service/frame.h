#pragma once

#include <array>
#include <cstdint>

#include "daemon/simulation/engine/engine.h"

namespace footing::gait_service {

/// Engine inputs with where they came from.
struct Inputs {
  engine::EngineInputs engine;
  std::uint64_t sensor_epoch = 0;
  std::uint64_t sensor_sequence = 0;
};

/// Inputs as they took effect: from this step on.
struct Applied {
  std::uint64_t step = 0;
  Inputs inputs;
};

inline constexpr int kMaxApplied = 16;
inline constexpr int kMaxFrameEvents = 32;
inline constexpr int kMaxAdded = 64;

/// What the simulation thread hands over some hundred times a second. Fixed size: filling and
/// moving it allocates nothing.
struct Frame {
  engine::EngineOutput output;
  std::uint64_t overruns = 0;
  std::uint64_t left_out = 0;  ///< Frames that were due and are not published.
  std::array<engine::EngineEvent, kMaxFrameEvents> events;  ///< Since the last frame.
  int event_count = 0;
  std::array<Applied, kMaxApplied> applied;  ///< Since the last frame.
  int applied_count = 0;
  std::array<stream::TrackSegment, kMaxAdded> added;  ///< To the track's end, since the last frame.
  int added_count = 0;
  std::int64_t command_ns = 0;  ///< When the gait command last changed.
  std::int64_t contact_ns = 0;  ///< When its controller took over.
};

}  // namespace footing::gait_service
