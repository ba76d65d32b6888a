#include "daemon/sensor/reports/board_calibration.h"

#include "daemon/sensor/reports/wiimote_calibration.h"

namespace footing::calibration {
namespace {

using reports::kCorners;

constexpr double kStepKg = 17;
constexpr std::size_t kFirstCount = 4;   // In the block.
constexpr std::size_t kCountBytes = 24;  // Three points of four corners.
constexpr std::size_t kChecksumAt = kFirstCount + kCountBytes;
constexpr double kFactor = 0.99908;
constexpr double kTemperatureSlope = 0.007 / 10;  // Relative, a degree.

std::uint32_t BigEndian32(reports::Bytes bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
         std::uint32_t{bytes[2]} << 8 | bytes[3];
}

BoardCalibration Refused(const std::string& problem) {
  BoardCalibration calibration = DefaultBoard();
  calibration.problem = "board calibration: " + problem + "; typical values are used";
  return calibration;
}

double Kilograms(const std::array<double, 3>& points, double counts) {
  const bool upper = counts >= points[1];
  const double low = upper ? points[1] : points[0];
  const double high = upper ? points[2] : points[1];
  return (upper ? kStepKg : 0) + kStepKg * (counts - low) / (high - low);
}

}  // namespace

BoardCalibration DefaultBoard() {
  // The middle of what was seen: 2800 to 8300 counts empty, 9.8 to 11.5 g a count.
  BoardCalibration calibration;
  calibration.counts[0].fill(5600);
  calibration.counts[1].fill(5600 + 1700);
  calibration.counts[2].fill(5600 + 3420);
  return calibration;
}

BoardCalibration ParseBoard(reports::Bytes block, reports::Bytes temperature) {
  if (block.size() < kBoardBlockBytes || temperature.size() < kBoardTemperatureBytes) {
    return Refused("not read");
  }
  const reports::Bytes points = block.subspan(kFirstCount, kCountBytes);
  if (AllEqual(points, 0xff)) return Refused("block is all FF");
  if (AllEqual(points, 0x00)) return Refused("block is all 00");
  BoardCalibration calibration;
  for (std::size_t i = 0; i < 3 * kCorners; ++i) {
    calibration.counts[i / kCorners][i % kCorners] = points[2 * i] << 8 | points[2 * i + 1];
  }
  for (std::size_t i = 0; i < kCorners; ++i) {
    const int zero = calibration.counts[0][i];
    const int middle = calibration.counts[1][i];
    const int full = calibration.counts[2][i];
    if (zero == middle || middle == full) return Refused("two points of a corner are equal");
    if (zero > middle || middle > full) return Refused("points of a corner do not rise");
  }
  if (Crc32({points, block.first(2), temperature.first(kBoardTemperatureBytes)}) !=
      BigEndian32(block.subspan(kChecksumAt, 4))) {
    return Refused("checksum is wrong");
  }
  calibration.reference_temperature = temperature[0];
  calibration.has_reference_temperature = temperature[0] != 0x00 && temperature[0] != 0xff;
  calibration.origin = stream::CalibrationOrigin::kDevice;
  return calibration;
}

std::array<double, kCorners> CornerForces(const BoardCalibration& calibration,
                                          const reports::BoardCounts& counts,
                                          double local_gravity_mps2) {
  double correction = kFactor * kStandardGravityMps2 / local_gravity_mps2;
  if (counts.has_temperature && calibration.has_reference_temperature) {
    correction *= 1 - kTemperatureSlope * (counts.temperature - calibration.reference_temperature);
  }
  std::array<double, kCorners> forces{};
  for (std::size_t i = 0; i < kCorners; ++i) {
    const std::array<double, 3> points = {double(calibration.counts[0][i]),
                                          double(calibration.counts[1][i]),
                                          double(calibration.counts[2][i])};
    forces[i] = KilogramsToNewtons(Kilograms(points, counts.corners[i]) * correction);
  }
  return forces;
}

}  // namespace footing::calibration
