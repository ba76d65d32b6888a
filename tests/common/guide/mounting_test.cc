#include "common/guide/mounting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace footing::guide {
namespace {

constexpr std::int64_t kMountingSecondNs = 1'000'000'000;

/// Runs for so long at 20 Hz with a shake that depends on the time, s.
StillThenSteps Watch(double seconds, const std::function<double(double)>& moving_mps2) {
  StillThenSteps still;
  for (int i = 0; i < seconds * 20; ++i) {
    still.Advance(10 * kMountingSecondNs + i * kMountingSecondNs / 20, moving_mps2(i / 20.0));
  }
  return still;
}

TEST(StillThenSteps, FindsTheStillnessAndTheStepsAfterIt) {
  // Restless for 3 s, still until 8 s, three steps until 10 s, then still.
  const StillThenSteps found = Watch(12, [](double t) {
    return t < 3 ? 3.0 : t < 8 ? 0.2 : t < 10 ? 5.0 : 0.2;
  });
  ASSERT_EQ(found.phase(), StillThenSteps::Phase::kDone);
  const auto at = [](double s) {
    return 10 * kMountingSecondNs + static_cast<std::int64_t>(s * 1e9);
  };
  EXPECT_GE(found.still_to_ns() - found.still_from_ns(), 2 * kMountingSecondNs);
  EXPECT_LE(found.still_to_ns(), at(7.5));
  EXPECT_GE(found.still_from_ns(), at(2.5));
  // The shake of half a second: movement may have begun so long before it shows.
  EXPECT_LE(found.steps_from_ns(), at(7.5));
  EXPECT_GE(found.steps_from_ns(), at(7.4));
  EXPECT_GT(found.steps_to_ns(), at(10.5));
  EXPECT_LT(found.steps_to_ns(), at(11.5));
}

TEST(StillThenSteps, WaitsForTwoWholeSecondsOfStillness) {
  const StillThenSteps found =
      Watch(12, [](double t) { return std::fmod(t, 1.5) < 0.2 ? 3 : 0.2; });
  EXPECT_EQ(found.phase(), StillThenSteps::Phase::kStill);
}

TEST(StillThenSteps, BeginsAnewAfterATwitch) {
  const StillThenSteps found = Watch(6, [](double t) { return t > 4 && t < 4.3 ? 4.0 : 0.2; });
  EXPECT_EQ(found.phase(), StillThenSteps::Phase::kStill);
}

TEST(Mounting, EveryWornRoleHasAPicture) {
  for (const auto role :
       {stream::DeviceRole::kLeftHand, stream::DeviceRole::kRightHand, stream::DeviceRole::kLeftLeg,
        stream::DeviceRole::kRightLeg, stream::DeviceRole::kHead, stream::DeviceRole::kTrunk}) {
    EXPECT_GT(Picture(role).size(), 100u) << stream::Name(role);
    EXPECT_FALSE(Wearing(role).empty()) << stream::Name(role);
  }
  EXPECT_EQ(Picture(stream::DeviceRole::kLeftBoard), "");
}

}  // namespace
}  // namespace footing::guide
