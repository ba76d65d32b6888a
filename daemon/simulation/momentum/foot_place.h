#pragma once

#include <Eigen/Core>
#include <array>

#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/momentum/linear_filter.h"

namespace footing::momentum {

/// How a standing foot's centre of pressure wanders about its reference point.
struct FootPlaceConfig {
  double along_spread_m = 0.065;  ///< Along the foot, one standard deviation.
  double across_spread_m = 0.015;
  double ahead_m = 0.025;  ///< People who move press so much further ahead than those who stand.
  double wander_time_s = 0.8;    ///< Correlation time.
  double slip_mps = 0.004;       ///< Growth of the place's deviation in contact, per root second.
  double loosen_mps = 0.001;     ///< Speed at which the bounds by the outline widen.
  double step_spread_m = 0.05;   ///< A new place against the old one.
  double lift_growth_mps = 0.2;  ///< Growth of the deviation in the air.
  double cop_noise_n_m = 1.5;    ///< Noise of the COP times the load.
};

/// Best mode's place of one foot: for each of its two axes a filter of the place and of the COP's
/// wandering. The COP is never outside the sole, so all that it has been since the foot came down
/// bounds the place from both sides: the estimate is the filter's density between these bounds. A
/// plain value.
class FootPlace {
 public:
  FootPlace(const FootShape& shape, const FootPlaceConfig& config = {});

  /// The foot stands with its reference point there.
  void Start(const Eigen::Vector3d& p_WF_m);
  /// `landed`: this is the first frame of a contact.
  void Advance(const Pressure& pressure, bool contact, bool landed, double step_s);

  Eigen::Vector3d position_m() const;
  Eigen::Vector3d variance_m2() const;

 private:
  using Filter = LinearFilter<2, 1>;

  void Unbound();
  void Estimate(std::size_t axis, double loosen_m);

  FootShape shape_;
  FootPlaceConfig config_;
  Eigen::Vector2d along_;
  Eigen::Vector2d across_;
  std::array<Filter, 2> axes_{};          // Along, across; states: place, wandering.
  std::array<double, 2> low_{}, high_{};  // Bounds of the place, of this contact.
  std::array<Moments, 2> estimate_{};
  double height_m_ = 0;
};

}  // namespace footing::momentum
