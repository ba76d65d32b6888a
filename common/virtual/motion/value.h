#pragma once

#include <cmath>
#include <optional>
#include <string_view>

#include "common/base/number.h"

namespace footing::motion {

/// Beyond any number of a motion file in any unit; squares and sums of such numbers stay finite.
inline constexpr double kGreatestValue = 1e9;

/// A number of a motion file: finite, and no greater than that.
inline std::optional<double> ToValue(std::string_view word) {
  const auto number = text::ToNumber(word);
  return number && std::abs(*number) <= kGreatestValue ? number : std::nullopt;
}

}  // namespace footing::motion
