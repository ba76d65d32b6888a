#include "daemon/simulation/momentum/best_estimator.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/momentum/horizontal_com.h"

namespace footing::momentum {
namespace {

// More than this is unknown.
constexpr double kMostVarianceM2 = 1.0, kMostVarianceM2ps2 = 4.0;
// How far the COM of bodies that step is from where the filters place it, forwards and sideways.
constexpr std::array<double, 2> kSteppedSpreadM{0.15, 0.05};

}  // namespace

HorizontalPrior ForwardPrior() {
  HorizontalPrior prior;
  prior.slow = {0.18, 0.87, 0.38, 0.093};
  prior.rhythmic = {5.2, 5.6, 0.72, 0.030};
  prior.beta = 0.75;
  prior.moment_spread_m = 0.0029;
  prior.moment_time_s = 0.024;
  prior.cop_noise_m = 0.0005;
  prior.spread_factor = 0.65;
  return prior;
}

HorizontalPrior LateralPrior() {
  HorizontalPrior prior;
  prior.slow = {0.37, 2.9, 0.23, 0.35};
  prior.rhythmic = {8.7, 8.2, 0.081, 0.044};
  prior.beta = 1.08;
  prior.moment_spread_m = 0.0079;
  prior.moment_time_s = 0.064;
  prior.cop_noise_m = 0.0006;
  prior.spread_factor = 0.4;
  return prior;
}

PostureError PlainLateralPosture() { return {1.16, 0.12, 0.25, 0.01}; }

BestEstimator::BestEstimator(const BestConfig& config, const Subject& subject, const TPose& pose,
                             double step_s)
    : config_(config),
      com_height_m_(subject.com_height_m),
      pose_(pose),
      step_s_(step_s),
      lag_steps_(std::clamp(static_cast<int>(std::lround(config.lag_s / step_s)), 0,
                            HorizontalCom::kSlots - 1)),
      horizontal_{HorizontalCom(config.forward, {}, pose.mass_kg, step_s),
                  HorizontalCom(config.lateral, config.lateral_posture, pose.mass_kg, step_s)},
      travelling_{
          HorizontalCom(Travelling(config.forward), TravellingPosture(), pose.mass_kg, step_s),
          HorizontalCom(Travelling(config.lateral), TravellingPosture(), pose.mass_kg, step_s)},
      vertical_(pose.mass_kg, step_s, subject.arms_hang_m, pose.cell_noise_n,
                config.height_posture_m) {
  for (HorizontalCom& axis : horizontal_) axis.KeepLag(lag_steps_);
  for (HorizontalCom& axis : travelling_) axis.KeepLag(lag_steps_);
  vertical_.KeepLag(lag_steps_);
  vertical_.Start(pose.mean_loads);
  Begin(0.5 * (pose.p_WP_m[0] + pose.p_WP_m[1]).head<2>());
  estimate_.p_WC_m << pose.cop_m.x(), pose.cop_m.y(), com_height_m_;
}

void BestEstimator::Begin(const Eigen::Vector2d& centre_m) {
  for (std::size_t i = 0; i < 2; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    horizontal_[i].Start(pose_.cop_m(axis), centre_m(axis));
    travelling_[i].Start(pose_.cop_m(axis), centre_m(axis));
  }
  estimate_.angular_momentum_kgm2ps.setZero();
  estimate_.angular_momentum_variance.setZero();
}

const Estimate& BestEstimator::Advance(const ContactFrame& contacts,
                                       const std::optional<PostureCom>& posture) {
  if (contacts.returned) Begin(contacts.centre_m());
  if (contacts.returned || (contacts.landed && !vertical_.CanLand())) LandElsewhere(contacts);
  AdvanceCom(contacts);
  if (!contacts.gap) AdvanceAngular(contacts);
  const bool sees_posture = posture && contacts.valid && std::isfinite(posture->lateral_W_m) &&
                            posture->likely_W_m.allFinite();
  if (sees_posture) SeePosture(*posture);
  Report(contacts, sees_posture);
  return estimate_;
}

void BestEstimator::LandElsewhere(const ContactFrame& contacts) {
  const Eigen::Vector2d centre = contacts.centre_m();
  for (int i = 0; i < 2; ++i) {
    horizontal_[static_cast<std::size_t>(i)].Land(contacts.both.p_WP_m(i), centre(i));
    travelling_[static_cast<std::size_t>(i)].Land(contacts.both.p_WP_m(i), centre(i));
  }
  if (contacts.was_silent) {
    vertical_.Reappear();
  } else {
    vertical_.Land();
  }
  estimate_.angular_momentum_kgm2ps.setZero();
  ++estimate_.resets;
}

void BestEstimator::AdvanceCom(const ContactFrame& contacts) {
  if (contacts.valid) {
    vertical_.Advance(contacts.groups);
  } else {
    vertical_.Coast();
  }
  const Eigen::Vector2d centre = contacts.centre_m();
  // The cells' COP is only a part of that of a body that stands on something else, too.
  const bool seen = contacts.valid && contacts.whole_weight;
  for (int i = 0; i < 2; ++i) {
    HorizontalInput input;
    input.cop_valid = seen && contacts.both.cop_valid;
    input.cop_m = contacts.both.p_WP_m(i);
    // Without a measurement the prior alone goes on: no flight is meant.
    input.load_n = seen ? contacts.both.total_n : pose_.mass_kg * kStandardGravityMps2;
    input.com_height_m = com_height_m_ + vertical_.Height(0).mean;
    input.centre_m = centre(i);
    horizontal_[static_cast<std::size_t>(i)].Advance(input);
    travelling_[static_cast<std::size_t>(i)].Advance(input);
  }
}

void BestEstimator::SeePosture(const PostureCom& posture) {
  horizontal_[1].SeePosture(posture.lateral_W_m);
  travelling_[0].SeePosture(posture.likely_W_m.x());
  travelling_[1].SeePosture(posture.likely_W_m.y());
  vertical_.SeePosture(posture.likely_W_m.z() - com_height_m_);
}

BestEstimator::Place BestEstimator::PlaceOn(std::size_t axis, bool sees_posture) const {
  Place place = horizontal_[axis].Position(lag_steps_);
  const double doubt_m2 = DoubtOf(horizontal_[axis], estimate_.stepped ? kSteppedSpreadM[axis] : 0);
  if (doubt_m2 <= 0) return place;
  if (sees_posture) return Weigh(place, doubt_m2, travelling_[axis].Position(lag_steps_));
  place.variance += doubt_m2;
  return place;
}

void BestEstimator::Report(const ContactFrame& contacts, bool sees_posture) {
  estimate_.time_s = contacts.time_s;
  estimate_.lag_s = lag_steps_ * step_s_;
  estimate_.feet = contacts.feet;
  estimate_.valid = contacts.valid;
  estimate_.load_share = contacts.load_share;
  estimate_.whole_weight = contacts.whole_weight;
  estimate_.stepped = contacts.stepped;
  estimate_.trusted = vertical_.trusted() && estimate_.whole_weight;
  for (int i = 0; i < 2; ++i) {
    const HorizontalCom& axis = horizontal_[static_cast<std::size_t>(i)];
    const Place position = PlaceOn(static_cast<std::size_t>(i), sees_posture);
    estimate_.p_WC_m(i) = position.mean;
    estimate_.position_variance_m2(i) = std::min(position.variance, kMostVarianceM2);
    estimate_.v_WC_mps(i) = axis.Velocity().mean;
    estimate_.velocity_variance_m2ps2(i) = std::min(axis.Velocity().variance, kMostVarianceM2ps2);
    estimate_.a_WC_mps2(i) = axis.Acceleration().mean;
  }
  const auto lagged = vertical_.Height(lag_steps_);
  estimate_.p_WC_m.z() = com_height_m_ + std::clamp(lagged.mean, -2.0, 2.0);
  estimate_.position_variance_m2.z() = std::min(lagged.variance, kMostVarianceM2);
  const auto velocity = vertical_.Velocity();
  estimate_.v_WC_mps.z() = velocity.mean;
  estimate_.velocity_variance_m2ps2.z() = std::min(velocity.variance, kMostVarianceM2ps2);
  estimate_.a_WC_mps2.z() = vertical_.acceleration_mps2();
}

void BestEstimator::AdvanceAngular(const ContactFrame& contacts) {
  const Place forward = horizontal_[0].Position(0), lateral = horizontal_[1].Position(0);
  const Eigen::Vector3d now(forward.mean, lateral.mean, com_height_m_ + vertical_.Height(0).mean);
  const Eigen::Vector2d acceleration(horizontal_[0].Acceleration().mean,
                                     horizontal_[1].Acceleration().mean);
  const Eigen::Vector3d rate =
      AngularMomentumRate(contacts.pressures, now, acceleration, pose_.mass_kg);
  const double load = contacts.pressures[0].total_n + contacts.pressures[1].total_n;
  const double keep = std::exp(-step_s_ / config_.angular_memory_s);
  estimate_.angular_momentum_rate_nm = rate;
  estimate_.angular_momentum_kgm2ps = keep * estimate_.angular_momentum_kgm2ps + rate * step_s_;
  for (int i = 0; i < 3; ++i) {
    // About x the lateral place of C counts, about y the forward one; about z nothing is seen.
    const double arm2 = i == 0 ? lateral.variance : i == 1 ? forward.variance : kMostVarianceM2;
    estimate_.angular_momentum_variance(i) =
        keep * keep * estimate_.angular_momentum_variance(i) +
        load * load * arm2 * step_s_ * config_.angular_memory_s;
  }
}

}  // namespace footing::momentum
