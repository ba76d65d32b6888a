#include "daemon/simulation/gait/transition.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/gait/running.h"
#include "tests/simulation/test_world.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

stream::Track TrackOf(const std::string& segments) {
  Result<stream::Track> track =
      terrain::ParseTrack(R"({"version":1,"name":"test","segments":[)" + segments + "]}", "test");
  EXPECT_TRUE(track.ok());
  return std::move(track).value();
}

/// A body that runs along x at 3 m/s, over its left foot at the origin's height.
struct GroundPlanScene {
  stream::Track track;
  biped::BipedParameters biped = test::Biped();
  Gains gains;
  biped::BodyState body;
  biped::GaitCommand goal{stream::Gait::kRun, 3};
  GaitMemory memory;

  GroundPlanScene(const std::string& segments, double x_m) : track(TrackOf(segments)) {
    memory.gait = stream::Gait::kRun;
    memory.speed.desired_mps = 3;
    body.p_WC = {x_m, 0, 0.85};
    body.v_WC = {3, 0, 0};
    for (int i = 0; i < 2; ++i) {
      body.legs[i].p_WH = {x_m, 0, 0.95};
      body.legs[i].p_WF = {x_m, 0, 0.02};
      body.legs[i].length_m = 0.93;
    }
  }
  Context context(bool sees = true) const {
    return {body, biped, gains, goal, sees ? &track : nullptr, 0.001};
  }
};

const char* const kLevel = R"({"length_m":50})";
const char* const kUpAtFive = R"({"length_m":5},{"length_m":50,"step_m":0.1})";
const char* const kDownAtFive = R"({"length_m":5},{"length_m":50,"step_m":-0.1})";
const char* const kUphill = R"({"length_m":50,"slope_deg":5})";

TEST(ShiftOffEdge, KeepsFeetOutOfABandAroundTheEdge) {
  const GroundPlanScene up(kUpAtFive, 4);
  const auto shift = [&up](double x_m, double towards) {
    return ShiftOffEdge(up.context(), 0, {x_m, 0, 0}, towards);
  };
  const SteppingGains& gains = up.gains.stepping;
  EXPECT_EQ(shift(5 - gains.low_margin_m - 0.001, 0), 0);
  EXPECT_EQ(shift(5 + gains.high_margin_m + 0.001, 0), 0);
  EXPECT_NEAR(shift(4.99, 0), gains.high_margin_m + 0.01, 1e-9);  // The nearer way out.
  EXPECT_NEAR(shift(4.97, 0), -(gains.low_margin_m - 0.03), 1e-9);
  EXPECT_NEAR(shift(4.99, -1), -(gains.low_margin_m - 0.01), 1e-9);  // Decided before.
  const GroundPlanScene down(kDownAtFive, 4);
  EXPECT_NEAR(ShiftOffEdge(down.context(), 0, {4.98, 0, 0}, 0), -(gains.high_margin_m - 0.02),
              1e-9);
}

TEST(PlanClimb, LiftsOffFasterBeforeAStepUpAndSlowerBeforeOneDown) {
  GroundPlanScene level(kLevel, 4.3), up(kUpAtFive, 4.3), down(kDownAtFive, 4.3);
  for (GroundPlanScene* scene : {&level, &up, &down}) {
    PlanClimb(scene->context(), scene->gains.hopping.run_lift_off_mps, scene->memory);
  }
  EXPECT_NEAR(level.memory.ground.climb_mps, 0, 1e-12);
  // v^2 grows by 2 g 0.1 m.
  EXPECT_NEAR(up.memory.ground.climb_mps,
              std::sqrt(1.3 * 1.3 + 2 * kStandardGravityMps2 * 0.1) - 1.3, 1e-6);
  EXPECT_NEAR(down.memory.ground.climb_mps, -down.gains.stepping.slower_limit_mps, 1e-12);
}

TEST(PlanClimb, LeavesABlindCharacterAlone) {
  GroundPlanScene up(kUpAtFive, 4.3);
  PlanClimb(up.context(false), 1.3, up.memory);
  PlanLanding(up.context(false), up.memory);
  EXPECT_EQ(up.memory.ground.climb_mps, 0);
  EXPECT_EQ(up.memory.ground.slope, 0);
  EXPECT_FALSE(up.memory.ground.behind.there);
}

TEST(PlanClimb, MakesASlopesHopTheLevelOneSheared) {
  GroundPlanScene uphill(kUphill, 4);
  const double slope = std::tan(5 * M_PI / 180);
  for (int i = 0; i < 2; ++i) uphill.body.legs[i].p_WF.z() += 4 * slope;
  PlanClimb(uphill.context(), 1.3, uphill.memory);
  EXPECT_NEAR(uphill.memory.ground.slope, slope, 1e-12);
  EXPECT_NEAR(uphill.memory.ground.climb_mps, 0, 0.005);  // Three rounds of an iteration.
  uphill.body.v_WC.z() = 3 * slope;
  EXPECT_NEAR(RisingSpeed(uphill.context(), uphill.memory), 0, 1e-12);
}

