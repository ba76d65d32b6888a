#include "daemon/sensor/reports/wiimote_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

#include <zlib.h>

#include "common/base/units.h"

namespace footing::calibration {
namespace {

using stream::CalibrationOrigin;

/// Bounds of what a working sensor can have; real units: zero near 521, 1 g 105 to 111 above.
constexpr int kMinZero = 350;
constexpr int kMaxZero = 680;
constexpr int kMinOneG = 60;
constexpr int kMaxOneG = 160;

/// Signs of S's axes against the raw ones; see the header's picture.
constexpr std::array<double, 3> kSigns = {+1, -1, -1};

/// Three 10-bit values: bytes at..at+2 the upper bits, byte at+3 the lower ones of x, y, z from
/// bit 5 down.
std::array<int, 3> TenBits(reports::Bytes block, std::size_t at) {
  const int low = block[at + 3];
  return {block[at] << 2 | (low >> 4 & 3), block[at + 1] << 2 | (low >> 2 & 3),
          block[at + 2] << 2 | (low & 3)};
}

/// Error in a block, or nothing; fills `calibration` from it.
std::string ReadBlock(reports::Bytes block, AccelerationCalibration& calibration) {
  if (!EndsInSumChecksum(block)) return "checksum is wrong";
  const std::array<int, 3> zero = TenBits(block, 0);
  const std::array<int, 3> one_g = TenBits(block, 4);
  for (std::size_t i = 0; i < 3; ++i) {
    const int span = one_g[i] - zero[i];
    if (zero[i] <= kMinZero || zero[i] >= kMaxZero) return "zero point is impossible";
    if (span <= kMinOneG || span >= kMaxOneG) return "1 g is impossible";
  }
  calibration.zero_counts = zero;
  calibration.one_g_counts = one_g;
  return "";
}

}  // namespace

AccelerationCalibration ParseAcceleration(reports::Bytes blocks) {
  AccelerationCalibration calibration;
  constexpr CalibrationOrigin kOrigins[] = {CalibrationOrigin::kDevice,
                                            CalibrationOrigin::kDeviceCopy};
  std::string problems;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t at = i * kAccelerationBlockBytes;
    std::string problem = "not read";
    if (blocks.size() >= at + kAccelerationBlockBytes) {
      problem = ReadBlock(blocks.subspan(at, kAccelerationBlockBytes), calibration);
    }
    if (problem.empty()) {
      calibration.origin = kOrigins[i];
      calibration.problem = problems;
      return calibration;
    }
    if (!problems.empty()) problems += ", ";
    problems += (i == 0 ? "calibration block 1: " : "block 2: ") + problem;
  }
  calibration.problem = problems + "; typical values are used";
  return calibration;
}

Acceleration Calibrate(const AccelerationCalibration& calibration,
                       const std::array<std::uint16_t, 3>& counts) {
  Acceleration result;
  for (std::size_t i = 0; i < 3; ++i) {
    const int upper = counts[i] >> 2;
    if (upper <= 0 || upper >= 255) result.clipped_axes |= 1u << i;
    const double raw_g = static_cast<double>(counts[i] - calibration.zero_counts[i]) /
                         (calibration.one_g_counts[i] - calibration.zero_counts[i]);
    result.specific_force_S_mps2[static_cast<Eigen::Index>(i)] =
        kSigns[i] * raw_g * kStandardGravityMps2;
  }
  return result;
}

std::uint8_t SumChecksum(reports::Bytes bytes) {
  std::uint8_t sum = 0x55;
  for (const std::uint8_t byte : bytes) sum = static_cast<std::uint8_t>(sum + byte);
  return sum;
}

bool EndsInSumChecksum(reports::Bytes block) {
  return !block.empty() && SumChecksum(block.first(block.size() - 1)) == block.back();
}

std::uint32_t Crc32(std::initializer_list<reports::Bytes> pieces) {
  uLong crc = crc32(0, nullptr, 0);
  for (const reports::Bytes piece : pieces) {
    crc = crc32(crc, piece.data(), static_cast<uInt>(piece.size()));
  }
  return static_cast<std::uint32_t>(crc);
}

bool AllEqual(reports::Bytes bytes, std::uint8_t value) {
  return std::all_of(bytes.begin(), bytes.end(), [value](std::uint8_t b) { return b == value; });
}

void GyroscopeBias::Begin(std::int64_t sampled_ns) {
  samples_ = 0;
  first_ns_ = sampled_ns;
  newest_ns_ = sampled_ns;
  mean_radps_.setZero();
  squares_radps2_.setZero();
}

