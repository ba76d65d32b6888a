#include "clients/stream/builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "common/base/units.h"

namespace footing::stream_client {
namespace {

/// What a grip is for: "+slope", "-curve", ...; empty for level ground and while it changes over.
std::string KindOf(const BuilderGrip& grip) {
  const double up = grip.pitch_rad, right = grip.roll_rad;
  const auto sign = [](double value) { return value > 0 ? "+" : "-"; };
  if (grip.b) return "pit";
  if (std::fabs(up) > 0.25 && std::fabs(right) < 1e-9)
    return sign(up) + std::string(grip.a ? "step" : "slope");
  if (std::fabs(right) > 0.25 && std::fabs(up) < 1e-9) return sign(right) + std::string("curve");
  return "";
}

std::set<std::string> KindsWithin(const BuilderScript& script, double seconds) {
  std::set<std::string> kinds;
  for (double t_s = 0; t_s < seconds; t_s += 0.05) kinds.insert(KindOf(script.At(t_s)));
  kinds.erase("");
  return kinds;
}

TEST(BuilderScript, HasSlopesCurvesAndStepsToBothSidesBeforeAnyComesAgain) {
  const std::set<std::string> all{"+slope", "-slope", "+curve", "-curve", "+step", "-step"};
  std::set<std::string> with_pits = all;
  with_pits.insert("pit");
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    // Seven kinds of at most 1.8 s; with pits eight.
    EXPECT_EQ(KindsWithin(BuilderScript(seed, false), 7 * 1.8), all) << seed;
    EXPECT_EQ(KindsWithin(BuilderScript(seed, true), 8 * 1.8), with_pits) << seed;
  }
}

TEST(BuilderScript, InclinesByUpTo45DegreesWithoutAJump) {
  const BuilderScript script(3, true);
  BuilderGrip last = script.At(0);
  for (double t_s = 0; t_s < 2 * script.duration_s(); t_s += 0.01) {
    const BuilderGrip now = script.At(t_s);
    EXPECT_LE(std::hypot(now.roll_rad, now.pitch_rad), DegreesToRadians(45) + 1e-9);
    // From one side to the other within a quarter of a second: 3.6 degrees in 10 ms.
    EXPECT_LT(std::fabs(now.roll_rad - last.roll_rad), DegreesToRadians(4)) << t_s;
    EXPECT_LT(std::fabs(now.pitch_rad - last.pitch_rad), DegreesToRadians(4)) << t_s;
    last = now;
  }
}

TEST(BuilderScript, RepeatsWithItsSeedAndDiffersWithAnother) {
  const BuilderScript one(5, false), same(5, false), other(6, false);
  double difference = 0;
  for (double t_s = 0; t_s < 30; t_s += 0.1) {
    EXPECT_EQ(one.At(t_s).roll_rad, same.At(t_s).roll_rad);
    difference += std::fabs(one.At(t_s).roll_rad - other.At(t_s).roll_rad);
  }
  EXPECT_GT(difference, 1);
}

TEST(PlanBuilder, IsOneDeviceInTheRoleEditor) {
  const auto plan = PlanBuilder(false, {});
  ASSERT_TRUE(plan);
  ASSERT_EQ(plan->devices.size(), 1u);
  EXPECT_EQ(plan->devices[0].role(), stream::DeviceRole::kEditor);
  Common unknown;
  unknown.link = "perfect";
  EXPECT_FALSE(PlanBuilder(false, unknown));
}

}  // namespace
}  // namespace footing::stream_client
