#include "clients/stream/sensor_packets.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "common/base/units.h"

namespace footing::stream_client {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using osc::Bytes;

constexpr std::size_t kHeadBytes = 15, kSampleBytes = 28, kMostSamples = 20;
constexpr std::uint8_t kReportId = 1, kHasRate = 2;
/// A rate that is older belongs to another moment.
constexpr std::int64_t kRateLastsNs = 200'000'000;
constexpr std::int64_t kHeartbeatNs = 500'000'000;

/// No sensor measures more, in any of the units; what follows from it stays finite.
constexpr double kMostMeasured = 1e4;

/// Types of SlimeVR's packets.
enum : std::uint32_t {
  kServersHeartbeat = 1,
  kRotation = 1,
  kHandshake = 3,
  kAcceleration = 4,
  kBattery = 12,
  kSensorInfo = 15,
  kRotation2 = 16,
  kRotationData = 17,
  kRotationAndAcceleration = 23,
  kBundle = 100,
  kShortBundle = 101,
};
constexpr std::size_t kSlimeVrHead = 12;

/// Ends of the OSC addresses.
constexpr std::array<std::string_view, 5> kOscNames = {"/gyroscope", "/gyro", "/gravity",
                                                       "/accelerometer", "/accel"};

/// A number in network order.
template <typename Value>
Value ReadBig(Bytes bytes, std::size_t at) {
  std::array<std::uint8_t, sizeof(Value)> turned;
  for (std::size_t i = 0; i < sizeof(Value); ++i) turned[sizeof(Value) - 1 - i] = bytes[at + i];
  return std::bit_cast<Value>(turned);
}

std::string BigEndian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

template <typename Value>
void Append(Value value, std::vector<std::uint8_t>& to) {
  const auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(Value)>>(value);
  to.insert(to.end(), bytes.begin(), bytes.end());
}

void Append(const Vector3d& value, std::vector<std::uint8_t>& to) {
  for (const double part : value) Append(static_cast<float>(part), to);
}

/// Nothing for a value that no sensor measures, NaN among them.
std::optional<Vector3d> Measured(const Vector3d& value) {
  if (!(value.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kMostMeasured)) return std::nullopt;
  return value;
}

std::optional<Vector3d> ReadVector(Bytes bytes, std::size_t at) {
  if (bytes.size() < at + 12) return std::nullopt;
  return Measured(
      {ReadBig<float>(bytes, at), ReadBig<float>(bytes, at + 4), ReadBig<float>(bytes, at + 8)});
}

/// x, y, z, w as floats; nothing where that is not a rotation.
std::optional<Quaterniond> ReadRotation(Bytes bytes, std::size_t at) {
  if (bytes.size() < at + 16) return std::nullopt;
  const Quaterniond q(ReadBig<float>(bytes, at + 12), ReadBig<float>(bytes, at),
                      ReadBig<float>(bytes, at + 4), ReadBig<float>(bytes, at + 8));
  if (!(std::abs(q.norm() - 1) < 0.1)) return std::nullopt;
  return q.normalized();
}

std::optional<Vector3d> ThreeNumbers(std::span<const osc::Argument> arguments) {
  if (arguments.size() < 3) return std::nullopt;
  Vector3d value;
  for (int axis = 0; axis < 3; ++axis) {
    const osc::Argument& argument = arguments[static_cast<std::size_t>(axis)];
    if (const auto* single = std::get_if<float>(&argument)) {
      value[axis] = *single;
    } else if (const auto* twice = std::get_if<double>(&argument)) {
      value[axis] = *twice;
    } else {
      return std::nullopt;
    }
  }
  return Measured(value);
}

bool IsReport(Bytes bytes) {
  if (bytes.size() < kHeadBytes || bytes[0] != kReportId) return false;
  const std::size_t count = bytes[kHeadBytes - 1];
  return count >= 1 && count <= kMostSamples && bytes.size() == kHeadBytes + count * kSampleBytes;
}

std::string NameOf(const std::string& from, int sensor) {
  return sensor == 0 ? from : from + "/" + std::to_string(sensor);
}

}  // namespace

SensorPackets::Sensor* SensorPackets::Known(const std::string& sensor) {
  const auto known = sensors_.find(sensor);
  return known == sensors_.end() ? nullptr : &known->second;
}

