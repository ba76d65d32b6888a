#pragma once

#include <Eigen/Core>

namespace footing::eval {

/// Joints of a leg, W, m.
struct LegPlaces {
  Eigen::Vector3d hip, knee, ankle;
};

/// Why an estimated knee is off: a knee lies on a circle about the line from hip to ankle.
struct KneeError {
  double turn_rad = 0;    ///< Along that circle, from the truth, by the right-hand rule.
  double unturned_m = 0;  ///< What is left with the knee turned back along it.
};

/// The circle of the truth is moved onto that of the estimate by the shortest rotation of the line.
/// A leg that is straight has no circle: the turn is 0.
KneeError SplitKneeError(const LegPlaces& truth, const LegPlaces& estimate);

}  // namespace footing::eval
