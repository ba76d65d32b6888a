#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "daemon/simulation/gait/pits.h"

namespace footing::gait {
namespace {

/// 3 m/s, lifting off at 1.3 m/s: flight 2 v_z / g = 0.265 s, stride 0.5 + 0.795 m.
Hop LevelHop() { return {.speed_mps = 3, .support_m = 0.5, .drop_m = 0, .drop_per_mps = 0}; }

/// Follows the plan foothold by foothold; the footholds' distances before the near edge.
struct Followed {
  double last_foothold_m = 0;  ///< Before the near edge.
  double landing_m = 0;        ///< Behind the far edge.
  int strides = 0;
};

Followed Follow(double near_m, double width_m, const Hop& hop, const PitLimits& limits) {
  Followed followed;
  for (; followed.strides < 20; ++followed.strides) {
    const PitAhead pit{near_m, near_m + width_m, 0};
    const PitPlan plan = PlanPit(pit, hop, hop, limits);
    if (plan.leaps) {
      followed.last_foothold_m = near_m;
      followed.landing_m = hop.Stride(plan.lift_off_mps) - pit.far_m;
      break;
    }
    near_m -= hop.Stride(plan.lift_off_mps);
  }
  return followed;
}

TEST(Hop, FliesUntilTheComIsDownAtItsTouchdownHeight) {
  const Hop level = LevelHop();
  EXPECT_NEAR(level.FlightTime(1.3), 2 * 1.3 / kStandardGravityMps2, 1e-12);
  EXPECT_NEAR(level.Stride(1.3), 0.5 + 3 * 2 * 1.3 / kStandardGravityMps2, 1e-12);
  // From 0.1 m higher: v t - g t^2 / 2 = -0.1.
  const Hop drop{.speed_mps = 3, .support_m = 0.5, .drop_m = 0.1};
  const double t = drop.FlightTime(1.3);
  EXPECT_NEAR(1.3 * t - kStandardGravityMps2 * t * t / 2, -0.1, 1e-12);
  // On ground that is 0.1 m higher the same hop ends level.
  EXPECT_NEAR(drop.FlightTime(1.3, 0.1), 2 * 1.3 / kStandardGravityMps2, 1e-12);
}

TEST(Hop, FindsTheLiftOffForAStride) {
  const Hop hop{.speed_mps = 2.7, .support_m = 0.45, .drop_m = 0.03, .nominal_mps = 1.3};
  for (const double lift_off_mps : {1.3, 2.0, 3.1}) {
    for (const double rise_m : {-0.1, 0.0, 0.1}) {
      EXPECT_NEAR(hop.LiftOffFor(hop.Stride(lift_off_mps, rise_m), rise_m), lift_off_mps, 1e-9);
    }
  }
}

TEST(Thrust, StoresTheEnergyOfTheLiftOff) {
  const Thrust thrust{.stiffness_n_per_m = 3500, .mass_kg = 13, .feet_kg = 1, .loss_share = 0.25};
  const double x = thrust.ExtensionFor(1.5);
  // (1 - 0.25) k x^2 / 2 = 12 g x + 13^2 / 12 * 1.5^2 / 2
  EXPECT_NEAR(0.75 * 3500 * x * x / 2, 12 * kStandardGravityMps2 * x + 169.0 / 12 * 1.5 * 1.5 / 2,
              1e-9);
  EXPECT_NEAR(thrust.LossShare(x, 1.5), 0.25, 1e-12);
}

TEST(Thrust, IsStrongerUnderABodyThatFalls) {
  Thrust thrust{.stiffness_n_per_m = 3500, .mass_kg = 13, .feet_kg = 1, .loss_share = 0.25};
  const double level_m = thrust.ExtensionFor(1.5);
  thrust.bottom_mps = -0.4;
  const double falling_m = thrust.ExtensionFor(1.5);
  // The spring gives 1.5 + (0.6 + 0.5 * 1.5) * 0.4 m/s.
  const Thrust at_rest{.stiffness_n_per_m = 3500, .mass_kg = 13, .feet_kg = 1, .loss_share = 0.25};
  EXPECT_NEAR(falling_m, at_rest.ExtensionFor(2.04), 1e-12);
  EXPECT_GT(falling_m, level_m);
  EXPECT_NEAR(thrust.LossShare(falling_m, 1.5), 0.25, 1e-12);
  thrust.bottom_mps = 0.4;
  EXPECT_LT(thrust.ExtensionFor(1.5), level_m);
  thrust.bottom_mps = 5;  // It rises faster than it is to leave: the spring only bears the weight.
  EXPECT_NEAR(thrust.ExtensionFor(1.5), 2 * 12 * kStandardGravityMps2 / (0.75 * 3500), 1e-12);
}

TEST(PitPlan, CrossesPitsFromAnyDistanceWithTheLastFootholdBeforeTheEdge) {
  const PitLimits limits;
  for (const double width_m : {0.2, 0.4, 1.0, 1.5}) {
    for (double near_m = 2.5; near_m < 6; near_m += 0.05) {
      const Followed followed = Follow(near_m, width_m, LevelHop(), limits);
      EXPECT_GE(followed.last_foothold_m, limits.edge_margin_m - 1e-9) << near_m << " " << width_m;
      EXPECT_GE(followed.landing_m, limits.landing_margin_m - 1e-9) << near_m << " " << width_m;
      EXPECT_LE(followed.strides, kStridesMax + 1) << near_m << " " << width_m;
    }
  }
}

TEST(PitPlan, LeavesStridesAloneThatFitByThemselves) {
  const Hop hop = LevelHop();
  const double stride_m = hop.Stride(1.3);
  const double near_m = 2 * stride_m + 0.4;
  const PitPlan plan = PlanPit({near_m, near_m + 0.4, 0}, hop, hop, {});
  EXPECT_TRUE(plan.reaches);
  EXPECT_EQ(plan.strides, 2);
  EXPECT_NEAR(plan.lift_off_mps, 1.3, 1e-6);
}

TEST(PitPlan, SaysWhenThePitIsTooWide) {
  const Hop hop = LevelHop();
  const PitPlan plan = PlanPit({0.1, 4.1, 0}, hop, hop, {});
  EXPECT_TRUE(plan.leaps);
  EXPECT_FALSE(plan.reaches);
  EXPECT_EQ(plan.lift_off_mps, PitLimits{}.leap_max_mps);
}

TEST(PitPlan, IsFiniteForACharacterThatHardlyMoves) {
  for (const double speed_mps : {-1.0, 0.0, 1e-3}) {
    const Hop hop{.speed_mps = speed_mps, .support_m = 0};
    const PitPlan plan = PlanPit({0.5, 1.5, 0}, hop, hop, {});
    EXPECT_TRUE(std::isfinite(plan.lift_off_mps));
    EXPECT_LE(plan.lift_off_mps, PitLimits{}.leap_max_mps);
  }
}

TEST(FootholdShift, MovesOffThePitToTheNearerSide) {
  const PitLimits limits;
  const double width_m = 0.4;
  const auto shift = [&](double into_m, bool leaping) {
    return ShiftOffPit({-into_m, width_m - into_m, 0}, limits, 0.12, 0.25, leaping);
  };
  EXPECT_EQ(shift(-0.2, false), 0);  // Well before it.
  EXPECT_EQ(shift(0.7, false), 0);   // Well behind.
  EXPECT_NEAR(shift(0.03, false), -0.03 - limits.edge_margin_m, 1e-12);
  EXPECT_NEAR(shift(0.35, false), 0.05 + limits.landing_margin_m, 1e-12);
  EXPECT_EQ(shift(0.2, false), 0);     // Neither side can be reached.
  EXPECT_EQ(shift(0.03, true), 0.25);  // A leap lands behind, as far as it can.
}

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
