#include "daemon/simulation/reconstruction/step_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace footing::reconstruction {
namespace {

constexpr double kNewest = 0.4;  // Part of the newest step in the mean.
constexpr double kLeastStanceS = 0.35, kMostStanceS = 1.3;
constexpr double kLeastSwingS = 0.2, kMostSwingS = 0.8;

constexpr double kWalkRatioMMin = 0.0065;
constexpr double kMostUsualMps = 2;

// Heights through a swing, m, for a half step of kUsualHalfStepM: after mass_bvh/walk.bvh, rounded,
// and 3 cm for feet that clear the ground.
constexpr std::array<double, 5> kShares{0, 0.25, 0.5, 0.8, 1};
constexpr std::array<double, 5> kAnkleM{0.07, 0.12, 0.08, 0.02, 0.01};
constexpr std::array<double, 5> kBallM{0.02, 0.04, 0.03, 0.08, 0.04};
constexpr double kClearM = 0.03;
constexpr double kUsualHalfStepM = 0.33;
constexpr double kMostSize = 1.3;

void Approach(double value, double least, double most, double& mean) {
  if (value > least && value < most) mean += kNewest * (value - mean);
}

double Between(const std::array<double, 5>& values, double share) {
  std::size_t i = 1;
  while (i + 1 < kShares.size() && share > kShares[i]) ++i;
  const double part = (share - kShares[i - 1]) / (kShares[i] - kShares[i - 1]);
  return values[i - 1] + std::clamp(part, 0.0, 1.0) * (values[i] - values[i - 1]);
}

}  // namespace

void StepTimes::Bore(double lasted_s) { Approach(lasted_s, kLeastStanceS, kMostStanceS, stance_s); }

void StepTimes::Swung(double lasted_s) { Approach(lasted_s, kLeastSwingS, kMostSwingS, swing_s); }

FootRise SwingRise(double share, double half_step_m) {
  const double size = std::min(kMostSize, std::abs(half_step_m) / kUsualHalfStepM);
  const double at = half_step_m < 0 ? 1 - share : share;
  return {kClearM + size * Between(kAnkleM, at), kClearM + size * Between(kBallM, at)};
}

double StepTimes::UsualSpeedMps() const {
  const double cadence_hz = 2 / (stance_s + swing_s);
  return std::min(kMostUsualMps, 60 * kWalkRatioMMin * cadence_hz * cadence_hz);
}

double SwingWay(double share) { return share * share * (3 - 2 * share); }

}  // namespace footing::reconstruction