SensorPackets::Sensor* SensorPackets::Of(const std::string& sensor) {
  if (Sensor* known = Known(sensor)) return known;
  if (sensors_.size() >= kMostSensors) return nullptr;
  return &sensors_[sensor];
}

SensorPacket SensorPackets::Take(const std::string& from, std::int64_t now_ns, Bytes bytes) {
  SensorPacket packet;
  if (bytes.empty() || bytes.size() > kMostPacketBytes) return packet;
  if (IsReport(bytes)) {
    packet.is_known = true;
    if (Of(from) != nullptr) packet.reports.push_back({from, {bytes.begin(), bytes.end()}});
  } else if (bytes[0] == 0 && bytes.size() >= 4) {
    TakeSlimeVr(from, now_ns, bytes, packet);
  } else if (bytes[0] == '/' || bytes[0] == '#') {
    TakeOsc(from, now_ns, bytes, packet);
  }
  return packet;
}

void SensorPackets::TakeSlimeVr(const std::string& from, std::int64_t now_ns, Bytes bytes,
                                SensorPacket& packet) {
  const auto type = ReadBig<std::uint32_t>(bytes, 0);
  if (type == kHandshake) {
    // The answer has no head.
    std::string answer = "\x03Hey OVR =D 5";
    answer.resize(64);
    packet.replies.push_back(answer);
    packet.is_known = true;
    return;
  }
  if (bytes.size() < kSlimeVrHead) return;
  const Bytes rest = bytes.subspan(kSlimeVrHead);
  if (type != kBundle && type != kShortBundle) {
    return TakeSlimeVrPart(from, now_ns, type, rest, packet);
  }
  const std::size_t length_bytes = type == kBundle ? 2 : 1, type_bytes = type == kBundle ? 4 : 1;
  for (std::size_t at = 0; at + length_bytes <= rest.size();) {
    const std::size_t length = type == kBundle ? ReadBig<std::uint16_t>(rest, at) : rest[at];
    at += length_bytes;
    if (length == 0) continue;
    if (length < type_bytes || at + length > rest.size()) return;
    const std::uint32_t part = type == kBundle ? ReadBig<std::uint32_t>(rest, at) : rest[at];
    TakeSlimeVrPart(from, now_ns, part, rest.subspan(at + type_bytes, length - type_bytes), packet);
    at += length;
  }
}

void SensorPackets::TakeSlimeVrPart(const std::string& from, std::int64_t now_ns,
                                    std::uint32_t type, Bytes bytes, SensorPacket& packet) {
  const int id = bytes.empty() ? 0 : bytes[0];
  packet.is_known = true;
  if (type == kRotation || type == kRotation2) {
    const auto rotation = ReadRotation(bytes, 0);
    if (rotation) Turn(NameOf(from, type == kRotation2), now_ns, *rotation, {}, packet);
  } else if (type == kRotationData && bytes.size() >= 18 && bytes[1] == 1) {
    const auto rotation = ReadRotation(bytes, 2);
    if (rotation) Turn(NameOf(from, id), now_ns, *rotation, {}, packet);
  } else if (type == kRotationAndAcceleration && bytes.size() >= 15) {
    std::array<double, 7> v;
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = ReadBig<std::int16_t>(bytes, 1 + 2 * i);
    const Quaterniond turned(v[3] / 32768, v[0] / 32768, v[1] / 32768, v[2] / 32768);
    if (!(std::abs(turned.norm() - 1) < 0.1)) return;
    Turn(NameOf(from, id), now_ns, turned.normalized(), Vector3d(v[4], v[5], v[6]) / 128, packet);
  } else if (type == kAcceleration) {
    Sensor* sensor = Known(NameOf(from, bytes.size() > 12 ? bytes[12] : 0));
    const auto acceleration = ReadVector(bytes, 0);
    if (sensor && acceleration) sensor->acceleration_mps2 = *acceleration;
  } else if (type == kBattery && bytes.size() >= 8) {
    Sensor* sensor = Known(from);
    const auto level = ReadBig<float>(bytes, 4);
    if (sensor && level >= 0 && level <= 1) {
      sensor->battery_percent = static_cast<std::uint8_t>(std::lround(100 * level));
    }
  } else if (type == kSensorInfo && bytes.size() >= 2) {
    packet.replies.push_back(BigEndian(kSensorInfo) +
                             std::string{static_cast<char>(bytes[0]), static_cast<char>(bytes[1])});
  }
}

