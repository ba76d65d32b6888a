#include "daemon/sensor/reports/inertial_report.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#include "common/base/units.h"

namespace footing::reports {
namespace {

constexpr std::size_t kInertialHeadBytes = 15;
constexpr std::size_t kInertialSampleBytes = 28;
constexpr double kMostForceMps2 = 1000;
constexpr double kMostRateRadps = 200;
constexpr std::uint8_t kUnknownBattery = 255;
constexpr double kUsualRangesMps2[] = {2 * kStandardGravityMps2, 4 * kStandardGravityMps2,
                                       8 * kStandardGravityMps2, 16 * kStandardGravityMps2};
/// Share by which a sensor's own gain moves its end: data sheets promise 1 to 3 %.
constexpr double kGainShare = 0.03;
/// Values at the end differ by a browser's steps of 0.1 m/s² and the calibration of each axis.
constexpr double kSameEndMps2 = 0.25;
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

/// A flag is for the whole report: along its axis, the samples at the end are the largest ones.
void MarkEnds(std::uint8_t flags, InertialReport& report) {
  for (int axis = 0; axis < 3; ++axis) {
    if ((flags & (kInertialEndX << axis)) == 0) continue;
    const auto along = [axis](const InertialSample& sample) {
      return std::abs(sample.specific_force_S_mps2(axis));
    };
    double most_mps2 = 0;
    for (std::size_t i = 0; i < report.count; ++i) {
      most_mps2 = std::max(most_mps2, along(report.samples[i]));
    }
    for (std::size_t i = 0; i < report.count; ++i) {
      if (along(report.samples[i]) < most_mps2 - kSameEndMps2) continue;
      report.samples[i].clipped_axes |= 1u << axis;
    }
  }
}

}  // namespace

std::uint32_t RangeEnd::AxesAt(const Eigen::Vector3d& specific_force_mps2) {
  const Eigen::Array3d sizes = specific_force_mps2.array().abs();
  most_mps2_ = std::max(most_mps2_, sizes.maxCoeff());
  const bool usual = std::any_of(
      std::begin(kUsualRangesMps2), std::end(kUsualRangesMps2), [this](double range_mps2) {
        return std::abs(most_mps2_ - range_mps2) <= kGainShare * range_mps2;
      });
  std::uint32_t axes = 0;
  for (int axis = 0; usual && axis < 3; ++axis) {
    if (sizes(axis) >= most_mps2_ - kSameEndMps2) axes |= 1u << axis;
  }
  return axes;
}

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
  report.knows_end = (flags & kInertialKnowsEnd) != 0;
  if (report.knows_end) MarkEnds(flags, report);
  return report;
}

}  // namespace footing::reports
