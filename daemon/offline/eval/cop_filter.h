#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "common/base/result.h"
#include "daemon/offline/analysis/sway.h"

namespace footing::eval {

/// How a COP is resampled and filtered; 0: not.
struct CopFilter {
  double rate_hz = 0;
  double cutoff_hz = 0;  ///< Only at an even rate.
  double window_s = 0;   ///< Of the averages; 0: two intervals of the slower rate.
};

/// The options of a command line, as given; empty ones have the defaults.
struct CopFilterOptions {
  std::string rate;    ///< Hz, or "recorded".
  std::string cutoff;  ///< Hz, or "none".
  double window_s = 0;
};

/// Loads of a board (`corners`) are noisy and sampled unevenly, so their COP is filtered as usual
/// in posturography; a file of COPs is taken as its author filtered it. A usage error says what
/// does not fit together.
Result<CopFilter> CopFilterOf(const CopFilterOptions& words, bool corners);

/// Seconds of all stretches together.
double DurationS(const posturography::Stretches& stretches);

/// Resamples and filters every stretch, and adds to the answer what was done.
Result<void> FilterCop(const CopFilter& filter, posturography::Stretches& stretches,
                       nlohmann::ordered_json& answer);

}  // namespace footing::eval