void GyroscopeBias::Take(std::int64_t sampled_ns, const Eigen::Vector3d& specific_force_mps2,
                         const Eigen::Vector3d& angular_velocity_radps) {
  if (samples_ == 0 || sampled_ns < newest_ns_ ||
      sampled_ns - newest_ns_ > SecondsToNanoseconds(kMaxGapS)) {
    Begin(sampled_ns);
  }
  const double force_error_mps2 = std::abs(specific_force_mps2.norm() - kStandardGravityMps2);
  // Written so that NaN is not still.
  const bool still = force_error_mps2 <= kMaxForceErrorMps2 && angular_velocity_radps.allFinite() &&
                     angular_velocity_radps.cwiseAbs().maxCoeff() <= kMaxBiasRadps;
  if (!still) {
    samples_ = 0;
    return;
  }
  // Welford's sums.
  ++samples_;
  newest_ns_ = sampled_ns;
  const Eigen::Vector3d before = angular_velocity_radps - mean_radps_;
  mean_radps_ += before / samples_;
  squares_radps2_ += before.cwiseProduct(angular_velocity_radps - mean_radps_);
  if (newest_ns_ - first_ns_ < SecondsToNanoseconds(kWindowS) || samples_ < kMinSamples) return;
  const double worst_variance = squares_radps2_.maxCoeff() / samples_;
  if (worst_variance <= kMaxDeviationRadps * kMaxDeviationRadps) {
    bias_radps_ = mean_radps_;
    known_ = true;
  }
  samples_ = 0;
}

namespace {

using Range = MotionPlusCalibration::Range;

constexpr std::size_t kRangeBytes = 16;
constexpr std::size_t kDegreesAt = 12;
constexpr std::size_t kSummedBytes = 14;
/// Real units have spans of 15000 to 24000.
constexpr int kMinSpan = 1000;
constexpr int kTopCount = 0x3fff;

struct Axis {
  Eigen::Index index;
  double sign;
};

/// Where yaw, roll and pitch go in S; see the header's picture.
constexpr std::array<Axis, 3> kAxes = {{{2, +1}, {1, -1}, {0, -1}}};

int BigEndian16(reports::Bytes bytes, std::size_t at) { return bytes[at] << 8 | bytes[at + 1]; }

Range ReadRange(reports::Bytes block) {
  Range range;
  for (std::size_t i = 0; i < 3; ++i) {
    range.zero[i] = BigEndian16(block, 2 * i);
    range.scale[i] = BigEndian16(block, 6 + 2 * i);
  }
  range.degrees_per_s = 6.0 * block[kDegreesAt];
  return range;
}

std::string ProblemOf(const Range& range) {
  if (range.degrees_per_s == 0) return "degrees are 0";
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(range.scale[i] - range.zero[i]) < kMinSpan) return "scale is at its zero";
  }
  return "";
}

std::string ReadBlock(reports::Bytes block, MotionPlusCalibration& calibration) {
  if (block.size() < kMotionPlusBlockBytes) return "not read";
  block = block.first(kMotionPlusBlockBytes);
  if (AllEqual(block, 0xff)) return "block is all FF";
  if (AllEqual(block, 0x00)) return "block is all 00";
  const auto stored = static_cast<std::uint32_t>(BigEndian16(block, kSummedBytes)) << 16 |
                      static_cast<std::uint32_t>(BigEndian16(block, kRangeBytes + kSummedBytes));
  if (Crc32({block.first(kSummedBytes), block.subspan(kRangeBytes, kSummedBytes)}) != stored) {
    return "checksum is wrong";
  }
  calibration.fast = ReadRange(block.first(kRangeBytes));
  calibration.slow = ReadRange(block.subspan(kRangeBytes));
  const std::string problem = ProblemOf(calibration.fast);
  return problem.empty() ? ProblemOf(calibration.slow) : problem;
}

}  // namespace

MotionPlusCalibration ParseMotionPlus(reports::Bytes block) {
  MotionPlusCalibration calibration;
  const std::string problem = ReadBlock(block, calibration);
  if (!problem.empty()) {
    calibration = MotionPlusCalibration();
    calibration.problem = "MotionPlus calibration: " + problem + "; typical values are used";
    return calibration;
  }
  calibration.origin = stream::CalibrationOrigin::kDevice;
  return calibration;
}

GyroscopeReading Calibrate(const MotionPlusCalibration& calibration,
                           const reports::MotionPlusCounts& counts) {
  GyroscopeReading reading;
  for (std::size_t i = 0; i < 3; ++i) {
    const Range& range = counts.slow[i] ? calibration.slow : calibration.fast;
    const double degrees_per_s = (4.0 * counts.counts[i] - range.zero[i]) /
                                 (range.scale[i] - range.zero[i]) * range.degrees_per_s;
    reading.angular_velocity_S_radps[kAxes[i].index] =
        kAxes[i].sign * degrees_per_s * std::numbers::pi / 180;
    if (counts.counts[i] == 0 || counts.counts[i] >= kTopCount) reading.clipped = true;
  }
  return reading;
}

