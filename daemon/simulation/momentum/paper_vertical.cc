#include "daemon/simulation/momentum/paper_vertical.h"

#include <cmath>

#include "common/base/units.h"

namespace footing::momentum {

void PaperVertical::Advance(double total_load_n, double step_s) {
  const double h = step_s;
  acceleration_mps2_ = load_.Advance(total_load_n) / mass_kg_ - kStandardGravityMps2;
  height_m_ += velocity_mps_ * h + acceleration_mps2_ * h * h;
  velocity_mps_ += acceleration_mps2_ * h;
  const double q = load_.variance_n2() / (mass_kg_ * mass_kg_) * h * h;
  variance_m2_ += 2 * covariance_ * h + velocity_variance_ * h * h + q * h * h;
  covariance_ += velocity_variance_ * h + q * h;
  velocity_variance_ += q;

  near_zero_s_ = std::abs(acceleration_mps2_) < rule_.near_zero ? near_zero_s_ + h : 0;
  if (!rule_.enabled || near_zero_s_ < rule_.after_s) return;
  const double keep = rule_.keep_per_frame;
  velocity_mps_ *= keep;
  covariance_ *= keep;
  velocity_variance_ *= keep * keep;
}

}  // namespace footing::momentum
