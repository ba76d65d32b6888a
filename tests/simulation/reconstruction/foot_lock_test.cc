#include "daemon/simulation/reconstruction/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace footing::reconstruction {
namespace {

constexpr double kStepS = 1.0 / 60;

FootLock::Places Foot(double x_m) {
  return {Eigen::Vector3d(x_m, 0.1, 0.08), Eigen::Vector3d(x_m + 0.13, 0.1, 0.02)};
}

double Apart(const FootLock::Places& a, const FootLock::Places& b) {
  return std::max((a[0] - b[0]).norm(), (a[1] - b[1]).norm());
}

TEST(FootLock, AFootThatStandsIsHeldWhileItsEstimateWandersNear) {
  FootLock lock;
  FootLock::Places shown = Foot(0), first;
  for (int i = 0; i < 300; ++i) {
    const double wander_m = i < 30 ? 0 : 0.015 * std::sin(0.3 * i);  // Less than band_m.
    shown = lock.Advance(true, Foot(wander_m), shown, kStepS);
    if (i == 30) first = shown;
    if (i > 30) {
      ASSERT_LT(Apart(shown, first), 1e-12) << i;
    }
  }
}

TEST(FootLock, AnEstimateThatGoesFarTakesItAlongWithinTheBand) {
  const FootLockConfig config;
  FootLock lock(config);
  FootLock::Places shown = Foot(0);
  for (int i = 0; i < 60; ++i) shown = lock.Advance(true, Foot(0), shown, kStepS);
  for (int i = 0; i < 60; ++i) shown = lock.Advance(true, Foot(0.1), shown, kStepS);
  EXPECT_NEAR(Apart(shown, Foot(0.1)), config.band_m, 1e-3);
}

TEST(FootLock, LandsWithoutAJumpAndIsThereWhenItHasEased) {
  const FootLockConfig config;
  FootLock lock(config);
  FootLock::Places shown = Foot(0);
  shown[0].z() += 0.1;
  shown[1].z() += 0.1;
  const double far_m = Apart(shown, Foot(0.06));
  const int frames = static_cast<int>(std::lround(config.ease_s / kStepS));
  for (int i = 0; i < frames; ++i) {
    const FootLock::Places next = lock.Advance(true, Foot(0.06), shown, kStepS);
    ASSERT_LE(Apart(next, shown), far_m / frames + 1e-9) << i;
    shown = next;
  }
  EXPECT_LT(Apart(shown, Foot(0.06)), 1e-9);
}

TEST(FootLock, TheHeightOfItsEstimateIsNotHeld) {
  FootLock lock;
  FootLock::Places shown = Foot(0);
  for (int i = 0; i < 60; ++i) shown = lock.Advance(true, Foot(0), shown, kStepS);
  FootLock::Places raised = Foot(0);
  raised[0].z() += 0.015;  // Less than band_m.
  EXPECT_LT(Apart(lock.Advance(true, raised, shown, kStepS), raised), 1e-12);
}

TEST(FootLock, LetsGoOfAFootInTheAir) {
  FootLock lock;
  FootLock::Places shown = Foot(0);
  for (int i = 0; i < 60; ++i) shown = lock.Advance(true, Foot(0), shown, kStepS);
  EXPECT_LT(Apart(lock.Advance(false, Foot(0.01), shown, kStepS), Foot(0.01)), 1e-12);
}

}  // namespace
}  // namespace footing::reconstruction
