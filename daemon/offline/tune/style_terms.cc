#include "daemon/offline/tune/style_terms.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::tune {
namespace {

using stream::Gait;

constexpr double kCadenceTolerance = 0.15, kBobToleranceM = 0.01, kPelvisToleranceDeg = 2;
constexpr double kSlideToleranceM = 0.005, kJerkToleranceMps3 = 500, kTransportTolerance = 0.5;
/// Slower than this a step has no length to speak of.
constexpr double kSlowestMps = 0.2;

double Charge(double deviation, double tolerated) {
  const double x = deviation / tolerated;
  return x * x / (1 + x * x);
}

double PelvisCharge(const style::Swing& seen, const style::Swing& wanted) {
  return Charge(style::Distance(seen.amplitude_rad, seen.peak_phase, wanted.amplitude_rad,
                                wanted.peak_phase, 0.5),
                DegreesToRadians(kPelvisToleranceDeg));
}

const std::vector<DimensionRow> kWalkingStyle{{"walking.swing_time_s", 0.08},
                                              {"walking.double_support_time_s", 0.15},
                                              {"walking.hurry_rate", 0.15},
                                              {"walking.step_width_m", 0.1},
                                              {"walking.leg_stiffness_n_per_m", 0.15},
                                              {"walking.leg_damping_ns_per_m", 0.15},
                                              {"attitude.walk_yaw_stiffness_nm_per_rad", 0.25},
                                              {"attitude.walk_yaw_damping_nms_per_rad", 0.25},
                                              {"attitude.turning_limit_nm", 0.25},
                                              {"style.landing_lead", 0.1, false},
                                              {"style.bob_share", 0.1, false},
                                              {"style.pelvis_roll_rad", 0.01, false},
                                              {"style.pelvis_roll_lead", 0.03, false},
                                              {"style.pelvis_yaw_rad", 0.01, false},
                                              {"style.turn_bank_share", 0.2, false},
                                              {"anticipation.lean_rad_per_mps", 0.02, false}};
const std::vector<DimensionRow> kRunningStyle{{"hopping.run_lift_off_mps", 0.06},
                                              {"hopping.run_leg_stiffness_n_per_m", 0.15},
                                              {"hopping.run_leg_damping_ns_per_m", 0.25},
                                              {"hopping.touchdown_length_m", 0.01},
                                              {"hopping.run_foot_spacing_m", 0.25},
                                              {"attitude.run_yaw_stiffness_nm_per_rad", 0.25},
                                              {"attitude.run_yaw_damping_nms_per_rad", 0.25},
                                              {"style.lean_rad_per_mps", 0.005, false},
                                              {"anticipation.lean_rad_per_mps", 0.02, false}};

}  // namespace

StyleCost StyleCostOf(Gait gait, const style::GaitStyle& style, double weight_n, bool steady) {
  StyleCost cost;
  if (style.steps == 0) return cost;
  cost.slide = Charge(style.slide_max_m, kSlideToleranceM);
  cost.jerk = Charge(style.jerk_rms_mps3, kJerkToleranceMps3);
  cost.transport = Charge(style.work_n / weight_n, kTransportTolerance);
  if (!steady || style.speed_mps < kSlowestMps) return cost;
  const double cadence_hz = style::AlexanderCadence(style.speed_mps, style::kHipHeightM);
  cost.cadence = Charge(style.cadence_hz / cadence_hz - 1, kCadenceTolerance);
  if (gait != Gait::kWalk) return cost;
  const style::PelvisReference pelvis = style::SaundersPelvis(style.speed_mps);
  const double low_phase = std::clamp(style.bob_low_phase, 0.0, style.double_support_share);
  const double bob_m = style::OrendurffBob(style.speed_mps);
  cost.bob = Charge(style::Distance(style.bob_m, style.bob_low_phase, bob_m, low_phase, 1),
                    kBobToleranceM);
  cost.roll = PelvisCharge(style.roll, pelvis.roll);
  cost.yaw = PelvisCharge(style.yaw, pelvis.yaw);
  return cost;
}

void AddShare(const StyleCost& cost, double share, StyleCost& sum) {
  sum.cadence += share * cost.cadence;
  sum.bob += share * cost.bob;
  sum.roll += share * cost.roll;
  sum.yaw += share * cost.yaw;
  sum.slide += share * cost.slide;
  sum.jerk += share * cost.jerk;
  sum.transport += share * cost.transport;
}

bool HasStyle(Gait gait) { return gait == Gait::kWalk || gait == Gait::kRun; }

std::vector<Dimension> StyleDimensionsOf(Gait gait) {
  std::vector<Dimension> dimensions;
  AddDimensions(gait == Gait::kRun ? kRunningStyle : kWalkingStyle, dimensions);
  return dimensions;
}

}  // namespace footing::tune
