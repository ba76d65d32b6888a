#pragma once

#include <cmath>

#include "common/base/units.h"

namespace footing {

/// `angle_rad` plus the whole turns that bring it nearest to `reference_rad`; both finite.
inline double NearestTurn(double angle_rad, double reference_rad) {
  return angle_rad + 2 * kPi * std::round((reference_rad - angle_rad) / (2 * kPi));
}

}  // namespace footing
