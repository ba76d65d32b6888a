#include "common/virtual/people/course.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::choreography {
namespace {

constexpr double kStepLiftM = 0.05;
constexpr double kStepMovesFrom = 0.25;  // Of a step's time: before and after it goes up and down.

/// From 0 to 1 with velocity and acceleration 0 at both ends.
double Blend(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 - 15 * u + 6 * u * u);
}

struct FootChannels {
  Channel lift, step, out;
};
constexpr FootChannels kFeet[] = {{Channel::kLeftLift, Channel::kLeftStep, Channel::kLeftOut},
                                  {Channel::kRightLift, Channel::kRightStep, Channel::kRightOut}};

/// A foot that goes elsewhere goes up first, over, and down.
void StepOver(const Values& from, const Values& to, double u, const FootChannels& foot,
              Values& at) {
  const bool steps =
      At(from, foot.step) != At(to, foot.step) || At(from, foot.out) != At(to, foot.out);
  if (!steps) return;
  const double over = Blend((u - kStepMovesFrom) / (1 - 2 * kStepMovesFrom));
  for (const Channel channel : {foot.step, foot.out})
    At(at, channel) = At(from, channel) + over * (At(to, channel) - At(from, channel));
  const double up = Blend(2 * u) * Blend(2 * (1 - u));
  At(at, foot.lift) = std::max(At(at, foot.lift), kStepLiftM * up);
}

}  // namespace

std::vector<Values> Sample(const Script& script, double rate_hz) {
  std::vector<Values> out;
  const auto frames = static_cast<std::size_t>(std::lround(script.duration_s() * rate_hz)) + 1;
  out.reserve(frames);
  std::size_t key = 0;
  double start_s = 0;
  Values from{};
  while (out.size() < frames && key < script.keys.size()) {
    const Key& to = script.keys[key];
    const double into_s = static_cast<double>(out.size()) / rate_hz - start_s;
    if (into_s > to.seconds && key + 1 < script.keys.size()) {
      start_s += to.seconds;
      from = to.values;
      ++key;
      continue;
    }
    const double u = into_s / to.seconds;
    Values at = from;
    for (std::size_t i = 0; i < kChannels; ++i) at[i] += Blend(u) * (to.values[i] - from[i]);
    for (const FootChannels& foot : kFeet) StepOver(from, to.values, u, foot, at);
    out.push_back(at);
  }
  return out;
}

Eigen::Vector2d Sway(double sway_m, double t_s) {
  // Frequencies without a common period; amplitudes fall as in quiet standing.
  struct Part {
    double x_hz, y_hz, amplitude;
  };
  static constexpr Part kParts[] = {
      {0.11, 0.13, 1}, {0.29, 0.23, 0.7}, {0.61, 0.53, 0.35}, {1.07, 0.97, 0.15}};
  double square = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Part& part : kParts) {
    square += 0.5 * part.amplitude * part.amplitude;
    sum += part.amplitude * Eigen::Vector2d(std::sin(2 * kPi * part.x_hz * t_s),
                                            std::sin(2 * kPi * part.y_hz * t_s));
  }
  return sway_m / std::sqrt(square) * sum;
}

}  // namespace footing::choreography
