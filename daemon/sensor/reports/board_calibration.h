#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "common/base/units.h"
#include "common/stream/device.h"
#include "daemon/sensor/reports/input_report.h"

namespace footing::calibration {

/// Counts of each corner (order of reports::Corner) under 0, 17 and 34 kg.
struct BoardCalibration {
  std::array<std::array<int, reports::kCorners>, 3> counts{};
  /// The temperature byte at calibration; none when the device's is impossible (0 or FF).
  bool has_reference_temperature = false;
  std::uint8_t reference_temperature = 0;
  stream::CalibrationOrigin origin = stream::CalibrationOrigin::kDefaults;
  std::string problem;  ///< Why the device's own block is not used; empty when it is.
};

/// Registers that hold it.
inline constexpr std::uint32_t kBoardBlockAddress = 0xa40020;
inline constexpr std::uint16_t kBoardBlockBytes = 32;  ///< Reference bytes, 24 counts, CRC-32.
inline constexpr std::uint32_t kBoardTemperatureAddress = 0xa40060;
inline constexpr std::uint16_t kBoardTemperatureBytes = 2;

/// Typical values, so that an uncalibrated board still shows something; never equal points.
BoardCalibration DefaultBoard();

/// The block is used when it is not all FF or 00, its CRC-32 (zlib's; over bytes 4 to 27, 0 to 1
/// and the temperature bytes; after Dolphin's BalanceBoard.cpp) is right and its points rise.
/// Anything else gives DefaultBoard() and the problem by name.
BoardCalibration ParseBoard(reports::Bytes block, reports::Bytes temperature);

/// Forces in N, in the order of reports::Corner: piecewise linear through 0, 17 and 34 kg, with
/// the outer slopes going on below 0 and above 34 kg, never clamped. As WiiBrew and
/// hid-wiimote-plus have it, kg * 0.99908 * (1 - 0.007 * (T - T_reference) / 10); without a
/// temperature or a reference only the first factor.
///
/// The cells feel weight, which differs by 0.5 % between equator and pole. `local_gravity_mps2`, of
/// the place where the board stands, is divided out: what comes back is the force that the same
/// mass has under standard gravity, under which the points are taken to be made. So force /
/// standard gravity is the mass everywhere. Left at standard gravity nothing is changed.
std::array<double, reports::kCorners> CornerForces(
    const BoardCalibration& calibration, const reports::BoardCounts& counts,
    double local_gravity_mps2 = kStandardGravityMps2);

}  // namespace footing::calibration
