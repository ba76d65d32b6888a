#include "clients/study/measure/range_feed.h"

#include <cmath>
#include <utility>

#include "common/recording/recorded_session.h"
#include "common/units/units.h"
#include "common/wire/wire.h"

namespace footing::study {
namespace {

using stream::DeviceRole;

bool Uses(const std::string& interface, DeviceRole role) {
  const bool leg = role == DeviceRole::kLeftLeg || role == DeviceRole::kRightLeg;
  const bool hand = role == DeviceRole::kLeftHand || role == DeviceRole::kRightHand;
  return interface == "leg" ? leg : hand;
}

}  // namespace

std::vector<std::string> RangeChannels() { return {"status", "features", "nunchuk"}; }

RangeFeed::RangeFeed(const ranges::Played& played, std::string rig)
    : played_(played), rig_(std::move(rig)), meter_(played) {}

bool RangeFeed::Follows(const std::string& rig, DeviceRole role) {
  if (rig_.empty() && Uses(played_.interface, role)) rig_ = rig;
  return !rig_.empty() && rig == rig_;
}

void RangeFeed::TakeStatus(const v1::DeviceStatusList& status) {
  devices_.clear();
  for (const v1::DeviceStatus& message : status.devices()) {
    const stream::DeviceStatus device = wire::FromProto(message);
    devices_[device.device] = {device.rig, device.role, device.mounted};
  }
}

void RangeFeed::TakeStick(double time_s, const v1::NunchukSamples& samples) {
  for (const v1::NunchukSample& sample : samples.samples()) {
    const auto device = devices_.find(sample.device());
    if (device == devices_.end() || !Uses(played_.interface, device->second.role)) continue;
    if (!Follows(device->second.rig, device->second.role)) continue;
    if (!std::isfinite(sample.stick_x()) || !std::isfinite(sample.stick_y())) continue;
    meter_.AddStick(time_s, sample.stick_x(), sample.stick_y(), sample.simulated());
  }
}

void RangeFeed::Take(const v1::Tick& tick) {
  if (tick.has_status()) TakeStatus(tick.status());
  if (tick.snapshot()) return;
  const double time_s = NanosecondsToSeconds(tick.host_ns());
  if (played_.interface == "joystick") return TakeStick(time_s, tick.nunchuk());
  for (const v1::RigFeatures& message : tick.features().rigs()) {
    const stream::RigFeatures rig = wire::FromProto(message);
    bool follows = false;
    for (const stream::DeviceFeatures& device : rig.devices) {
      follows |= Follows(rig.rig, device.role);
    }
    if (!follows) continue;
    std::uint32_t mounted_roles = 0;
    for (const auto& [number, device] : devices_) {
      if (device.rig == rig_ && device.mounted) mounted_roles |= stream::RoleBit(device.role);
    }
    meter_.Add(time_s, rig, mounted_roles);
  }
}

Result<RecordedRanges> RangesInRecording(const std::string& path, const ranges::Played& played,
                                         const std::string& rig, double from_s, double to_s) {
  const auto session = recording::RecordedSession::Open(path);
  if (!session) return session.error();
  const recording::RecordedServer* sensors = session->Find("footingd");
  if (sensors == nullptr || sensors->ticks.empty()) {
    return InvalidData(path + " has nothing of footingd");
  }
  RangeFeed feed(played, rig);
  const std::int64_t start_ns = sensors->ticks.front().host_ns;
  for (const recording::RecordedTick& recorded : sensors->ticks) {
    auto tick =
        recording::ReadTick(recorded, {v1::Tick::kStatusFieldNumber, v1::Tick::kFeaturesFieldNumber,
                                       v1::Tick::kNunchukFieldNumber});
    if (!tick) return InvalidData(path + ": " + tick.error().message);
    const double time_s = NanosecondsToSeconds(recorded.host_ns - start_ns);
    if (time_s < from_s || (to_s > 0 && time_s > to_s)) {
      tick->clear_features();
      tick->clear_nunchuk();
    }
    feed.Take(*tick);
  }
  auto measured = feed.meter().Measure();
  if (!measured) return Error{measured.error().kind, path + ": " + measured.error().message};
  return RecordedRanges{std::move(*measured), feed.meter().simulated()};
}

}  // namespace footing::study
