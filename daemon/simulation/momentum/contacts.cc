#include "daemon/simulation/momentum/contacts.h"

#include <cmath>

#include "common/base/units.h"

namespace footing::momentum {
namespace {

constexpr double kLeastCopN = 20;
constexpr double kFootCopShare = 0.04;  // Least load for a foot's own COP, over the weight.
constexpr double kAwayS = 1.0;          // Longer than any jump.
constexpr double kAwayShare = 0.3;    // Load over the weight; below it nobody stands on the cells.
constexpr double kAloftShare = 0.05;  // Load over the weight; below it nobody touches them.
constexpr double kFlightS = 0.12;     // Shorter than any jump.
constexpr std::size_t kMostBoardCells = 4;  // Insoles have more, and follow steps.

}  // namespace

ContactEstimator::ContactEstimator(const Subject& subject, const TPose& pose, double step_s)
    : weight_n_(pose.mass_kg * kStandardGravityMps2),
      step_s_(step_s),
      places_{FootPlace(subject.feet[0]), FootPlace(subject.feet[1])} {
  for (std::size_t f = 0; f < kFeet; ++f) {
    places_[f].Start(pose.p_WP_m[f]);
    frame_.feet[f].p_WF_m = places_[f].position_m();
  }
  step_watch_.Start(FeetForward());
}

std::array<double, kFeet> ContactEstimator::FeetForward() const {
  return {places_[0].position_m().x(), places_[1].position_m().x()};
}

const ContactFrame& ContactEstimator::Advance(const ContactLoads& loads) {
  frame_.was_silent = frame_.gap;
  frame_.gap = !IsFinite(loads) || !loads.feet[0].valid || !loads.feet[1].valid;
  if (std::isfinite(loads.time_s)) frame_.time_s = loads.time_s;
  if (!frame_.gap) AdvanceFeet(loads);
  const double total_n = frame_.pressures[0].total_n + frame_.pressures[1].total_n;
  const bool away = frame_.gap || total_n < kAwayShare * weight_n_;
  frame_.returned = !away && away_s_ >= kAwayS;
  if (frame_.returned) {
    load_share_ = {};
    step_watch_.Start(FeetForward());
  }
  WatchFlight(total_n);
  away_s_ = away ? away_s_ + step_s_ : 0;
  frame_.valid = !frame_.gap && away_s_ < kAwayS;
  if (frame_.gap) return frame_;
  load_share_.Advance(total_n / weight_n_, step_s_);
  if (loads.feet[0].count <= kMostBoardCells) step_watch_.Advance(FeetForward(), step_s_);
  frame_.load_share = load_share_.share();
  frame_.whole_weight = load_share_.whole();
  frame_.stepped = step_watch_.stepped();
  return frame_;
}

void ContactEstimator::WatchFlight(double total_n) {
  frame_.landed = false;
  if (frame_.gap || total_n < kAloftShare * weight_n_) {
    aloft_s_ += step_s_;
    return;
  }
  if (total_n < kAwayShare * weight_n_) return;  // Touching down, or leaving.
  frame_.landed = aloft_s_ >= kFlightS;
  aloft_s_ = 0;
}

void ContactEstimator::AdvanceFeet(const ContactLoads& loads) {
  frame_.both = PressureOf(loads, kLeastCopN);
  frame_.groups = ToVerticalInput(loads, frame_.both);
  for (std::size_t f = 0; f < kFeet; ++f) {
    const Pressure pressure = PressureOf(loads.feet[f], kFootCopShare * weight_n_);
    frame_.pressures[f] = pressure;
    const bool before = contacts_[f].contact();
    const double aloft = contacts_[f].since_s();
    const bool contact = contacts_[f].Advance(pressure.total_n, step_s_);
    places_[f].Advance(pressure, contact, contact && !before && aloft > 0, step_s_);
    FootEstimate& foot = frame_.feet[f];
    foot.contact = contact;
    foot.valid = true;
    foot.load_n = pressure.total_n - contacts_[f].tare_n();
    foot.cop_valid = pressure.cop_valid;
    foot.p_WP_m = pressure.p_WP_m;
    foot.p_WF_m = places_[f].position_m();
    foot.variance_m2 = places_[f].variance_m2();
    foot.airborne_s = contact ? 0 : contacts_[f].since_s();
    foot.at_edge_s = AtEdge(loads.feet[f]) ? foot.at_edge_s + step_s_ : 0;
  }
}

}  // namespace footing::momentum
