#include "daemon/simulation/momentum/angular_momentum.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/base/units.h"

namespace footing::momentum {

double Decay::Advance(double rate, double step_s) {
  near_zero_s_ = std::abs(rate) < rule_.near_zero ? near_zero_s_ + step_s : 0;
  if (!rule_.enabled || near_zero_s_ < rule_.after_s) return 1;
  return std::exp(-step_s / rule_.fades_s);
}

void PaperVertical::Advance(double total_load_n, double step_s) {
  const double h = step_s;
  acceleration_mps2_ = load_.Advance(total_load_n) / mass_kg_ - kStandardGravityMps2;
  height_m_ += velocity_mps_ * h + acceleration_mps2_ * h * h;
  velocity_mps_ += acceleration_mps2_ * h;
  const double q = load_.variance_n2() / (mass_kg_ * mass_kg_) * h * h;
  variance_m2_ += 2 * covariance_ * h + velocity_variance_ * h * h + q * h * h;
  covariance_ += velocity_variance_ * h + q * h;
  velocity_variance_ += q;

  const double keep = decay_.Advance(acceleration_mps2_, h);
  velocity_mps_ *= keep;
  covariance_ *= keep;
  velocity_variance_ *= keep * keep;
}

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
  const double keep = decay_.Advance(rate_nm.cwiseAbs().maxCoeff(), step_s);
  value_ *= keep;
  variance_ *= keep * keep;
}

}  // namespace footing::momentum
