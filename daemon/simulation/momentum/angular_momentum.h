#pragma once

#include <Eigen/Core>
#include <array>

#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/paper_vertical.h"

namespace footing::momentum {

/// Rate of the angular momentum about C by equation (3): sum over the feet of (p - c) x F. The
/// vertical force is measured; the horizontal force is m c'' shared by the loads, since nothing
/// measures it. N m, in W.
Eigen::Vector3d AngularMomentumRate(const std::array<Pressure, kFeet>& feet,
                                    const Eigen::Vector3d& p_WC_m, const Eigen::Vector2d& a_mps2,
                                    double mass_kg);

/// Its integral with the paper's decay (section 4.3). A plain value.
class AngularMomentum {
 public:
  explicit AngularMomentum(const DecayRule& rule) : rule_(rule) {}

  void Advance(const Eigen::Vector3d& rate_nm, double rate_variance_n2m2, double step_s);

  const Eigen::Vector3d& value() const { return value_; }
  double variance() const { return variance_; }

 private:
  DecayRule rule_;
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();
  double variance_ = 0;
  double near_zero_s_ = 0;
};

}  // namespace footing::momentum
