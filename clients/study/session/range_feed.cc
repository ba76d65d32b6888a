#include "clients/study/session/range_feed.h"

#include <cmath>
#include <utility>

#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/recording/recorded_session.h"
#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::study {
namespace {

using stream::DeviceRole;

/// A board that has been silent for longer is missing, as for the interface.
constexpr double kBoardTimeoutS = 0.25;

bool Uses(const std::string& interface, DeviceRole role) {
  const bool board = role == DeviceRole::kLeftBoard || role == DeviceRole::kRightBoard;
  if (interface == "boards") return board;
  const bool leg = role == DeviceRole::kLeftLeg || role == DeviceRole::kRightLeg;
  const bool hand = role == DeviceRole::kLeftHand || role == DeviceRole::kRightHand;
  return interface == "leg" ? leg : hand;
}

}  // namespace

std::vector<std::string> RangeChannels() {
  return {"status", "features", "nunchuk", "boards", "setup"};
}

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

void RangeFeed::TakeBoards(double time_s, const v1::BoardSamples& samples) {
  bool taken = false;
  for (const v1::BoardSample& message : samples.samples()) {
    const auto device = devices_.find(message.device());
    if (device == devices_.end() || !Uses(played_.interface, device->second.role)) continue;
    if (!Follows(device->second.rig, device->second.role)) continue;
    if (!std::isfinite(message.total_n()) || !std::isfinite(message.cop_x_m()) ||
        !std::isfinite(message.cop_y_m())) {
      continue;
    }
    stream::BoardLayout layout;
    for (const v1::RigSetup& rig : setup_.rigs()) {
      if (rig.rig() == rig_) layout = wire::FromProto(rig).layout;
    }
    layout = board::LayoutOr(layout);
    const bool left = device->second.role == DeviceRole::kLeftBoard;
    const double forward_m =
        board::InWorld(left ? layout.left : layout.right, message.cop_x_m(), message.cop_y_m()).x();
    const double load_n = message.top_left_n() + message.top_right_n() + message.bottom_left_n() +
                          message.bottom_right_n();
    (left ? left_ : right_) = {
        {load_n, message.cop_valid(), forward_m}, time_s, message.simulated()};
    taken = true;
  }
  const auto sends = [time_s](const Foot& foot) {
    return foot.seen_s >= 0 && time_s - foot.seen_s <= kBoardTimeoutS;
  };
  if (!taken || !sends(left_) || !sends(right_)) return;
  meter_.AddStance(time_s, board::StanceOn(left_.load, right_.load),
                   left_.simulated || right_.simulated);
}

void RangeFeed::Take(const v1::Tick& tick) {
  if (tick.has_status()) TakeStatus(tick.status());
  if (tick.has_setup()) setup_ = tick.setup();
  if (tick.snapshot()) return;
  const double time_s = NanosecondsToSeconds(tick.host_ns());
  if (played_.interface == "joystick") return TakeStick(time_s, tick.nunchuk());
  if (played_.interface == "boards") return TakeBoards(time_s, tick.boards());
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
    return InvalidData(path + " has no messages of footingd");
  }
  RangeFeed feed(played, rig);
  const std::int64_t start_ns = sensors->ticks.front().host_ns;
  for (const recording::RecordedTick& recorded : sensors->ticks) {
    auto tick =
        recording::ReadTick(recorded, {v1::Tick::kStatusFieldNumber, v1::Tick::kFeaturesFieldNumber,
                                       v1::Tick::kNunchukFieldNumber, v1::Tick::kBoardsFieldNumber,
                                       v1::Tick::kSetupFieldNumber});
    if (!tick) return InvalidData(path + ": " + tick.error().message);
    const double time_s = NanosecondsToSeconds(recorded.host_ns - start_ns);
    if (time_s < from_s || (to_s > 0 && time_s > to_s)) {
      tick->clear_features();
      tick->clear_nunchuk();
      tick->clear_boards();
    }
    feed.Take(*tick);
  }
  auto measured = feed.meter().Measure();
  if (!measured) return Error{measured.error().kind, path + ": " + measured.error().message};
  return RecordedRanges{std::move(*measured), feed.meter().simulated()};
}

}  // namespace footing::study
