#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>

#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/sample_grid.h"

namespace footing::features {

/// How the right controller lies in its hand against the left one: rotated about the front, which
/// points along a forearm. Ours: equation (4) compares the sensors' own axes, but of controllers
/// that are rotated against each other by a right angle these have only the fronts in common, along
/// which hands that alternate and hands together move alike. Gravity shows the rotation, since both
/// forearms point the same way on the mean of a cycle. A plain value.
struct PairGrip {
  /// Gravity across the fronts, left times the conjugate of right, as x + iz: its angle is the
  /// rotation from right to left. Mean over what was seen.
  std::complex<double> turn_m2ps4 = 0;
  double seen_s = 0;                    ///< For how long, at most the horizon; 0: nothing is known.
  std::complex<double> rest_m2ps4 = 0;  ///< The same of hands at rest,
  double rest_s = 0;                    ///< and for how long.

  /// From the right one's frame S to one that lies in its hand as the left one does.
  Eigen::Matrix3d FromRight() const;
};

/// Whether the two newest cycles of `steps` grid points have the same mean across the front, so
/// that it is gravity: while a swing changes, a share of it stays in its mean.
bool MeanRepeats(const SampleGrid& grid, double steps, const GripConfig& config);

/// `elapsed_s` later, with the gravity in S that each shows, m/s²: none while it shows none.
/// `rests`: it is that of hands at rest, which counts only until they have swung.
PairGrip Next(const PairGrip& before, const std::optional<Eigen::Vector3d>& left_mps2,
              const std::optional<Eigen::Vector3d>& right_mps2, bool rests, double elapsed_s,
              const GripConfig& config);

}  // namespace footing::features
