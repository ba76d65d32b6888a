#include "daemon/simulation/gait/walk_plan.h"

#include <gtest/gtest.h>

#include <vector>

namespace footing::gait {
namespace {

/// Footholds of a linear inverted pendulum that walks by the plan: from a settled walk with its
/// supporting foot at 0, as many steps as asked for. Each step the capture point leaves the foot by
/// 1 / d.
std::vector<double> Walk(double stride_m, double decay, const PitAhead& pit, int steps) {
  std::vector<double> footholds{0};
  double capture_m = stride_m / (1 - decay);  // At touchdown, of the settled walk.
  for (int i = 0; i < steps; ++i) {
    const double foot_m = footholds.back();
    const PitAhead seen{pit.near_m - foot_m, pit.far_m - foot_m, 0};
    const WalkAhead walk{capture_m - foot_m, decay, stride_m};
    const auto plan =
        seen.far_m > 0 ? PlanWalkOverPit(walk, seen, {}, std::nullopt, false) : std::nullopt;
    const double next_m = foot_m + (plan ? plan->foothold_m : NaturalFoothold(walk));
    footholds.push_back(next_m);
    capture_m = next_m + (capture_m - next_m) / decay;
  }
  return footholds;
}

TEST(WalkPlan, GoesOnInItsStrideWithoutAPit) {
  const auto footholds = Walk(0.4, 0.28, {50, 50.3, 0}, 10);
  for (std::size_t i = 0; i < footholds.size(); ++i) {
    EXPECT_NEAR(footholds[i], 0.4 * static_cast<double>(i), 1e-6);
  }
}

TEST(WalkPlan, NoFootholdComesToLieInThePitWhereverItIs) {
  const WalkLimits limits;
  for (const double stride_m : {0.1, 0.2, 0.37, 0.45}) {
    for (const double width_m : {0.05, 0.15, 0.3}) {
      for (double near_m = 2.5; near_m < 3; near_m += 0.05) {
        const auto footholds = Walk(stride_m, 0.28, {near_m, near_m + width_m, 0}, 60);
        for (const double foothold_m : footholds) {
          EXPECT_FALSE(foothold_m > near_m - limits.near_margin_m + 1e-9 &&
                       foothold_m < near_m + width_m + limits.far_margin_m - 1e-9)
              << foothold_m << " of a pit " << width_m << " m wide at " << near_m << ", stride "
              << stride_m;
        }
        EXPECT_GT(footholds.back(), near_m + width_m) << "stride " << stride_m;
        EXPECT_NEAR(footholds[60] - footholds[59], stride_m, 1e-3);
      }
    }
  }
}

TEST(WalkPlan, ADecisionForOneSideIsKept) {
  // The natural foothold is 0.4 m ahead, over the pit.
  const WalkAhead walk{0.4 / 0.72, 0.28, 0.4};
  const PitAhead pit{0.35, 0.45, 0};
  const WalkLimits limits;
  EXPECT_GE(PlanWalkOverPit(walk, pit, limits, 0, true)->foothold_m, 0.45 + limits.far_margin_m);
  EXPECT_LE(PlanWalkOverPit(walk, pit, limits, 1, true)->foothold_m, 0.35 - limits.near_margin_m);
}

}  // namespace
}  // namespace footing::gait
