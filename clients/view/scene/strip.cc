#include "clients/view/scene/strip.h"

#include <algorithm>
#include <cmath>

namespace footing::scene {
namespace {

constexpr std::size_t kMaxPoints = 2500;  // 10 s at 200 Hz, and some more.
constexpr std::size_t kMaxDevices = 16;
constexpr std::size_t kMaxRigs = 8;
constexpr std::int64_t kLineBreakNs = 500'000'000;

void AddIf(Strip& strip, bool valid, std::int64_t time_ns, double value) {
  if (valid) {
    strip.Add(time_ns, value);
  } else {
    strip.Break(time_ns);
  }
}

void AddSample(const stream::MotionSample& sample, std::int64_t time_ns, DeviceStrips& strips) {
  strips.simulated = sample.simulated;
  strips.magnitude_mps2.Add(time_ns, sample.specific_force_mps2.norm());
  strips.filtered_x_mps2.Add(time_ns, sample.filtered_mps2.x());
  strips.filtered_y_mps2.Add(time_ns, sample.filtered_mps2.y());
  strips.filtered_z_mps2.Add(time_ns, sample.filtered_mps2.z());
}

void AddFeatures(const stream::DeviceFeatures& features, std::int64_t time_ns,
                 DeviceStrips& strips) {
  strips.role = features.role;
  strips.moving.Add(time_ns, features.moving ? 1 : 0);
  AddIf(strips.frequency_hz, features.frequency_valid, time_ns, features.frequency_hz);
  AddIf(strips.amplitude_mps2, features.amplitude_valid, time_ns, features.amplitude_mps2);
  AddIf(strips.roll_rad, features.inclination_valid, time_ns, features.roll_rad);
  AddIf(strips.pitch_rad, features.inclination_valid, time_ns, features.pitch_rad);
}

}  // namespace

void Strip::Add(std::int64_t time_ns, double value) {
  if (!std::isfinite(value)) return Break(time_ns);
  const bool late = !points_.empty() && time_ns - points_.back().time_ns > kLineBreakNs;
  points_.push_back({time_ns, static_cast<float>(value), !broken_ && !late});
  broken_ = false;
  if (points_.size() > kMaxPoints) points_.pop_front();
  DropBefore(time_ns - kStripNs);
}

void Strip::Break(std::int64_t time_ns) {
  broken_ = true;
  DropBefore(time_ns - kStripNs);
}

void Strip::DropBefore(std::int64_t time_ns) {
  while (!points_.empty() && points_.front().time_ns < time_ns) points_.pop_front();
}

std::int64_t ShownTime(std::int64_t newest_ns, std::int64_t now_ns) {
  // A little more, so that the values there count as old.
  return std::min(now_ns, newest_ns + kCurrentNs + kCurrentNs / 5);
}

void StripSet::Add(const Update& update) {
  if (!update.motion.empty() || !update.features.empty()) newest_ns = update.received_ns;
  const auto strips_of = [this, &update](std::uint32_t device) -> DeviceStrips* {
    const std::pair key(update.source, device);
    if (devices.count(key) == 0 && devices.size() >= kMaxDevices) return nullptr;
    return &devices[key];
  };
  for (const stream::MotionSample& sample : update.motion) {
    DeviceStrips* strips = strips_of(sample.device);
    // The sample's place within its tick: how long before the tick's stamp the radio gave it.
    const std::int64_t time_ns = update.received_ns - (update.host_ns - sample.received_ns);
    if (strips != nullptr) AddSample(sample, std::min(time_ns, update.received_ns), *strips);
  }
  for (const stream::RigFeatures& rig : update.features) {
    for (const stream::DeviceFeatures& features : rig.devices) {
      DeviceStrips* strips = strips_of(features.device);
      if (strips != nullptr) AddFeatures(features, update.received_ns, *strips);
    }
    if (rig.pairs.empty()) continue;
    if (phases_rad.count(rig.rig) == 0 && phases_rad.size() >= kMaxRigs) continue;
    const stream::PairFeatures& pair = rig.pairs.front();
    AddIf(phases_rad[rig.rig], pair.phase_valid, update.received_ns, pair.phase_rad);
  }
}

}  // namespace footing::scene
