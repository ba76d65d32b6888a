#include "daemon/sensor/reports/acceleration.h"

#include <optional>

#include "common/base/units.h"
#include "daemon/sensor/reports/checksum.h"

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

/// What is wrong with a block, or nothing; fills `calibration` from it.
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

}  // namespace footing::calibration