namespace {

/// Bounds of what a working sensor can have; a real unit: zero near 500, 1 g 204 above.
constexpr int kNunchukMinZero = 350;
constexpr int kNunchukMaxZero = 680;
constexpr int kNunchukMinOneG = 100;
constexpr int kNunchukMaxOneG = 400;
/// Half the way of a real stick is near 100 counts.
constexpr int kMinStick = 40;

constexpr std::array<double, 3> kNunchukSigns = {+1, -1, -1};

constexpr std::size_t kStickAt = 8;
constexpr std::size_t kNunchukChecksumAt = 14;

/// Three 10-bit values: upper bits, then one byte of lower ones, x from bit 5 down as in the
/// Wiimote's block.
std::array<int, 3> NunchukTenBits(reports::Bytes block, std::size_t at) {
  const int low = block[at + 3];
  return {block[at] << 2 | (low >> 4 & 3), block[at + 1] << 2 | (low >> 2 & 3),
          block[at + 2] << 2 | (low & 3)};
}

/// Upper end, lower end, middle.
NunchukCalibration::Stick ReadStick(reports::Bytes block, std::size_t at) {
  return {block[at + 1], block[at + 2], block[at]};
}

bool Possible(const NunchukCalibration::Stick& stick) {
  return stick.middle - stick.low >= kMinStick && stick.high - stick.middle >= kMinStick;
}

/// Reason why a block is unusable, or nothing; fills `calibration` from it.
std::string ReadBlock(reports::Bytes block, NunchukCalibration& calibration) {
  if (AllEqual(block, 0x00)) return "all 00";
  if (AllEqual(block, 0xff)) return "all FF";
  const std::uint8_t sum = SumChecksum(block.first(kNunchukChecksumAt));
  if (sum != block[kNunchukChecksumAt] ||
      static_cast<std::uint8_t>(sum + 0x55) != block[kNunchukChecksumAt + 1]) {
    return "checksum is wrong";
  }
  const std::array<int, 3> zero = NunchukTenBits(block, 0);
  const std::array<int, 3> one_g = NunchukTenBits(block, 4);
  for (std::size_t i = 0; i < 3; ++i) {
    const int span = one_g[i] - zero[i];
    if (zero[i] <= kNunchukMinZero || zero[i] >= kNunchukMaxZero) return "zero point is impossible";
    if (span <= kNunchukMinOneG || span >= kNunchukMaxOneG) return "1 g is impossible";
  }
  calibration.zero_counts = zero;
  calibration.one_g_counts = one_g;
  const auto stick_x = ReadStick(block, kStickAt);
  const auto stick_y = ReadStick(block, kStickAt + 3);
  if (Possible(stick_x) && Possible(stick_y)) {
    calibration.stick_x = stick_x;
    calibration.stick_y = stick_y;
  } else {
    calibration.problem = "Nunchuk calibration: stick is impossible; a typical stick is used";
  }
  return "";
}

double Deflection(const NunchukCalibration::Stick& stick, int counts) {
  const int from_middle = counts - stick.middle;
  const int way = from_middle < 0 ? stick.middle - stick.low : stick.high - stick.middle;
  return std::clamp(from_middle / static_cast<double>(way), -1.0, 1.0);
}

}  // namespace

NunchukCalibration ParseNunchuk(reports::Bytes blocks) {
  NunchukCalibration calibration;
  constexpr CalibrationOrigin kOrigins[] = {CalibrationOrigin::kDevice,
                                            CalibrationOrigin::kDeviceCopy};
  std::string problems;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t at = i * kNunchukBlockBytes;
    std::string problem = "not read";
    if (blocks.size() >= at + kNunchukBlockBytes) {
      problem = ReadBlock(blocks.subspan(at, kNunchukBlockBytes), calibration);
    }
    if (problem.empty()) {
      calibration.origin = kOrigins[i];
      if (calibration.problem.empty()) calibration.problem = problems;
      return calibration;
    }
    problems += (i == 0 ? "Nunchuk calibration: block 1: " : ", block 2: ") + problem;
  }
  calibration.problem = problems + "; typical values are used";
  return calibration;
}

NunchukReading Calibrate(const NunchukCalibration& calibration,
                         const reports::NunchukCounts& counts) {
  NunchukReading reading;
  reading.stick_x = Deflection(calibration.stick_x, counts.stick_x);
  reading.stick_y = Deflection(calibration.stick_y, counts.stick_y);
  for (std::size_t i = 0; i < 3; ++i) {
    const int raw = counts.acceleration[i];
    if (raw >> 2 <= 0 || raw >> 2 >= 255) reading.clipped_axes |= 1u << i;
    const double raw_g = static_cast<double>(raw - calibration.zero_counts[i]) /
                         (calibration.one_g_counts[i] - calibration.zero_counts[i]);
    reading.specific_force_S_mps2[static_cast<Eigen::Index>(i)] =
        kNunchukSigns[i] * raw_g * kStandardGravityMps2;
  }
  return reading;
}

}  // namespace footing::calibration