void SensorPackets::Turn(const std::string& name, std::int64_t now_ns, const Quaterniond& R_WS,
                         const std::optional<Vector3d>& acceleration_mps2, SensorPacket& packet) {
  Sensor* sensor = Of(name);
  if (sensor == nullptr) return;
  if (acceleration_mps2) sensor->acceleration_mps2 = *acceleration_mps2;
  auto& rotations = sensor->rotations;
  rotations[now_ns] = R_WS;
  // The newest one that is older than the window is its beginning.
  while (rotations.size() > 2 && std::next(rotations.begin())->first <= now_ns - kRateWindowNs) {
    rotations.erase(rotations.begin());
  }
  const auto& [before_ns, before] = *rotations.begin();
  const double window_s = NanosecondsToSeconds(now_ns - before_ns);
  const bool has_rate = window_s >= NanosecondsToSeconds(kRateWindowNs) / 2 && window_s < 0.5;
  if (has_rate) {
    const Eigen::AngleAxisd turned(before.conjugate() * R_WS);
    const double angle = turned.angle() > kPi ? turned.angle() - 2 * kPi : turned.angle();
    sensor->rate_radps = turned.axis() * angle / window_s;
  } else if (window_s >= 0.5) {
    rotations = {{now_ns, R_WS}};
  }
  if (now_ns - sensor->heartbeat_ns >= kHeartbeatNs) {
    // A tracker that hears nothing begins again.
    sensor->heartbeat_ns = now_ns;
    packet.replies.push_back(BigEndian(kServersHeartbeat) + std::string(8, '\0'));
  }
  const Vector3d up_mps2(0, 0, kStandardGravityMps2);
  Add(name, *sensor, now_ns, R_WS.conjugate() * up_mps2 + sensor->acceleration_mps2, has_rate,
      packet);
}

void SensorPackets::TakeOsc(const std::string& from, std::int64_t now_ns, Bytes bytes,
                            SensorPacket& packet) {
  if (!osc::Read(bytes, osc_)) return;
  packet.is_known = true;
  for (const osc::Message& message : osc_.messages) {
    const std::string_view what = message.address.substr(message.address.rfind('/'));
    const auto value = ThreeNumbers(osc_.Of(message));
    if (!value || std::ranges::find(kOscNames, what) == kOscNames.end()) continue;
    Sensor* sensor = Of(from);
    if (sensor == nullptr) continue;
    const bool has_rate = sensor->rate_ns > 0 && now_ns - sensor->rate_ns < kRateLastsNs;
    if (what == "/gyroscope" || what == "/gyro") {
      sensor->rate_radps = *value;
      sensor->rate_ns = now_ns;
    } else if (what == "/gravity") {
      sensor->gravity_g = *value;
    } else if (what == "/accelerometer") {
      Add(from, *sensor, now_ns, *value, has_rate, packet);
    } else if (what == "/accel" && sensor->gravity_g) {
      // Core Motion's accelerations point the other way.
      Add(from, *sensor, now_ns, -kStandardGravityMps2 * (*sensor->gravity_g + *value), has_rate,
          packet);
    }
  }
}

void SensorPackets::Add(const std::string& name, Sensor& sensor, std::int64_t now_ns,
                        const Vector3d& specific_force_mps2, bool has_rate,
                        SensorPacket& packet) const {
  std::vector<std::uint8_t> report = {kReportId, has_rate ? kHasRate : std::uint8_t{0}, 0,
                                      sensor.battery_percent};
  Append(++sensor.number, report);
  Append(static_cast<std::uint64_t>(now_ns / 1000), report);
  report.push_back(1);
  Append(std::uint32_t{0}, report);
  Append(specific_force_mps2, report);
  Append(has_rate ? sensor.rate_radps : Vector3d(Vector3d::Zero()), report);
  packet.reports.push_back({name, std::move(report)});
}

}  // namespace footing::stream_client
