#include "daemon/sensor/reports/nunchuk.h"

#include <algorithm>

#include "common/base/units.h"
#include "daemon/sensor/reports/checksum.h"

namespace footing::calibration {
namespace {

using stream::CalibrationOrigin;

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

/// What makes a block unusable, or nothing; fills `calibration` from it.
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
