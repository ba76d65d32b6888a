#include "daemon/simulation/momentum/load_share.h"

#include <algorithm>
#include <cmath>

namespace footing::momentum {
namespace {

constexpr double kTimeS = 0.5;  // Of each of two smoothings.
constexpr double kMostShare = 5;
constexpr double kLeast = 0.75, kMost = 1.4;            // Beyond it is not the whole weight,
constexpr double kLeastAgain = 0.87, kMostAgain = 1.2;  // within it is again.

}  // namespace

void LoadShare::Advance(double share, double step_s) {
  const double part = step_s / (kTimeS + step_s);
  early_ += part * (std::clamp(share, 0.0, kMostShare) - early_);
  share_ += part * (early_ - share_);
  whole_ = whole_ ? share_ > kLeast && share_ < kMost : share_ > kLeastAgain && share_ < kMostAgain;
}

}  // namespace footing::momentum
