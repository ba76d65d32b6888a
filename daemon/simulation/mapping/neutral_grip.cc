#include "daemon/simulation/mapping/neutral_grip.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::mapping {
namespace {

/// A rest is taken in parts of this length, each once the next one is over as well: while a motion
/// begins, the features call it a rest for a moment.
constexpr double kBlockS = 0.2;
/// It counts as much as strides of this time.
constexpr double kRestWeightS = 1;
/// Strides count once they are a whole cycle, and this time at least.
constexpr double kLeastS = 0.6;
/// The neutral is a mean over so much of the past.
constexpr double kHorizonS = 30;
/// Nearer to the neutral than this the arms are not twisted: a third of where a turn begins, since
/// between two turns to one side the mean of a cycle stays on that side.
constexpr double kNearRad = DegreesToRadians(8);
/// Longer gaps between readings do not count.
constexpr double kGapS = 0.1;

}  // namespace

void NeutralGrip::Hang(double time_s, double rotation_rad) {
  striding_ = false;
  if (!hanging_) {
    block_ = {.from_s = time_s};
    earlier_rad_.reset();
    rest_rad_.reset();
    hanging_ = true;
  }
  block_.sum_rad += rotation_rad;
  ++block_.count;
  if (time_s - block_.from_s < kBlockS) return;
  rest_rad_ = earlier_rad_;
  earlier_rad_ = block_.sum_rad / block_.count;
  block_ = {.from_s = time_s};
  if (!strode_) TakeRest();
}

void NeutralGrip::TakeRest() {
  if (!rest_rad_) return;
  neutral_rad_ = *rest_rad_;
  known_ = true;
  seen_s_ = kRestWeightS;
}

void NeutralGrip::Renew() {
  strode_ = known_ = false;
  seen_s_ = 0;
  if (hanging_) TakeRest();
}

void NeutralGrip::Stride(double time_s, double rotation_rad, double frequency_hz) {
  const double elapsed_s = striding_ ? std::clamp(time_s - time_s_, 0.0, kGapS) : 0;
  striding_ = true;
  hanging_ = false;
  strode_ = known_;
  time_s_ = time_s;
  if (known_ && std::fabs(rotation_rad - neutral_rad_) > kNearRad) return;
  seen_s_ = std::min(seen_s_ + elapsed_s, kHorizonS);
  const double share = seen_s_ > 0 ? elapsed_s / seen_s_ : 1;
  neutral_rad_ += share * (rotation_rad - neutral_rad_);
  known_ = known_ || (frequency_hz > 0 && seen_s_ >= std::max(kLeastS, 1 / frequency_hz));
}

void NeutralGrip::Rest() {
  striding_ = hanging_ = false;
  if (!known_) Forget();
}

std::optional<double> NeutralGrip::TwistOf(double rotation_rad) const {
  if (!known_) return std::nullopt;
  return rotation_rad - neutral_rad_;
}

}  // namespace footing::mapping
