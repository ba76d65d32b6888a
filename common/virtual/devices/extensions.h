#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "common/base/units.h"

/// Extensions of a Wiimote, as registers and six data bytes: Nunchuk, Classic
/// Controller, MotionPlus.
namespace footing::virtual_devices {

enum class Accessory { kNone, kNunchuk, kClassic, kMotionPlus, kUnknown };

using ExtensionBytes = std::array<std::uint8_t, 6>;

/// True input of a Nunchuk, in its own frame S (x left, y front, z down).
struct NunchukSensors {
  double stick_x = 0;  ///< -1 left to 1 right.
  double stick_y = 0;  ///< -1 back to 1 front.
  bool c = false;
  bool z = false;
  Eigen::Vector3d specific_force_S_mps2{0, 0, -kStandardGravityMps2};
};

/// Input of a gamepad's user; bits of `buttons` as in the data bytes: byte 4 of a Classic
/// Controller in bits 8 to 15, byte 5 in bits 0 to 7, 1 pressed.
struct GamepadSensors {
  double left_x = 0;  ///< -1 left to 1 right, -1 back to 1 front.
  double left_y = 0;
  double right_x = 0;
  double right_y = 0;
  double left_trigger = 0;  ///< 0 to 1.
  double right_trigger = 0;
  std::uint16_t buttons = 0;
};

using NunchukBlock = std::array<std::uint8_t, 16>;
using MotionPlusBlock = std::array<std::uint8_t, 32>;

/// Calibration blocks with right checksums, drawn around those of real units.
NunchukBlock DrawNunchukBlock(std::uint64_t seed);
MotionPlusBlock DrawMotionPlusBlock(std::uint64_t seed);

/// CRC-32 of bytes 0 to 13 and 16 to 29; upper half at 14, lower half at 30.
void PutMotionPlusChecksum(MotionPlusBlock& block);

/// Register pages of 256 bytes. `inside`: built into the Wiimote.
std::vector<std::uint8_t> NunchukPage(const NunchukBlock& block);
std::vector<std::uint8_t> ClassicPage();
std::vector<std::uint8_t> UnknownPage();
std::vector<std::uint8_t> MotionPlusPage(const MotionPlusBlock& block, bool inside);

/// Data bytes of a Nunchuk, by its own calibration; ends at the range of the counts.
ExtensionBytes NunchukBytes(const NunchukBlock& block, const NunchukSensors& sensors);
/// By nominal ranges: 6 bits of the left stick, 5 of the right one and the triggers.
ExtensionBytes ClassicBytes(const GamepadSensors& sensors = {});

/// The same behind an active MotionPlus, which takes the lowest bits for its own marks.
ExtensionBytes PassedNunchuk(const ExtensionBytes& plain);
ExtensionBytes PassedClassic(const ExtensionBytes& plain);

/// A packet of the gyroscope. Each axis is in the slow range as far as that goes. In S of the
/// Wiimote, right-handed: yaw is about +z, pitch about -x, roll about -y.
ExtensionBytes MotionPlusBytes(const MotionPlusBlock& block,
                               const Eigen::Vector3d& angular_velocity_S_radps,
                               bool extension_connected);

}  // namespace footing::virtual_devices
