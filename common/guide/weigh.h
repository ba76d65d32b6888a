#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/guide/recent.h"

namespace footing::guide {

inline constexpr double kWeighForS = 3;
inline constexpr double kLeastMassKg = 10;
inline constexpr double kMostMassKg = 200;

struct Weight {
  bool done = false;    ///< Quiet enough and plausible; else wait, or say what `note` says.
  bool passed = false;  ///< And within 3 % or 2 kg of the mass that was given, if any.
  double mass_kg = 0;
  double sd_kg = 0;  ///< The residual.
  std::string note;
};

/// The person on all boards together, standing still for kWeighForS. Quiet is a standard deviation
/// under 1.5 % of the weight: standing people sway by 0.4 % (0.18 kg of 46 kg on a real board).
Weight Weigh(const std::vector<Load>& boards, std::optional<double> given_kg);

}  // namespace footing::guide