TEST(TouchdownLength, IsShorterForAFootUphill) {
  GroundPlanScene uphill(kUphill, 4);
  uphill.memory.ground.slope = 0.1;
  const double level_m = uphill.gains.hopping.touchdown_length_m;
  const double height_m = std::sqrt(level_m * level_m - 0.3 * 0.3);
  EXPECT_NEAR(TouchdownLength(uphill.context(), uphill.memory, 0.3),
              std::hypot(0.3, height_m - 0.03), 1e-12);
  EXPECT_NEAR(TouchdownLength(uphill.context(), uphill.memory, 0), level_m, 1e-12);
}

TEST(RelativeToSlope, GivesLengthWhoseRateIsItsChange) {
  GroundPlanScene uphill(kUphill, 4);
  uphill.memory.ground.slope = 0.1;
  biped::LegState& leg = uphill.body.legs[0];
  uphill.body.v_WC = {3, 0.2, -0.4};
  leg.p_WF.x() += 0.3;
  const auto measure = [&] {
    leg.length_m = (leg.p_WF - leg.p_WH).norm();
    leg.length_rate_mps = (leg.p_WF - leg.p_WH).normalized().dot(-uphill.body.v_WC);
    return RelativeToSlope(uphill.context(), uphill.memory, 0);
  };
  const SlopeLeg before = measure();
  constexpr double kStepS = 1e-6;
  leg.p_WH += kStepS * uphill.body.v_WC;
  const SlopeLeg after = measure();
  EXPECT_NEAR((after.length_m - before.length_m) / kStepS, before.rate_mps, 1e-5);
}

TEST(Cleared, HoldsALowFootBackAtARiserAndPullsItUpOverTheEdge) {
  GroundPlanScene up(kUpAtFive, 4.9);
  up.memory.ground.behind = {.there = true, .p_W_m = {5, 0, 0.1}, .height_m = 0.1};
  const Vector3d ahead(0.3, 0, -0.90);  // Would put the foot at 5.2 m, 0.05 m high.
  const Vector3d low = Cleared(up.context(), up.memory, 0, ahead);
  EXPECT_NEAR(4.9 + low.x(), 5 - up.gains.stepping.riser_margin_m, 1e-12);
  EXPECT_NEAR(0.95 + low.z(), 0.1 + up.biped.foot_radius_m + up.gains.stepping.clearance_m, 1e-12);
  up.body.legs[0].p_WF.z() = 0.2;
  EXPECT_NEAR(Cleared(up.context(), up.memory, 0, ahead).x(), 0.3, 1e-12);
  up.body.legs[0].p_WF.x() = 5.1;  // Past the edge: down to the ground.
  EXPECT_EQ(Cleared(up.context(), up.memory, 0, ahead), ahead);
}

TEST(OffGround, ShortensASwingingLegOfABodyLeftLow) {
  GroundPlanScene level(kLevel, 1), uphill(kUphill, 1);
  level.memory.pit.last_hop.foothold_z_m = level.biped.foot_radius_m;
  const double clear_m = level.biped.foot_radius_m + level.gains.stepping.clearance_m;
  const Vector3d high(0.3, 0, -0.70), scuffs(0.3, 0, -0.92);
  EXPECT_EQ(OffGround(level.context(false), level.memory, 0, high), high);
  EXPECT_NEAR(0.95 + OffGround(level.context(false), level.memory, 0, scuffs).z(), clear_m, 1e-12);
  EXPECT_NEAR(0.95 + OffGround(uphill.context(), uphill.memory, 0, scuffs).z(),
              1.3 * std::tan(DegreesToRadians(5)) + clear_m, 1e-9);
  level.body.legs[0].p_WH.z() = 0.4;  // No leg is that short.
  EXPECT_EQ(OffGround(level.context(false), level.memory, 0, scuffs).z(),
            -level.gains.stepping.shortest_leg_m);
}

/// A foot that scuffs trips the body: twice a run of 5 m/s that was to walk fell so, 0.1 s after a
/// hard landing had left its COM 0.66 m over the ground, rising.
TEST(RunningTargets, KeepBothFeetOfALowRisingBodyOffTheGround) {
  GroundPlanScene low(kLevel, 4);
  low.memory.running = RunningPhase::kUpwardFlight;
  low.memory.pit.last_hop.foothold_z_m = low.biped.foot_radius_m;
  low.body.p_WC.z() = 0.66;
  for (biped::LegState& leg : low.body.legs) leg.p_WH.z() = 0.74;
  const Targets targets = RunningTargets(low.context(false), low.memory);
  for (const LegTarget& leg : targets.legs) {
    EXPECT_GE(0.74 + leg.r_HF_W_m.z(), low.biped.foot_radius_m + 0.019);
  }
}

}  // namespace
}  // namespace footing::gait
