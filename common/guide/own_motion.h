#pragma once

#include <array>
#include <cstddef>

/// Two guided minutes of a person's own motion, from which the pose engine learns how this person
/// moves (docs/pose-live.md). The built-in choreography own_motion performs the same steps at the
/// same times.
namespace footing::guide {

/// One exercise with its prompt.
struct MotionStep {
  const char* name;
  double seconds;
  const char* prompt;
};

inline constexpr std::size_t kMotionSteps = 11;
/// In their order, the T-pose first.
const std::array<MotionStep, kMotionSteps>& OwnMotionSteps();

/// Duration of all steps, s.
double OwnMotionSeconds();

}  // namespace footing::guide
