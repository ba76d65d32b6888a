#include "common/recording/device_tables.h"

#include <limits>

#include "common/stream/device.h"
#include "common/wire/wire.h"

namespace footing::bids {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

std::string PointOf(const std::string& rig, stream::DeviceRole role) {
  const std::string name = stream::Name(role);
  return rig.empty() || rig == "main" ? name : rig + "_" + name;
}

}  // namespace

void DeviceTables::Start(const RunClock& clock) {
  clock_ = clock;
  devices_.clear();
}

void DeviceTables::Add(const v1::Tick& tick) {
  tick_ns_ = tick.host_ns();
  for (const v1::DeviceStatus& one : tick.status().devices()) AddStatus(one);
  for (const v1::MotionSample& one : tick.motion().samples()) AddMotion(one);
  for (const v1::BoardSample& one : tick.boards().samples()) AddBoard(one);
  for (const v1::NunchukSample& one : tick.nunchuk().samples()) AddStick(one);
  for (const v1::HandSample& one : tick.hands().samples()) AddHand(one);
}

void DeviceTables::AddStatus(const v1::DeviceStatus& one) {
  const stream::DeviceStatus status = wire::FromProto(one);
  const std::string kind = stream::Name(status.kind);
  if (status.role != stream::DeviceRole::kUnspecified) {
    devices_[status.device] = {PointOf(status.rig, status.role), kind};
  } else if (!with_role_) {
    devices_[status.device] = {kind + std::to_string(status.device), kind};
  }
}

MotionTable* DeviceTables::Find(std::uint32_t device, std::int64_t sampled_ns,
                                const std::string& part) {
  const auto found = devices_.find(device);
  return found == devices_.end() ? nullptr : Find(found->second, sampled_ns, part);
}

MotionTable* DeviceTables::Find(const Device& device, std::int64_t sampled_ns,
                                const std::string& part) {
  time_s_ = clock_(sampled_ns != 0 ? sampled_ns : tick_ns_);
  if (!(time_s_ >= 0)) return nullptr;
  point_ = device.point;
  MotionTable& table = tables_[point_ + part];
  if (table.channels.empty()) {
    table.tracksys = LabelOf(point_ + part);
    table.manufacturer = device.kind;
    table.channels.push_back(Latency());
  }
  return &table;
}

void DeviceTables::AddMotion(const v1::MotionSample& one) {
  MotionTable* table = Find(one.device(), one.sampled_ns(), "");
  if (table == nullptr) return;
  if (table->cells.empty()) {
    AddVector("accel", "ACCEL", point_, "m/s^2", *table);
    AddVector("gyro", "GYRO", point_, "rad/s", *table);
  }
  const v1::Vector3 &a = one.specific_force_mps2(), &w = one.angular_velocity_radps();
  const double turned = one.has_angular_velocity_radps() ? 0 : kMissing;
  Append({time_s_, a.x(), a.y(), a.z(), w.x() + turned, w.y() + turned, w.z() + turned}, *table);
}

void DeviceTables::AddBoard(const v1::BoardSample& one) {
  MotionTable* table = Find(one.device(), one.sampled_ns(), "");
  if (table == nullptr) return;
  if (table->cells.empty()) {
    for (const char* corner : {"top_left", "top_right", "bottom_left", "bottom_right"}) {
      table->channels.push_back({corner, "n/a", "MISC", point_, "N"});
    }
  }
  Append({time_s_, one.top_left_n(), one.top_right_n(), one.bottom_left_n(), one.bottom_right_n()},
         *table);
}

void DeviceTables::AddStick(const v1::NunchukSample& one) {
  MotionTable* table = Find(one.device(), one.sampled_ns(), "_nunchuk");
  if (table == nullptr) return;
  if (table->cells.empty()) {
    for (const char* axis : {"x", "y"}) {
      table->channels.push_back({std::string("stick_") + axis, axis, "MISC", point_, "n/a"});
    }
    AddVector("accel", "ACCEL", point_, "m/s^2", *table);
  }
  const v1::Vector3& a = one.specific_force_mps2();
  Append({time_s_, one.stick_x(), one.stick_y(), a.x(), a.y(), a.z()}, *table);
}

void DeviceTables::AddHand(const v1::HandSample& one) {
  const auto role = static_cast<stream::DeviceRole>(one.role());
  if (role == stream::DeviceRole::kUnspecified) return;  // A joint of a skeleton.
  MotionTable* table =
      Find({PointOf(one.rig(), role), one.tracker()}, one.sampled_ns(), "_tracked");
  if (table == nullptr) return;
  if (table->cells.empty()) {
    AddVector("position", "POS", point_, "m", *table);
    table->channels.push_back({"confidence", "n/a", "MISC", point_, "n/a"});
  }
  const v1::Vector3& p = one.position_m();
  const double seen = one.confidence() > 0 ? 0 : kMissing;
  Append({time_s_, p.x() + seen, p.y() + seen, p.z() + seen, one.confidence()}, *table);
}

}  // namespace footing::bids
