#include "daemon/simulation/momentum/best_estimator.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/momentum/horizontal_com.h"

namespace footing::momentum {
namespace {

constexpr double kLeastCopN = 20;
constexpr double kFootCopShare = 0.04;  // Least load for a foot's own COP, over the weight.
constexpr double kAwayS = 1.0;          // Longer than any jump.
constexpr double kAwayShare = 0.3;    // Load over the weight; below it nobody stands on the cells.
constexpr double kAloftShare = 0.05;  // Load over the weight; below it nobody touches them.
constexpr double kFlightS = 0.12;     // Shorter than any jump.
// More than this is unknown.
constexpr double kMostVarianceM2 = 1.0, kMostVarianceM2ps2 = 4.0;
// How far the COM of bodies that step is from where the filters place it, forwards and sideways.
constexpr std::array<double, 2> kSteppedSpreadM{0.15, 0.05};
constexpr std::size_t kMostBoardCells = 4;  // Insoles have more, and follow steps.

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
PostureError PlainHeightPosture() { return {1, 0.15, 1, 0.01}; }
PostureError LearnedHeightPosture() { return {1, 0.12, 1, 0.01, 0.85, 0.03}; }

BestEstimator::BestEstimator(const BestConfig& config, const Subject& subject, const TPose& pose,
                             double step_s)
    : config_(config),
      subject_(subject),
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
                config.height_posture),
      contacts_{FootContact(config.contact), FootContact(config.contact)},
      places_{FootPlace(subject.feet[0], config.place), FootPlace(subject.feet[1], config.place)} {
  for (HorizontalCom& axis : horizontal_) axis.KeepLag(lag_steps_);
  for (HorizontalCom& axis : travelling_) axis.KeepLag(lag_steps_);
  vertical_.KeepLag(lag_steps_);
  for (std::size_t f = 0; f < kFeet; ++f) places_[f].Start(pose.p_WP_m[f]);
  Begin();
  estimate_.p_WC_m << pose.cop_m.x(), pose.cop_m.y(), subject.com_height_m;
}

void BestEstimator::Begin() {
  const Eigen::Vector2d centre = Centre();
  for (std::size_t i = 0; i < 2; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    horizontal_[i].Start(pose_.cop_m(axis), centre(axis));
    travelling_[i].Start(pose_.cop_m(axis), centre(axis));
  }
  vertical_.Start(pose_.mean_loads);
  load_share_ = {};
  step_watch_.Start(FeetForward());
  estimate_.angular_momentum_kgm2ps.setZero();
  estimate_.angular_momentum_variance.setZero();
}

Eigen::Vector2d BestEstimator::Centre() const {
  return 0.5 * (places_[0].position_m() + places_[1].position_m()).head<2>();
}

std::array<double, kFeet> BestEstimator::FeetForward() const {
  return {places_[0].position_m().x(), places_[1].position_m().x()};
}

const Estimate& BestEstimator::Advance(const ContactLoads& loads) {
  estimate_.lag_s = lag_steps_ * step_s_;
  const bool gap = !IsFinite(loads) || !loads.feet[0].valid || !loads.feet[1].valid;
  if (std::isfinite(loads.time_s)) estimate_.time_s = loads.time_s;
  if (!gap) AdvanceFeet(loads);
  const double total = pressures_[0].total_n + pressures_[1].total_n;
  const bool away = gap || total < kAwayShare * pose_.mass_kg * kStandardGravityMps2;
  if (!away && away_s_ >= kAwayS) {
    Begin();
    LandElsewhere(loads);
  }
  WatchFlight(loads, gap, total);
  away_s_ = away ? away_s_ + step_s_ : 0;
  silent_ = gap;
  if (!gap) {
    load_share_.Advance(total / (pose_.mass_kg * kStandardGravityMps2), step_s_);
    if (loads.feet[0].count <= kMostBoardCells) step_watch_.Advance(FeetForward(), step_s_);
  }
  estimate_.load_share = load_share_.share();
  estimate_.whole_weight = load_share_.whole();
  estimate_.stepped = step_watch_.stepped();
  estimate_.valid = !gap && away_s_ < kAwayS;
  AdvanceCom(loads, gap || away_s_ >= kAwayS);
  if (!gap) AdvanceAngular();
  return estimate_;
}

void BestEstimator::WatchFlight(const ContactLoads& loads, bool gap, double total_n) {
  const double weight_n = pose_.mass_kg * kStandardGravityMps2;
  if (gap || total_n < kAloftShare * weight_n) {
    aloft_s_ += step_s_;
    return;
  }
  if (total_n < kAwayShare * weight_n) return;  // Touching down, or leaving.
  if (aloft_s_ >= kFlightS && !vertical_.CanLand()) LandElsewhere(loads);
  aloft_s_ = 0;
}

void BestEstimator::LandElsewhere(const ContactLoads& loads) {
  const Pressure both = PressureOf(loads, kLeastCopN);
  const Eigen::Vector2d centre = Centre();
  for (int i = 0; i < 2; ++i) {
    horizontal_[static_cast<std::size_t>(i)].Land(both.p_WP_m(i), centre(i));
    travelling_[static_cast<std::size_t>(i)].Land(both.p_WP_m(i), centre(i));
  }
  if (silent_) {
    vertical_.Reappear();
  } else {
    vertical_.Land();
  }
  estimate_.angular_momentum_kgm2ps.setZero();
  ++estimate_.resets;
}

void BestEstimator::AdvanceFeet(const ContactLoads& loads) {
  const double least = kFootCopShare * pose_.mass_kg * kStandardGravityMps2;
  for (std::size_t f = 0; f < kFeet; ++f) {
    pressures_[f] = PressureOf(loads.feet[f], least);
    const bool before = contacts_[f].contact();
    const double aloft = contacts_[f].since_s();
    const bool contact = contacts_[f].Advance(pressures_[f].total_n, step_s_);
    places_[f].Advance(pressures_[f], contact, contact && !before && aloft > 0, step_s_);
    FootEstimate& foot = estimate_.feet[f];
    foot.contact = contact;
    foot.valid = true;
    foot.load_n = pressures_[f].total_n - contacts_[f].tare_n();
    foot.cop_valid = pressures_[f].cop_valid;
    foot.p_WP_m = pressures_[f].p_WP_m;
    foot.p_WF_m = places_[f].position_m();
    foot.variance_m2 = places_[f].variance_m2();
    foot.airborne_s = contact ? 0 : contacts_[f].since_s();
    foot.at_edge_s = AtEdge(loads.feet[f]) ? foot.at_edge_s + step_s_ : 0;
    PlaceHeelAndToe(subject_.feet[f], foot);
  }
}

void BestEstimator::AdvanceCom(const ContactLoads& loads, bool gap) {
  const Pressure both = PressureOf(loads, kLeastCopN);
  if (gap) {
    vertical_.Coast();
  } else {
    vertical_.Advance(ToVerticalInput(loads, kLeastCopN));
  }
  const double height = subject_.com_height_m + vertical_.Height(0).mean;
  const Eigen::Vector2d centre = Centre();
  for (int i = 0; i < 2; ++i) {
    HorizontalInput input;
    // The cells' COP is only a part of that of a body that stands on something else, too.
    input.cop_valid = !gap && both.cop_valid && estimate_.whole_weight;
    input.cop_m = both.p_WP_m(i);
    // Without a measurement the prior alone goes on: no flight is meant.
    input.load_n =
        gap || !estimate_.whole_weight ? pose_.mass_kg * kStandardGravityMps2 : both.total_n;
    input.com_height_m = height;
    input.centre_m = centre(i);
    horizontal_[static_cast<std::size_t>(i)].Advance(input);
    travelling_[static_cast<std::size_t>(i)].Advance(input);
  }
  ReportCom(false);
}

const Estimate& BestEstimator::SeePosture(double lateral_W_m, const Eigen::Vector3d& likely_W_m) {
  if (!estimate_.valid || !std::isfinite(lateral_W_m) || !likely_W_m.allFinite()) {
    return estimate_;
  }
  horizontal_[1].SeePosture(lateral_W_m);
  travelling_[0].SeePosture(likely_W_m.x());
  travelling_[1].SeePosture(likely_W_m.y());
  vertical_.SeePosture(likely_W_m.z() - subject_.com_height_m);
  ReportCom(true);
  return estimate_;
}

HorizontalCom::Filter::Scalar BestEstimator::PlaceOn(std::size_t axis, bool sees_posture) const {
  HorizontalCom::Filter::Scalar place = horizontal_[axis].Position(lag_steps_);
  const double doubt_m2 = DoubtOf(horizontal_[axis], estimate_.stepped ? kSteppedSpreadM[axis] : 0);
  if (doubt_m2 <= 0) return place;
  if (sees_posture) return Weigh(place, doubt_m2, travelling_[axis].Position(lag_steps_));
  place.variance += doubt_m2;
  return place;
}

void BestEstimator::ReportCom(bool sees_posture) {
  estimate_.trusted = vertical_.trusted() && estimate_.whole_weight;
  for (int i = 0; i < 2; ++i) {
    const HorizontalCom& axis = horizontal_[static_cast<std::size_t>(i)];
    const auto position = PlaceOn(static_cast<std::size_t>(i), sees_posture);
    estimate_.p_WC_m(i) = position.mean;
    estimate_.position_variance_m2(i) = std::min(position.variance, kMostVarianceM2);
    estimate_.v_WC_mps(i) = axis.Velocity().mean;
    estimate_.velocity_variance_m2ps2(i) = std::min(axis.Velocity().variance, kMostVarianceM2ps2);
    estimate_.a_WC_mps2(i) = axis.Acceleration().mean;
  }
  const auto lagged = vertical_.Height(lag_steps_);
  estimate_.p_WC_m.z() = subject_.com_height_m + std::clamp(lagged.mean, -2.0, 2.0);
  estimate_.position_variance_m2.z() = std::min(lagged.variance, kMostVarianceM2);
  const auto velocity = vertical_.output().Velocity();
  estimate_.v_WC_mps.z() = velocity.mean;
  estimate_.velocity_variance_m2ps2.z() = std::min(velocity.variance, kMostVarianceM2ps2);
  estimate_.a_WC_mps2.z() = vertical_.output().acceleration_mps2();
}

void BestEstimator::AdvanceAngular() {
  const Eigen::Vector3d now(horizontal_[0].Position(0).mean, horizontal_[1].Position(0).mean,
                            subject_.com_height_m + vertical_.Height(0).mean);
  const Eigen::Vector3d rate =
      AngularMomentumRate(pressures_, now, estimate_.a_WC_mps2.head<2>(), pose_.mass_kg);
  const double load = pressures_[0].total_n + pressures_[1].total_n;
  const double keep = std::exp(-step_s_ / config_.angular_memory_s);
  estimate_.angular_momentum_rate_nm = rate;
  estimate_.angular_momentum_kgm2ps = keep * estimate_.angular_momentum_kgm2ps + rate * step_s_;
  for (int i = 0; i < 3; ++i) {
    // About x the lateral place of C counts, about y the forward one; about z nothing is seen.
    const double arm2 = i == 0   ? horizontal_[1].Position(0).variance
                        : i == 1 ? horizontal_[0].Position(0).variance
                                 : kMostVarianceM2;
    estimate_.angular_momentum_variance(i) =
        keep * keep * estimate_.angular_momentum_variance(i) +
        load * load * arm2 * step_s_ * config_.angular_memory_s;
  }
}

}  // namespace footing::momentum
