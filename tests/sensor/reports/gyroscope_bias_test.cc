#include "daemon/sensor/reports/gyroscope_bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "common/base/units.h"

namespace footing::calibration {
namespace {

const Eigen::Vector3d kRest(0, 0, -kStandardGravityMps2);
const Eigen::Vector3d kBias(0.05, -0.12, 0.2);
constexpr std::int64_t kStepNs = 10'000'000;

struct Rig {
  GyroscopeBias bias;
  std::int64_t now_ns = 0;
  std::mt19937 random{7};
  std::normal_distribution<double> noise{0, 0.003};

  Eigen::Vector3d Noise() { return {noise(random), noise(random), noise(random)}; }
  /// Samples at 100 Hz.
  template <typename Motion>
  void Run(double seconds, Motion motion) {
    for (int i = 0; i < seconds * 100; ++i, now_ns += kStepNs) {
      const auto [force, velocity] = motion(NanosecondsToSeconds(now_ns));
      bias.Take(now_ns, force, velocity + Noise());
    }
  }
};

TEST(GyroscopeBias, IsFoundInASecondOfRest) {
  Rig rig;
  rig.Run(0.9, [](double) { return std::pair(kRest, kBias); });
  EXPECT_FALSE(rig.bias.known());
  EXPECT_EQ(rig.bias.bias_radps(), Eigen::Vector3d::Zero());
  rig.Run(0.2, [](double) { return std::pair(kRest, kBias); });
  ASSERT_TRUE(rig.bias.known());
  // The mean of 101 samples of 0.003: five deviations.
  EXPECT_LT((rig.bias.bias_radps() - kBias).cwiseAbs().maxCoeff(), 5 * 0.003 / 10);
}

TEST(GyroscopeBias, StaysWhileTheDeviceMoves) {
  Rig rig;
  rig.Run(1.1, [](double) { return std::pair(kRest, kBias); });
  const Eigen::Vector3d found = rig.bias.bias_radps();
  // Turned to and fro without being shaken: 1 g all along, the velocity varies.
  rig.Run(5, [](double t) {
    return std::pair(kRest, Eigen::Vector3d(kBias + Eigen::Vector3d(0, 0, 0.3 * std::sin(6 * t))));
  });
  EXPECT_EQ(rig.bias.bias_radps(), found);
  // Shaken without being turned.
  rig.Run(5, [](double t) {
    return std::pair(Eigen::Vector3d(kRest * (1 + 0.5 * std::sin(20 * t))),
                     Eigen::Vector3d(kBias * 2));
  });
  EXPECT_EQ(rig.bias.bias_radps(), found);
  // Turned fast and evenly.
  rig.Run(5, [](double) { return std::pair(kRest, Eigen::Vector3d(0, 0, 2)); });
  EXPECT_EQ(rig.bias.bias_radps(), found);
}

TEST(GyroscopeBias, FollowsADriftFromRestToRest) {
  Rig rig;
  rig.Run(1.1, [](double) { return std::pair(kRest, kBias); });
  rig.Run(2, [](double) { return std::pair(kRest, Eigen::Vector3d(0, 0, 3)); });
  const Eigen::Vector3d warm = kBias + Eigen::Vector3d(0.02, 0, -0.01);
  rig.Run(1.1, [&](double) { return std::pair(kRest, warm); });
  EXPECT_LT((rig.bias.bias_radps() - warm).cwiseAbs().maxCoeff(), 5 * 0.003 / 10);
}

TEST(GyroscopeBias, RestMustBeWhole) {
  Rig rig;
  for (int i = 0; i < 10; ++i) {
    rig.Run(0.6, [](double) { return std::pair(kRest, kBias); });
    rig.now_ns += SecondsToNanoseconds(0.4);  // Silence longer than the largest gap.
  }
  EXPECT_FALSE(rig.bias.known());
}

TEST(GyroscopeBias, NeverTakesWhatIsNoNumber) {
  Rig rig;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  rig.Run(3, [&](double t) {
    const bool bad = std::fmod(t, 0.5) < 0.01;
    return std::pair(kRest, bad ? Eigen::Vector3d(nan, 0, 0) : kBias);
  });
  rig.Run(3, [&](double) { return std::pair(Eigen::Vector3d(nan, nan, nan), kBias); });
  EXPECT_FALSE(rig.bias.known());
  EXPECT_TRUE(rig.bias.bias_radps().allFinite());
}

}  // namespace
}  // namespace footing::calibration
