#pragma once

#include <Eigen/Core>
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

/// What the paper tunes: the servos' spring and damper coefficients, the constants of equations
/// (1) and (2), and the landing length.
std::vector<Dimension> DimensionsOf(stream::Gait gait);

/// The gains at a point, 0 being `start`; kept within what a table may say.
gait::Gains GainsAt(const gait::Gains& start, const std::vector<Dimension>& dimensions,
                    const Eigen::VectorXd& point);

}  // namespace footing::tune
