#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>

#include "common/stream/device.h"
#include "daemon/sensor/reports/input_report.h"

/// Counts to SI, in the sensor frame S.
///
///        front (camera)              raw +x: left          S: x = + raw x   (left)
///            ^ y_S                   raw +y: rear             y = - raw y   (front)
///            |                       raw +z: up, out of       z = - raw z   (down)
///      +-----------+                         the buttons
///      |  [ + ]    |  seen from above,
///  x_S |           |  buttons up       z_S points into the table.
///  <---|   (A)     |
///      |           |  An accelerometer shows specific force: at rest it points up, so held
///      |  o  o  o  |  still face up the raw reading is +1 g in z, and in S it is (0, 0, -9.81).
///      |           |  Left side up: (+9.81, 0, 0). Front up: (0, +9.81, 0).
///      +-----------+
///         (port)
///
/// S is Figure 3 of the gait paper ("toward the left, front, and downwards"). The raw signs are
/// WiiBrew's "Wiimote/Motion Analysis" (1 g is read in z with A up, in y with the extension port
/// up, in x with the left side up); Dolphin's emulated accelerometer (x = left - right,
/// y = backward - forward, z = up - down) and Unity's WiimoteApi say the same.
namespace footing::calibration {

struct AccelerationCalibration {
  std::array<int, 3> zero_counts{0x200, 0x200, 0x200};   ///< Of 10 bits, raw axes.
  std::array<int, 3> one_g_counts{0x268, 0x268, 0x268};  ///< Above zero_counts by 60 to 160.
  stream::CalibrationOrigin origin = stream::CalibrationOrigin::kDefaults;
  std::string problem;  ///< What is wrong with the device's own blocks; empty when nothing is.
};

inline constexpr std::uint16_t kAccelerationBlockAddress = 0x0016;  ///< EEPROM; two blocks.
inline constexpr std::size_t kAccelerationBlockBytes = 10;

/// From the 20 bytes at kAccelerationBlockAddress (fewer when the read failed): the first good
/// block, else typical values (0x80 and 0x9a of 8 bits). A block is good when its checksum (sum of
/// nine bytes + 0x55) is right and its numbers are possible, so never a division by zero.
AccelerationCalibration ParseAcceleration(reports::Bytes blocks);

struct Acceleration {
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;  ///< Bits 0, 1, 2: x, y, z at the end of the count range.
};

/// 1 g is standard gravity. A count whose upper 8 bits are 0 or 255 is clipped.
Acceleration Calibrate(const AccelerationCalibration& calibration,
                       const std::array<std::uint16_t, 3>& counts);

}  // namespace footing::calibration
