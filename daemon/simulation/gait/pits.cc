#include "daemon/simulation/gait/pits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/units.h"
#include "daemon/simulation/gait/controller.h"

namespace footing::gait {
namespace {

/// Costs of a plan in m/s of lift-off speed: a stride more, and a plan beyond its limits.
constexpr double kStrideCostMps = 0.3;
constexpr double kLeapCost = 1.5;
constexpr double kBeyondCost = 20;
/// A foothold so far over the edge counts as much as 1 m/s of lift-off too much.
constexpr double kSlightM = 0.05;
constexpr double kSlowestMps = 0.05;

struct Costed {
  PitPlan plan;
  double cost = 0;
};

/// The hop over the pit from a foothold `near_m` before the edge.
double LeapSpeed(const PitAhead& pit, double near_m, const Hop& hop, const PitLimits& limits) {
  const double width_m = pit.far_m - pit.near_m;
  const double needed_mps = hop.LiftOffFor(near_m + width_m + limits.landing_margin_m, pit.rise_m);
  return std::max(needed_mps, hop.nominal_mps);
}

Costed Leap(const PitAhead& pit, const Hop& hop, const PitLimits& limits) {
  const double leap_mps = LeapSpeed(pit, pit.near_m, hop, limits);
  const double beyond_mps = std::max(0.0, leap_mps - limits.leap_max_mps);
  return {{.leaps = true,
           .reaches = beyond_mps == 0,
           .strides = 0,
           .lift_off_mps = std::min(leap_mps, limits.leap_max_mps)},
          kLeapCost * (leap_mps - hop.nominal_mps) + kBeyondCost * beyond_mps};
}

/// `strides` alike before the last foothold, which is to lie before the edge, but no further than
/// the nominal hop from it carries over the pit.
Costed Approach(const PitAhead& pit, int strides, const Hop& first, const Hop& next,
                const PitLimits& limits) {
  const auto last_foothold = [&](double lift_off_mps) {
    return first.Stride(lift_off_mps) + (strides - 1) * next.Stride(lift_off_mps);
  };
  const double latest_m = pit.near_m - limits.edge_margin_m;
  const double best_m = latest_m - limits.aim_margin_m;
  const double reach_m = next.Stride(next.nominal_mps, pit.rise_m) - limits.landing_margin_m;
  const double earliest_m = std::min(best_m, pit.far_m - reach_m + limits.aim_margin_m);
  const double target_m = std::clamp(last_foothold(first.nominal_mps), earliest_m, best_m);
  // One lift-off speed for all: the strides' sum is monotonous in it.
  double low_mps = limits.lift_off_min_mps, high_mps = limits.lift_off_max_mps;
  for (int i = 0; i < 30; ++i) {
    const double middle_mps = (low_mps + high_mps) / 2;
    (last_foothold(middle_mps) < target_m ? low_mps : high_mps) = middle_mps;
  }
  const double reached_m = last_foothold(low_mps);
  const double leap_mps = LeapSpeed(pit, pit.near_m - reached_m, next, limits);
  const double beyond_mps = std::max(0.0, leap_mps - limits.leap_max_mps);
  const double over_m = std::max(0.0, reached_m - latest_m);
  return {{.leaps = false,
           .reaches = beyond_mps == 0 && over_m == 0,
           .strides = strides,
           .lift_off_mps = low_mps},
          kLeapCost * (leap_mps - next.nominal_mps) +
              strides * std::fabs(low_mps - first.nominal_mps) + strides * kStrideCostMps +
              kBeyondCost * (beyond_mps + over_m / kSlightM)};
}

}  // namespace

double Hop::FlightTime(double lift_off_mps, double rise_m) const {
  const double drop = drop_m + drop_per_mps * (lift_off_mps - nominal_mps) - rise_m;
  const double landing_mps2 = lift_off_mps * lift_off_mps + 2 * kStandardGravityMps2 * drop;
  return std::max(0.0,
                  (lift_off_mps + std::sqrt(std::max(0.0, landing_mps2))) / kStandardGravityMps2);
}

double Hop::Stride(double lift_off_mps, double rise_m) const {
  return support_m + speed_mps * FlightTime(lift_off_mps, rise_m);
}

double Hop::LiftOffFor(double stride_m, double rise_m) const {
  const double flight_s = std::max(0.0, stride_m - support_m) / std::max(speed_mps, kSlowestMps);
  if (flight_s == 0) return 0;
  // -drop = v t - g t^2 / 2, with drop linear in v.
  const double level_m =
      kStandardGravityMps2 * flight_s * flight_s / 2 - drop_m + drop_per_mps * nominal_mps + rise_m;
  return std::max(0.0, level_m / (flight_s + drop_per_mps));
}

namespace {

/// The last term of Thrust's equation: the energy of u, which the spring itself has to give.
double MotionEnergy(const Thrust& thrust, double lift_off_mps) {
  constexpr double kShare = 0.6, kSharePerMps = 0.5;  // a and b of Thrust.
  const double spring_mps =
      std::max(0.0, lift_off_mps - (kShare + kSharePerMps * lift_off_mps) * thrust.bottom_mps);
  const double supported_kg = thrust.mass_kg - thrust.feet_kg;
  return thrust.mass_kg * thrust.mass_kg / supported_kg * spring_mps * spring_mps / 2;
}

}  // namespace

double Thrust::ExtensionFor(double lift_off_mps) const {
  const double supported_kg = mass_kg - feet_kg;
  const double weight_n = supported_kg * kStandardGravityMps2;
  const double useful_n_per_m = (1 - loss_share) * stiffness_n_per_m;
  const double motion_j = MotionEnergy(*this, lift_off_mps);
  return (weight_n + std::sqrt(weight_n * weight_n + 2 * useful_n_per_m * motion_j)) /
         useful_n_per_m;
}

double Thrust::LossShare(double extension_m, double lift_off_mps) const {
  const double supported_kg = mass_kg - feet_kg;
  const double stored_j = stiffness_n_per_m * extension_m * extension_m / 2;
  const double motion_j = MotionEnergy(*this, lift_off_mps);
  return (stored_j - supported_kg * kStandardGravityMps2 * extension_m - motion_j) / stored_j;
}

PitPlan PlanPit(const PitAhead& pit, const Hop& first, const Hop& next, const PitLimits& limits) {
  Costed best = Leap(pit, first, limits);
  for (int strides = 1; strides <= kStridesMax; ++strides) {
    const Costed plan = Approach(pit, strides, first, next, limits);
    if (plan.cost < best.cost) best = plan;
  }
  return best.plan;
}

double ShiftOffPit(const PitAhead& pit, const PitLimits& limits, double back_m, double ahead_m,
                   bool leaping) {
  const double to_near_m = pit.near_m - limits.edge_margin_m;
  const double to_far_m = pit.far_m + limits.landing_margin_m;
  if (to_near_m >= 0 || to_far_m <= 0) return 0;
  const bool can_back = !leaping && -to_near_m <= back_m;
  const bool can_ahead = to_far_m <= ahead_m;
  if (can_back && (!can_ahead || -to_near_m < to_far_m)) return to_near_m;
  if (can_ahead) return to_far_m;
  return leaping ? ahead_m : 0;
}

namespace {

/// Strides up to a pit are at least this share of the walk's own.
constexpr double kShortestShare = 0.5;
/// Factor on the cost of the plan made before.
constexpr double kPreferred = 0.3;
/// The stride after one that was made longer to step over is shorter by at most this share.
constexpr double kMostShorter = 0.7;

/// Where no foot may go.
struct Gap {
  double near_m, far_m;
};

struct CostedWalk {
  WalkPlan plan;
  double cost = std::numeric_limits<double>::infinity();
};

double Square(double value) { return value * value; }

/// d + d^2 + ... without end.
double AllDecays(double decay) { return decay / (1 - decay); }

/// The coming foothold lies behind the pit. What it is moved shortens the next stride by 1 / d of
/// that.
CostedWalk StepOver(const WalkAhead& walk, const Gap& gap, const WalkLimits& limits) {
  const double natural_m = NaturalFoothold(walk);
  const double landing_m = gap.far_m + limits.aim_margin_m;
  const double foothold_m = std::max(std::min(natural_m, limits.stride_max_m), landing_m);
  const double shorter_m = std::max(0.0, landing_m - natural_m) / walk.decay;
  const bool possible =
      landing_m <= limits.stride_max_m && shorter_m <= kMostShorter * walk.stride_m;
  if (!possible) return {{std::max(natural_m, gap.far_m), 0}};
  return {{foothold_m, 0}, Square(shorter_m)};
}

/// The coming foothold is the first of `strides` before the pit; the last one may lie where the
/// walk's own stride from it reaches over the pit, else as near to the edge as it may.
CostedWalk StepBefore(const WalkAhead& walk, const Gap& gap, const WalkLimits& limits,
                      int strides) {
  const double latest_m = gap.near_m - limits.aim_margin_m;
  const double landing_m = gap.far_m + limits.aim_margin_m;
  const double crossing_m = std::max(walk.stride_m, landing_m - latest_m);
  const double natural_m = NaturalFoothold(walk);
  const double last_m =
      std::clamp(natural_m + (strides - 1) * walk.stride_m, landing_m - crossing_m, latest_m);
  const double d = walk.decay;
  const double then_m = std::pow(d, strides + 1) / (1 - d) * walk.stride_m;
  if (strides == 1) {
    // The stride over the pit is what the foothold makes it.
    const auto reach = [&](double foothold_m) {
      return (walk.capture_m - foothold_m - then_m) / d;
    };
    const double reaching_m = (walk.capture_m - then_m - d * landing_m) / (1 - d);
    const double foothold_m = std::min({natural_m, latest_m, reaching_m});
    const double stride_m = reach(foothold_m);
    if (stride_m > limits.stride_max_m || foothold_m < limits.stride_min_m) {
      return {{std::min(natural_m, gap.near_m), 1}};
    }
    return {{foothold_m, 1}, Square(stride_m - crossing_m)};
  }
  double sum = 0;
  for (int j = 1; j < strides; ++j) sum += std::pow(d, j);
  const double share = sum / (strides - 1);
  const double over_m = std::pow(d, strides) * crossing_m;
  const double foothold_m = (walk.capture_m - share * last_m - over_m - then_m) / (1 - share);
  const double stride_m = (last_m - foothold_m) / (strides - 1);
  const bool possible =
      stride_m >= kShortestShare * walk.stride_m && stride_m <= limits.stride_max_m;
  if (!possible) return {{std::min(foothold_m, gap.near_m), strides}};
  return {{foothold_m, strides}, (strides - 1) * Square(stride_m - walk.stride_m)};
}

}  // namespace

double NaturalFoothold(const WalkAhead& walk) {
  return walk.capture_m - AllDecays(walk.decay) * walk.stride_m;
}

std::optional<WalkPlan> PlanWalkOverPit(const WalkAhead& walk, const PitAhead& pit,
                                        const WalkLimits& limits, std::optional<int> strides,
                                        bool decided) {
  const Gap gap{pit.near_m - limits.near_margin_m, pit.far_m + limits.far_margin_m};
  const auto with = [&](int count) {
    CostedWalk walked =
        count == 0 ? StepOver(walk, gap, limits) : StepBefore(walk, gap, limits, count);
    if (count == strides) walked.cost *= kPreferred;
    return walked;
  };
  if (strides && decided) return with(*strides).plan;
  CostedWalk best = with(0);
  for (int count = 1; count <= kWalkStridesMax + 1; ++count) {
    const CostedWalk walked = with(count);
    if (walked.cost < best.cost) best = walked;
  }
  if (best.plan.strides > kWalkStridesMax) return std::nullopt;
  // Out of reach: to the nearer side.
  const double middle_m = (gap.near_m + gap.far_m) / 2;
  if (!std::isfinite(best.cost)) best = with(NaturalFoothold(walk) < middle_m ? 1 : 0);
  return best.plan;
}

}  // namespace footing::gait
