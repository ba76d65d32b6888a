#include "daemon/simulation/gait/phase.h"

#include <algorithm>

#include "common/base/result.h"

namespace footing::gait {
namespace {

template <typename Arrows, typename Phase, typename Cues>
Phase Follow(const Arrows& arrows, Phase phase, const Cues& cues) {
  for (const auto& arrow : arrows) {
    if (arrow.from == phase && cues.*arrow.cue) return arrow.to;
  }
  return phase;
}

/// A phase's name as one word of a diagram.
template <typename Phase>
std::string Word(Phase phase) {
  std::string word = Name(phase);
  std::replace(word.begin(), word.end(), ' ', '_');
  return word;
}

template <typename Arrows>
std::string Draw(const Arrows& arrows) {
  std::string text = "stateDiagram-v2\n";
  for (const auto& arrow : arrows) {
    text += "  " + Word(arrow.from) + " --> " + Word(arrow.to) + ": " + arrow.when + "\n";
  }
  return text;
}

}  // namespace

const char* Name(WalkingPhase phase) {
  switch (phase) {
    case WalkingPhase::kDoubleSupport:
      return "double support";
    case WalkingPhase::kRise:
      return "rise";
    case WalkingPhase::kFall:
      return "fall";
  }
  FOOTING_CHECK(false);
}

const char* Name(RunningPhase phase) {
  switch (phase) {
    case RunningPhase::kUpwardFlight:
      return "upward flight";
    case RunningPhase::kDownwardFlight:
      return "downward flight";
    case RunningPhase::kCompression:
      return "compression";
    case RunningPhase::kExtension:
      return "extension";
  }
  FOOTING_CHECK(false);
}

WalkingPhase Next(WalkingPhase phase, const WalkingCues& cues) {
  return Follow(kWalkingArrows, phase, cues);
}

RunningPhase Next(RunningPhase phase, const RunningCues& cues) {
  return Follow(kRunningArrows, phase, cues);
}

std::string DrawWalkingMachine() { return Draw(kWalkingArrows); }
std::string DrawRunningMachine() { return Draw(kRunningArrows); }

}  // namespace footing::gait
