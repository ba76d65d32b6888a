#include "daemon/sensor/reports/inertial_report.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "common/base/units.h"

namespace footing::reports {
namespace {

constexpr std::size_t kInertialHeadBytes = 15;
constexpr std::size_t kInertialSampleBytes = 28;
constexpr double kMostForceMps2 = 1000;
constexpr double kMostRateRadps = 200;
constexpr std::uint8_t kUnknownBattery = 255;
/// Times up to 200 years fit into nanoseconds.
constexpr std::uint64_t kMostTimeUs = std::uint64_t{200} * 365 * 24 * 3600 * 1'000'000;

template <typename Value>
Value Read(Bytes bytes, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  Value value;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

/// From the sensor's axes (x right, y ahead, z up) into S (x left, y front, z down).
Eigen::Vector3d ReadInS(Bytes bytes, std::size_t at) {
  return {-Read<float>(bytes, at), Read<float>(bytes, at + 4), -Read<float>(bytes, at + 8)};
}

}  // namespace

std::optional<InertialReport> DecodeInertial(Bytes bytes) {
  if (bytes.size() < kInertialHeadBytes || bytes[0] != kInertialInput) return std::nullopt;
  InertialReport report;
  report.count = bytes[14];
  if (report.count < 1 || report.count > kMostInertialSamples) return std::nullopt;
  if (bytes.size() != kInertialHeadBytes + report.count * kInertialSampleBytes) return std::nullopt;
  const std::uint8_t flags = bytes[1];
  report.has_rate = (flags & kInertialHasRate) != 0;
  report.buttons = bytes[2];
  if (bytes[3] != kUnknownBattery) report.battery_fraction = std::min<int>(bytes[3], 100) / 100.0;
  report.number = Read<std::uint16_t>(bytes, 4);
  const auto newest_us = Read<std::uint64_t>(bytes, 6);
  if (newest_us > kMostTimeUs) return std::nullopt;
  const double sign = (flags & kInertialInverted) != 0 ? -1 : 1;
  const double unit = (flags & kInertialDegrees) != 0 ? kPi / 180 : 1;
  std::uint32_t before_us = std::numeric_limits<std::uint32_t>::max();
  for (std::size_t i = 0; i < report.count; ++i) {
    const std::size_t at = kInertialHeadBytes + i * kInertialSampleBytes;
    InertialSample& sample = report.samples[i];
    const auto age_us = Read<std::uint32_t>(bytes, at);
    if (age_us > before_us || age_us > newest_us) return std::nullopt;
    before_us = age_us;
    sample.device_ns = static_cast<std::int64_t>(newest_us - age_us) * 1000;
    sample.specific_force_S_mps2 = sign * ReadInS(bytes, at + 4);
    // Comparisons with a NaN are false.
    if (!(sample.specific_force_S_mps2.norm() <= kMostForceMps2)) return std::nullopt;
    if (!report.has_rate) continue;
    sample.angular_velocity_S_radps = unit * ReadInS(bytes, at + 16);
    if (!(sample.angular_velocity_S_radps.norm() <= kMostRateRadps)) return std::nullopt;
  }
  return report;
}

}  // namespace footing::reports
