#pragma once

#include <vector>

#include "daemon/simulation/gait/gain_table.h"

namespace footing::tune {

/// One gain that is searched over; a step of 1 in the search is `scale`: of the logarithm when
/// `relative`, else in the gain's own unit.
struct Dimension {
  const gait::GainField* gain;
  double scale;
  bool relative;
};

/// A dimension by the name of its gain, which must exist.
struct DimensionRow {
  const char* gain;
  double scale;
  bool relative = true;
};

/// Adds the dimensions of these rows.
void AddDimensions(const std::vector<DimensionRow>& rows, std::vector<Dimension>& dimensions);

}  // namespace footing::tune
