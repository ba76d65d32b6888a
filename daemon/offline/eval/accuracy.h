#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

namespace footing::eval {

/// Errors of the features on synthetic periodic motion (0.5 to 4.5 Hz, peaks from 4 m/s², 8-bit
/// counts, the real sensor's noise, 100 Hz), free and clipped at +-3 g, beside the bars.
nlohmann::json MeasureAccuracy(int trials, std::uint64_t seed);

}  // namespace footing::eval
