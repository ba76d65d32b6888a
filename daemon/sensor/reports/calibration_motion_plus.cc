#include "daemon/sensor/reports/calibration_motion_plus.h"

#include <cstdlib>
#include <numbers>

#include "daemon/sensor/reports/checksum.h"

namespace footing::calibration {
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

}  // namespace footing::calibration
