#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>

#include "common/stream/device.h"
#include "daemon/sensor/reports/extension.h"

/// The Nunchuk's stick and accelerometer, to SI in its own sensor frame S.
///
///        front (C, Z)                raw +x: left            S: x = + raw x   (left)
///            ^ y_S                   raw +y: rear (cable         y = - raw y   (front)
///         .-----.                            at the front)       z = - raw z   (down)
///        /       \                   raw +z: up, out of the stick
///  x_S  |   (o)   | seen from above,
///  <--- |  stick  | stick up         Held still with the stick up: raw z reads +1 g, and in S it
///  is
///        \       /                   (0, 0, -9.81).
///         `-----'
///
/// The raw signs are those of the Wiimote: WiiBrew's Nunchuk page has x rise as it is tilted to the
/// right (left side up), y as it is tilted forwards (rear up), z with the right side up; Dolphin
/// reads both with the same axes.
namespace footing::calibration {

struct NunchukCalibration {
  std::array<int, 3> zero_counts{0x200, 0x200, 0x200};   ///< Of 10 bits, raw axes.
  std::array<int, 3> one_g_counts{0x2cc, 0x2cc, 0x2cc};  ///< Above zero_counts by 100 to 400.
  struct Stick {
    int low = 32;
    int middle = 128;
    int high = 224;
  };
  Stick stick_x;
  Stick stick_y;
  stream::CalibrationOrigin origin = stream::CalibrationOrigin::kDefaults;
  std::string problem;  ///< What is wrong with the device's own blocks; empty when nothing is.
};

inline constexpr std::uint32_t kNunchukBlockAddress = 0xa40020;  ///< Registers; two blocks.
/// The copy that an active MotionPlus keeps of its child's first block.
inline constexpr std::uint32_t kPassedNunchukBlockAddress = 0xa40040;
inline constexpr std::uint16_t kNunchukBlockBytes = 16;

/// From 32 bytes (16 of the MotionPlus' copy; fewer when the read failed): the first good block,
/// else typical values. A block is good when both checksums are right (sum of 14 bytes + 0x55, and
/// that + 0x55) and its accelerometer's numbers are possible. A good block with an impossible stick
/// keeps its accelerometer, takes a typical stick and says so.
NunchukCalibration ParseNunchuk(reports::Bytes blocks);

struct NunchukReading {
  double stick_x = 0;  ///< -1 left to 1 right.
  double stick_y = 0;  ///< -1 back to 1 front.
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;  ///< Bits 0, 1, 2: x, y, z at the end of the count range.
};

NunchukReading Calibrate(const NunchukCalibration& calibration,
                         const reports::NunchukCounts& counts);

}  // namespace footing::calibration
