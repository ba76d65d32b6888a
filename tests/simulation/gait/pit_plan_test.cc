#include "daemon/simulation/gait/pit_plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

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

}  // namespace
}  // namespace footing::gait
