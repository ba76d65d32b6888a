#include "daemon/simulation/gait/walk_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace footing::gait {
namespace {

/// Strides up to a pit are at least this share of the walk's own.
constexpr double kShortestShare = 0.5;
/// What was planned before costs this much less.
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
