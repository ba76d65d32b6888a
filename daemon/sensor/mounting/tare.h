#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/board/plate.h"

namespace footing::tare {

struct TareConfig {
  /// An empty board stays within this; a person on it does not. Its own noise is 0.1 kg (recorded).
  double most_sd_n = 3;
  /// Between the means of the first and the last third.
  double most_trend_n = 3;
  double most_total_n = 98.0665;  ///< 10 kg.
  double least_rate_hz = 20;
  double longest_gap_s = 0.25;
};

struct TareSample {
  std::int64_t sampled_ns = 0;
  board::CornerForces forces;  ///< As measured, before any tare.
};

struct Tare {
  bool ok = false;
  std::string problem;         ///< Why it was refused.
  board::CornerForces offset;  ///< To take off every sample.
  double residual_n = 0;       ///< Standard deviation of the total over the window.
};

/// The mean of the samples, which must cover `window_s`; refused when the load moves, when it is
/// too heavy for an empty board, and when there are too few samples.
Tare SolveTare(std::span<const TareSample> samples, double window_s, const TareConfig& config = {});

}  // namespace footing::tare
