#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>

#include "common/stream/device.h"
#include "daemon/sensor/reports/extension.h"

/// The MotionPlus' gyroscope, to SI in the Wiimote's sensor frame S (see acceleration.h).
///
///        front (camera)              c = (raw - zero) / (scale - zero) * degrees, of each axis
///            ^ y_S
///            |                       S: x = - c pitch   about left:  positive tips the front down
///      +-----------+                    y = - c roll    about front: positive tips the left up
///  x_S |           | seen from above    z = + c yaw     about down:  positive turns the front
///  right
///  <---|    (x)    | z_S into the
///      |           | table           All by the right-hand rule.
///      +-----------+
///
/// The signs are Dolphin's, which found that the calibrated values do not follow the right-hand
/// rule: in its frame (x left, y rear, z up) they are (-pitch, +roll, -yaw) (MotionPlus.cpp,
/// GetAngularVelocity). Turning that frame about x by 180 degrees gives S. Yaw and pitch of real
/// units have scale < zero, so their raw counts fall where c rises.
namespace footing::calibration {

struct MotionPlusCalibration {
  struct Range {
    std::array<int, 3> zero{};   ///< Of 16 bits, four times a packet's counts; yaw, roll, pitch.
    std::array<int, 3> scale{};  ///< At `degrees_per_s`.
    double degrees_per_s = 0;
  };
  /// As long as nothing was read: typical. Zero in the middle, 8192 counts are 2000 degrees/s fast
  /// and 440 slow, with the signs of real units.
  Range fast{{0x8000, 0x8000, 0x8000}, {13107, 52429, 13107}, 1200};  // 0x8000 -+ 32768*1200/2000
  Range slow{{0x8000, 0x8000, 0x8000}, {12660, 52876, 12660}, 270};   // 0x8000 -+ 32768*270/440
  stream::CalibrationOrigin origin = stream::CalibrationOrigin::kDefaults;
  std::string problem;  ///< Why the device's own block is not used; empty when it is.
};

/// Registers; of an active MotionPlus it is at 0xa40020 instead.
inline constexpr std::uint32_t kMotionPlusBlockAddress = 0xa60020;
inline constexpr std::uint32_t kActiveMotionPlusBlockAddress = 0xa40020;
inline constexpr std::uint16_t kMotionPlusBlockBytes = 32;

/// The block is used when its CRC-32 is right (over bytes 0 to 13 and 16 to 29; upper half at 14,
/// lower half at 30), degrees are not 0 and every scale is well off its zero. Anything else gives
/// typical values and the problem by name.
MotionPlusCalibration ParseMotionPlus(reports::Bytes block);

struct GyroscopeReading {
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();
  bool clipped = false;  ///< An axis is at the end of its 14 bits.
};

/// Each axis by the range that it has in this packet. The bias is not taken off: GyroscopeBias.
GyroscopeReading Calibrate(const MotionPlusCalibration& calibration,
                           const reports::MotionPlusCounts& counts);

}  // namespace footing::calibration
