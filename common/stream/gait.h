#pragma once

#include <cstddef>

#include "common/stream/character.h"

namespace footing::stream {

/// A gait's place in kGaits, which what has a place for each gait is as long as; kUnspecified has
/// the first.
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

}  // namespace footing::stream
