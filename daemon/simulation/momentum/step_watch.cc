#include "daemon/simulation/momentum/step_watch.h"

#include <algorithm>
#include <cmath>

namespace footing::momentum {
namespace {

// A foot of 26 cm on a plate of 32 cm cannot stand further away from where it stood.
constexpr double kStepM = 0.2;
constexpr double kStoodS = 3;  // Of the mean: the filters need as long to find the body again.

}  // namespace

void StepWatch::Start(const std::array<double, kFeet>& forward_m) {
  mean_m_ = forward_m;
  stepped_ = false;
}

void StepWatch::Advance(const std::array<double, kFeet>& forward_m, double step_s) {
  const double part = 1 - std::exp(-step_s / kStoodS);
  double most_m = 0;
  for (std::size_t f = 0; f < kFeet; ++f) {
    mean_m_[f] += part * (forward_m[f] - mean_m_[f]);
    most_m = std::max(most_m, std::abs(forward_m[f] - mean_m_[f]));
  }
  stepped_ = most_m > kStepM;
}

}  // namespace footing::momentum
