#include "daemon/simulation/momentum/paper_estimator.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::momentum {

void PaperFoot::Target(const Eigen::Vector3d& p_m) {
  from_m_ = place_m_;
  to_m_ = p_m;
  since_target_s_ = 0;
}

void PaperFoot::Advance(const Pressure& pressure, double step_s) {
  contact_ = pressure.cop_valid && pressure.total_n > config_.contact_n;
  since_target_s_ += step_s;
  if (!contact_) {
    zero_s_ += step_s;
    static_s_ = 0;
    had_cop_ = false;
    if (!lifted_ && zero_s_ >= config_.zero_after_s) {
      lifted_ = true;
      Target(to_m_ + config_.lift_m * Eigen::Vector3d::UnitZ());
    }
  } else {
    zero_s_ = 0;
    const double speed =
        had_cop_ ? (pressure.p_WP_m - last_cop_m_).norm() / step_s : 2 * config_.static_mps;
    static_s_ = speed < config_.static_mps ? static_s_ + step_s : 0;
    last_cop_m_ = pressure.p_WP_m;
    had_cop_ = true;
    if (lifted_) {
      lifted_ = false;
      Target(pressure.p_WP_m);
    } else if (since_target_s_ < config_.landing_s || static_s_ >= config_.static_after_s) {
      // A landing goes on to where the COP settles: the first load is on the heel or the ball.
      to_m_ = pressure.p_WP_m;
    }
  }
  const double share = std::min(1.0, since_target_s_ / config_.landing_s);
  place_m_ = from_m_ + share * (to_m_ - from_m_);
}

namespace {

// The COP stands for the COM in the variance when nobody predicts it (facts: 2 to 7 cm).
constexpr double kPredictedSpreadM = 0.04;
constexpr double kPaperLeastCopN = 20;

}  // namespace

PaperEstimator::PaperEstimator(const PaperConfig& config, const Subject& subject, const TPose& pose,
                               double step_s)
    : config_(config),
      pose_(pose),
      step_s_(step_s),
      vertical_(config.vertical, config.load_filter, pose.mass_kg, subject.com_height_m),
      angular_(config.angular),
      feet_{PaperFoot(config.foot, pose.p_WP_m[0]), PaperFoot(config.foot, pose.p_WP_m[1])},
      loads_{LoadFilter(config.load_filter), LoadFilter(config.load_filter)} {
  estimate_.p_WC_m << pose.cop_m.x(), pose.cop_m.y(), subject.com_height_m;
}

const Estimate& PaperEstimator::Advance(const ContactLoads& loads,
                                        const std::optional<Eigen::Vector2d>& horizontal_com_m) {
  estimate_.time_s = loads.time_s;
  if (!IsFinite(loads)) {
    estimate_.valid = false;
    return estimate_;
  }
  estimate_.valid = loads.feet[0].valid && loads.feet[1].valid;
  const Pressure both = PressureOf(loads, kPaperLeastCopN);
  if (estimate_.valid) vertical_.Advance(both.total_n, step_s_);

  Eigen::Vector2d com = estimate_.p_WC_m.head<2>();
  if (horizontal_com_m && horizontal_com_m->allFinite()) {
    com = *horizontal_com_m;
  } else if (both.cop_valid) {
    com = both.p_WP_m.head<2>();
  }
  com_m_ = {frames_ > 0 ? com_m_[1] : com, frames_ > 0 ? com_m_[2] : com, com};
  ++frames_;
  const Eigen::Vector2d velocity = (com_m_[2] - com_m_[1]) / step_s_;
  const Eigen::Vector2d acceleration =
      (com_m_[2] - 2 * com_m_[1] + com_m_[0]) / (step_s_ * step_s_);

  estimate_.p_WC_m << com.x(), com.y(), vertical_.height_m();
  estimate_.v_WC_mps << velocity.x(), velocity.y(), vertical_.velocity_mps();
  estimate_.a_WC_mps2 << acceleration.x(), acceleration.y(), vertical_.acceleration_mps2();
  const double spread2 = kPredictedSpreadM * kPredictedSpreadM;
  estimate_.position_variance_m2 << spread2, spread2, vertical_.height_variance_m2();
  estimate_.velocity_variance_m2ps2 << spread2 / (step_s_ * step_s_), spread2 / (step_s_ * step_s_),
      vertical_.velocity_variance_m2ps2();

  std::array<Pressure, kFeet> pressures;
  for (std::size_t f = 0; f < kFeet; ++f) {
    pressures[f] = PressureOf(loads.feet[f], kPaperLeastCopN);
    FootEstimate& foot = estimate_.feet[f];
    if (loads.feet[f].valid) {
      feet_[f].Advance(pressures[f], step_s_);
      pressures[f].total_n = loads_[f].Advance(pressures[f].total_n);
    }
    foot.contact = feet_[f].contact();
    foot.valid = true;
    foot.load_n = pressures[f].total_n;
    foot.cop_valid = pressures[f].cop_valid;
    foot.p_WP_m = pressures[f].p_WP_m;
    foot.p_WF_m = feet_[f].position_m();
    foot.airborne_s = feet_[f].airborne_s();
    foot.variance_m2.setConstant(spread2);
  }
  const Eigen::Vector3d rate =
      AngularMomentumRate(pressures, estimate_.p_WC_m, acceleration, pose_.mass_kg);
  const double arm_error = both.total_n * kPredictedSpreadM;
  angular_.Advance(rate, arm_error * arm_error, step_s_);
  estimate_.angular_momentum_rate_nm = rate;
  estimate_.angular_momentum_kgm2ps = angular_.value();
  estimate_.angular_momentum_variance.setConstant(angular_.variance());
  return estimate_;
}

}  // namespace footing::momentum
