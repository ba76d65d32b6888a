#include "common/stream/trial.h"

#include <algorithm>

#include "common/stream/track.h"

namespace footing::stream {

std::uint64_t* MutableCountOf(FailureCause cause, FailureCounts& counts) {
  switch (cause) {
    case FailureCause::kSimulation:
      return &counts.simulation;
    case FailureCause::kCurve:
      return &counts.curve;
    case FailureCause::kJump:
      return &counts.jump;
    case FailureCause::kStraightness:
      return &counts.straightness;
    case FailureCause::kTransition:
      return &counts.transition;
    case FailureCause::kUnspecified:
      return nullptr;
  }
  return nullptr;
}

std::uint64_t CountOf(FailureCause cause, const FailureCounts& counts) {
  FailureCounts copy = counts;
  const std::uint64_t* count = MutableCountOf(cause, copy);
  return count == nullptr ? 0 : *count;
}

std::uint64_t Total(const FailureCounts& counts) {
  std::uint64_t total = 0;
  for (const FailureCause cause : kFailureCauses) total += CountOf(cause, counts);
  return total;
}

FailureCounts Without(FailureCounts counts, const FailureCounts& others) {
  for (const FailureCause cause : kFailureCauses) {
    std::uint64_t& count = *MutableCountOf(cause, counts);
    count -= std::min(count, CountOf(cause, others));
  }
  return counts;
}

std::string InstructionFor(Gait before, Gait after) {
  const std::string first = before == Gait::kUnspecified ? "" : std::string(Name(before)) + " ";
  return first + "to the line, then " + (after == Gait::kStep ? "stop" : Name(after));
}

}  // namespace footing::stream
