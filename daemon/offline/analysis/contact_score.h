#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "daemon/simulation/momentum/contact_loads.h"

namespace footing::eval {

inline constexpr double kContactN = 20;          ///< A foot with more load is in contact.
inline constexpr double kSettledContactS = 0.3;  ///< From a landing to its evaluation.

/// Estimated contact of both feet against the true one.
struct ContactScore {
  std::size_t both = 0, only_estimated = 0, only_true = 0;
  std::size_t landings = 0;
  double delay_s = 0, worst_delay_s = 0;  ///< From landings to when they were reported.
  std::array<double, momentum::kFeet> true_since_s{};  ///< Minimum duration of true contact.

  void Add(std::size_t foot, bool truth, bool estimated, double step_s) {
    both += truth && estimated ? 1 : 0;
    only_estimated += !truth && estimated ? 1 : 0;
    only_true += truth && !estimated ? 1 : 0;
    true_since_s[foot] = truth ? (was_[foot] ? true_since_s[foot] + step_s : 0) : 0;
    if (truth && !was_[foot]) seen_[foot] = false;
    if (truth && estimated && !seen_[foot]) {
      seen_[foot] = true;
      ++landings;
      delay_s += true_since_s[foot];
      worst_delay_s = std::max(worst_delay_s, true_since_s[foot]);
    }
    was_[foot] = truth;
  }
  double F1() const {
    const auto twice = 2.0 * static_cast<double>(both);
    return both > 0 ? twice / (twice + static_cast<double>(only_estimated + only_true)) : 0;
  }
  double mean_delay_s() const { return landings > 0 ? delay_s / static_cast<double>(landings) : 0; }

 private:
  std::array<bool, momentum::kFeet> was_{true, true};
  std::array<bool, momentum::kFeet> seen_{true, true};
};

}  // namespace footing::eval
