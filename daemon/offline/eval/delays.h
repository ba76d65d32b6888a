#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

namespace footing::eval {

/// Delays from a change of motion to the right feature, which then stays right to the end of the
/// stretch: start, stop, 1 Hz to 3 Hz and back, out of phase to in phase and back, beside the bars.
nlohmann::json MeasureDelays(int trials, std::uint64_t seed);

}  // namespace footing::eval
