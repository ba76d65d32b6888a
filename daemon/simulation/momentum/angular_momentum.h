#pragma once

#include <array>

#include <Eigen/Core>

#include "daemon/simulation/momentum/contact_loads.h"

namespace footing::momentum {

/// When the paper's rule takes velocity or momentum away: the rate has been near zero for a while.
struct DecayRule {
  bool enabled = true;     ///< Off: the ablation that shows what one outlier does.
  double near_zero = 0.1;  ///< Limit of the rate's size: m/s² or N m.
  double after_s = 0.05;   ///< "more than 0.05 second" (section 4.1).
  double fades_s = 0.5;    ///< From then on it decays with this time constant, at any frame rate.
};

/// The rule over time. A plain value.
class Decay {
 public:
  explicit Decay(const DecayRule& rule) : rule_(rule) {}

  /// One frame with a rate of this size: the share of velocity or momentum that is left after it.
  double Advance(double rate, double step_s);

 private:
  DecayRule rule_;
  double near_zero_s_ = 0;
};

/// Height of the centre of mass by equation (2): double integration of the filtered load with the
/// velocity's decay (section 4.1). F_y of equation (2) is the net force: the weight is taken off.
/// A plain value.
class PaperVertical {
 public:
  PaperVertical(const DecayRule& rule, const LoadFilter::Config& filter, double mass_kg,
                double height_m)
      : decay_(rule), load_(filter), mass_kg_(mass_kg), height_m_(height_m) {}

  void Advance(double total_load_n, double step_s);

  double height_m() const { return height_m_; }
  double velocity_mps() const { return velocity_mps_; }
  double acceleration_mps2() const { return acceleration_mps2_; }
  /// Variances of height (m²) and velocity (m²/s²) by the load's variance alone; the mass's error
  /// is not in them.
  double height_variance_m2() const { return variance_m2_; }
  double velocity_variance_m2ps2() const { return velocity_variance_; }

 private:
  Decay decay_;
  LoadFilter load_;
  double mass_kg_;
  double height_m_;
  double velocity_mps_ = 0;
  double acceleration_mps2_ = 0;
  double variance_m2_ = 0;
  double covariance_ = 0;
  double velocity_variance_ = 0;
};

/// Rate of the angular momentum about C by equation (3): sum over the feet of (p - c) x F. The
/// vertical force is measured; the horizontal force is m c'' shared by the loads, since nothing
/// measures it. N m, in W.
Eigen::Vector3d AngularMomentumRate(const std::array<Pressure, kFeet>& feet,
                                    const Eigen::Vector3d& p_WC_m, const Eigen::Vector2d& a_mps2,
                                    double mass_kg);

/// Its integral with the paper's decay (section 4.3). A plain value.
class AngularMomentum {
 public:
  explicit AngularMomentum(const DecayRule& rule) : decay_(rule) {}

  void Advance(const Eigen::Vector3d& rate_nm, double rate_variance_n2m2, double step_s);

  const Eigen::Vector3d& value() const { return value_; }
  double variance() const { return variance_; }

 private:
  Decay decay_;
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();
  double variance_ = 0;
};

}  // namespace footing::momentum
