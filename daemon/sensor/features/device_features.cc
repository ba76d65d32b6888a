#include "daemon/sensor/features/device_features.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::features {

DeviceFeatureExtractor::DeviceFeatureExtractor(std::uint32_t device, stream::DeviceRole role,
                                               const Config& config)
    : config_(config), grid_(config) {
  features_.device = device;
  features_.role = role;
}

void DeviceFeatureExtractor::AddSample(const stream::MotionSample& sample) {
  grid_.Add(sample);
  newest_received_ns_ = std::max(newest_received_ns_, sample.received_ns);
  features_.simulated = sample.simulated;
}

void DeviceFeatureExtractor::Forget() {
  moving_ = {};
  cadence_ = {};
  estimate_ = {};
  swing_end_ = {};
  gravity_mps2_.reset();
  features_.moving = features_.frequency_valid = features_.amplitude_valid = false;
  features_.inclination_valid = features_.held = features_.swing_valid = false;
  features_.frequency_hz = features_.amplitude_mps2 = 0;
  features_.roll_rad = features_.pitch_rad = features_.swing_rad = 0;
}

void DeviceFeatureExtractor::MeasureRest() {
  swing_end_ = {};
  features_.held = features_.amplitude_valid = features_.swing_valid = false;
  features_.amplitude_mps2 = features_.swing_rad = 0;
  const int count =
      std::min(grid_.size(), static_cast<int>(std::lround(config_.rest_window_s * kGridHz)));
  const Eigen::Vector3d gravity = grid_.Filtered(count).colwise().mean().transpose();
  gravity_mps2_ = gravity;
  const Inclination inclination = InclinationOf(gravity);
  features_.inclination_valid = true;
  features_.roll_rad = inclination.roll_rad;
  features_.pitch_rad = inclination.pitch_rad;
}

void DeviceFeatureExtractor::MeasureCycle() {
  if (!cadence_.valid) {
    features_.held = features_.amplitude_valid = features_.swing_valid = false;
    features_.amplitude_mps2 = features_.swing_rad = 0;
    return;  // The inclination from before motion stays: nothing better is known yet.
  }
  const Cycle cycle = NewestCycle(grid_, cadence_.period_s, config_.cycle);
  features_.held = cycle.clipped;
  if (!cycle.valid) return;
  // Held, but never below what even the clipped samples show.
  features_.amplitude_mps2 = cycle.clipped && features_.amplitude_valid
                                 ? std::max(features_.amplitude_mps2, cycle.amplitude_mps2)
                                 : cycle.amplitude_mps2;
  features_.amplitude_valid = true;
  if (cycle.clipped) return;
  const bool shown = cadence_.lost_s == 0 && cadence_.candidate_s == 0;
  if (shown && MeanRepeats(grid_, cadence_.period_s * kGridHz, config_.grip)) {
    gravity_mps2_ = cycle.mean_mps2;
  }
  features_.swing_valid = cycle.swing.valid;
  features_.swing_rad = Continued(cycle.swing, swing_end_, config_.cycle).angle_rad;
  swing_end_ = Next(swing_end_, cycle.swing, config_.cycle);
  const Inclination inclination = InclinationOf(cycle.mean_mps2);
  features_.inclination_valid = true;
  features_.roll_rad = inclination.roll_rad;
  features_.pitch_rad = inclination.pitch_rad;
}

void DeviceFeatureExtractor::Observe(std::int64_t now_ns, const Partner& partner) {
  elapsed_s_ = 0;
  const double age_s = NanosecondsToSeconds(now_ns - grid_.newest_ns());
  if (grid_.size() == 0 || age_s > config_.stale_s) {
    Forget();
    return;
  }
  const bool restarted = grid_.beginnings() != beginnings_;
  if (restarted) Forget();
  beginnings_ = grid_.beginnings();
  const std::int64_t steps = restarted ? 1 : grid_.newest_index() - computed_index_;
  if (steps == 0) return;
  elapsed_s_ = kGridStepS * static_cast<double>(steps);
  computed_index_ = grid_.newest_index();
  const double known_s = cadence_.valid ? cadence_.period_s : 0.0;
  moving_ = Next(moving_, grid_, known_s, config_.moving);
  estimate_ = {};
  if (!moving_.moving) return;
  const auto points = static_cast<int>(
      std::min<std::int64_t>(grid_.size(), grid_.newest_index() - moving_.since_index + 1));
  const bool several = SpansSeveral(cadence_, partner, config_.cadence);
  estimate_ = FindPeriod(grid_, points, several ? 0 : known_s, config_.cadence);
}

const stream::DeviceFeatures& DeviceFeatureExtractor::Compute(const Partner& partner) {
  if (elapsed_s_ == 0) return features_;
  cadence_ =
      moving_.moving ? Next(cadence_, estimate_, partner, elapsed_s_, config_.cadence) : Cadence{};
  features_.moving = moving_.moving;
  features_.frequency_valid = cadence_.valid;
  features_.frequency_hz = cadence_.valid ? 1 / cadence_.period_s : 0.0;
  gravity_mps2_.reset();
  if (moving_.moving) {
    MeasureCycle();
  } else {
    MeasureRest();
  }
  return features_;
}

}  // namespace footing::features
