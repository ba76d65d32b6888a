#include "daemon/simulation/momentum/angular_momentum.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace footing::momentum {

Eigen::Vector3d AngularMomentumRate(const std::array<Pressure, kFeet>& feet,
                                    const Eigen::Vector3d& p_WC_m, const Eigen::Vector2d& a_mps2,
                                    double mass_kg) {
  double total = 0;
  for (const Pressure& foot : feet)
    if (foot.cop_valid) total += foot.total_n;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  if (total <= 0) return rate;
  for (const Pressure& foot : feet) {
    if (!foot.cop_valid) continue;
    const Eigen::Vector2d shear = mass_kg * foot.total_n / total * a_mps2;
    rate += (foot.p_WP_m - p_WC_m).cross(Eigen::Vector3d(shear.x(), shear.y(), foot.total_n));
  }
  return rate;
}

void AngularMomentum::Advance(const Eigen::Vector3d& rate_nm, double rate_variance_n2m2,
                              double step_s) {
  value_ += rate_nm * step_s;
  variance_ += rate_variance_n2m2 * step_s * step_s;
  near_zero_s_ = rate_nm.cwiseAbs().maxCoeff() < rule_.near_zero ? near_zero_s_ + step_s : 0;
  if (!rule_.enabled || near_zero_s_ < rule_.after_s) return;
  value_ *= rule_.keep_per_frame;
  variance_ *= rule_.keep_per_frame * rule_.keep_per_frame;
}

}  // namespace footing::momentum
