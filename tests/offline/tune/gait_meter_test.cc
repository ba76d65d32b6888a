#include "daemon/offline/tune/gait_meter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace footing::tune {
namespace {

constexpr double kStepS = 0.001;

/// Feet that are down for 0.4 of every 0.7 s, half a cycle apart, at 1 m/s; each touchdown
/// chatters for 10 ms.
TrialResult WalkMade(stream::Gait gait) {
  GaitMeter meter({gait, 1.0});
  engine::EngineOutput output;
  for (int i = 0; i < 5000; ++i) {
    for (int leg = 0; leg < 2; ++leg) {
      const int phase = (i + 350 * leg) % 700;
      const bool chatters = phase == 3 || phase == 7;
      output.contacts[static_cast<std::size_t>(leg)].touching = phase < 400 && !chatters;
      if (phase == 0) ++output.gait.steps;
    }
    output.gait.speed_mps = 1 + 0.3 * std::sin(2 * M_PI * i / 350);
    output.gait.distance_m = i * kStepS;
    meter.Add(output, kStepS);
  }
  TrialResult result;
  meter.Report(result);
  return result;
}

TEST(GaitMeter, MeasuresSwingStanceAndStrideOfAWalk) {
  const TrialResult result = WalkMade(stream::Gait::kWalk);
  EXPECT_NEAR(result.flight_s, 0.30, 0.012);  // Down for good from the chatter's end.
  EXPECT_NEAR(result.stance_s, 0.40, 0.012);
  EXPECT_NEAR(result.stride_m, 0.70, 1e-9);
}

TEST(GaitMeter, TakesTheSpeedOverAStepNotWithinIt) {
  // A swing of 0.3 m/s at 18 rad/s through 0.5 s of smoothing: 0.3 / (18 * 0.5), and its rms.
  EXPECT_NEAR(WalkMade(stream::Gait::kWalk).speed_error_mps, 0.3 / 9 / std::sqrt(2), 0.012);
}

TEST(GaitMeter, OfARunCountsTheTimesWithoutAnyFoot) {
  GaitMeter meter({stream::Gait::kRun, 2.0});
  engine::EngineOutput output;
  for (int i = 0; i < 4000; ++i) {
    output.contacts[0].touching = i % 800 < 150;
    output.contacts[1].touching = (i + 400) % 800 < 150;
    meter.Add(output, kStepS);
  }
  TrialResult result;
  meter.Report(result);
  EXPECT_NEAR(result.flight_s, 0.25, 0.002);
  EXPECT_NEAR(result.stance_s, 0.15, 0.002);
}

TEST(GaitMeter, KeepsTheLeastGapBetweenTheLegs) {
  GaitMeter meter({stream::Gait::kRun, 2.0});
  engine::EngineOutput output;
  for (const double feet_m : {0.2, 0.1, 0.15}) {  // Parallel legs of 4 cm.
    for (const int side : {0, 1}) {
      const double y_m = (side == 0 ? 0.5 : -0.5) * feet_m;
      output.links[static_cast<std::size_t>(1 + 2 * side)].position_m = {0, y_m, 0.9};
      output.contacts[static_cast<std::size_t>(side)].position_m = {0, y_m, 0};
    }
    meter.Add(output, kStepS);
  }
  TrialResult result;
  meter.Report(result);
  EXPECT_NEAR(result.leg_gap_m, 0.06, 1e-12);
}

}  // namespace
}  // namespace footing::tune
