#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace footing::stream {

enum class Gait { kUnspecified = 0, kStep = 1, kWalk = 2, kRun = 3, kJump = 4 };

/// All gaits, in the order of their numbers: what has a place for each gait is as long as this.
inline constexpr std::array kGaits{Gait::kStep, Gait::kWalk, Gait::kRun, Gait::kJump};

/// A gait's place in kGaits; kUnspecified has the first.
constexpr std::size_t IndexOf(Gait gait) {
  for (std::size_t i = 0; i < kGaits.size(); ++i) {
    if (kGaits[i] == gait) return i;
  }
  return 0;
}

/// The gait of a number of the protocol; kUnspecified for one that is not known.
constexpr Gait GaitNumbered(int number) {
  for (const Gait gait : kGaits) {
    if (static_cast<int>(gait) == number) return gait;
  }
  return Gait::kUnspecified;
}

/// "step", "walk", "run", "jump".
const char* Name(Gait gait);
/// The gait of that name; kUnspecified when there is none.
Gait GaitNamed(const std::string& name);
/// "step, walk, run, jump": for errors.
std::string GaitNames();

}  // namespace footing::stream
