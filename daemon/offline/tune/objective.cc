#include "daemon/offline/tune/objective.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::tune {
namespace {

using stream::Gait;

/// The controller keeps the legs' axes 7 cm apart (CurveGains::leg_gap_m), 4 cm of it legs.
constexpr double kLegGapM = 0.03;

double Square(double value) { return value * value; }

/// A trial that fell before it showed one whole flight, stance or stride says nothing of it; the
/// fall is charged already.
double Deviation(double seen, double wanted) {
  if (seen <= 0) return 0;
  return std::min(1.0, 0.25 * Square((seen / wanted - 1) / 0.1));
}

}  // namespace

Wanted WantedOf(const Task& task, double height_m) {
  const auto strides = [&task](double flight_s, double stance_s, double stride_s) {
    return Wanted{flight_s, stance_s, task.speed_mps * stride_s, 0.6 + 0.1 * task.speed_mps};
  };
  switch (task.gait) {
    case Gait::kRun: {
      const double flight_s = 0.28, stance_s = 0.25 - 0.024 * task.speed_mps;
      return strides(flight_s, stance_s, 2 * (flight_s + stance_s));
    }
    case Gait::kJump: {
      const double flight_s = 2 * std::sqrt(2 * height_m / kStandardGravityMps2), stance_s = 0.18;
      return strides(flight_s, stance_s, flight_s + stance_s);
    }
    case Gait::kStep:
    case Gait::kWalk:
    case Gait::kUnspecified:
      return strides(0.32, 0.40, 0.72);
  }
  return {};
}

Cost CostOf(const Task& task, const TrialResult& result) {
  const Wanted wanted = WantedOf(task, result.height_m);
  Cost cost;
  cost.failure = result.survived < 1 ? 10 + 10 * (1 - result.survived) : 0;
  cost.speed = std::min(2.0, Square(result.speed_error_mps / 0.15));
  cost.flight = Deviation(result.flight_s, wanted.flight_s);
  cost.stance = Deviation(result.stance_s, wanted.stance_s);
  if (task.speed_mps >= 0.3) cost.stride = Deviation(result.stride_m, wanted.stride_m);
  cost.heading = std::min(2.0, Square(RadiansToDegrees(result.heading_error_rad) / 5));
  if (task.gait == Gait::kRun) {
    cost.legs = std::min(2.0, Square(std::max(0.0, 1 - result.leg_gap_m / kLegGapM)));
    const double late = std::max(0.0, result.latency_s / wanted.latency_s - 1);
    cost.latency = std::min(2.0, Square(late / 0.1));
  }
  return cost;
}

}  // namespace footing::tune
