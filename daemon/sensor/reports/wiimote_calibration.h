#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>

#include <Eigen/Core>

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

/// Zeros and 1 g readings of a Wiimote's accelerometer.
struct AccelerationCalibration {
  std::array<int, 3> zero_counts{0x200, 0x200, 0x200};   ///< Counts of 10 bits, raw axes.
  std::array<int, 3> one_g_counts{0x268, 0x268, 0x268};  ///< Above zero_counts by 60 to 160.
  stream::CalibrationOrigin origin = stream::CalibrationOrigin::kDefaults;
  std::string problem;  ///< Error in the device's own blocks; empty when there is none.
};

inline constexpr std::uint16_t kAccelerationBlockAddress = 0x0016;  ///< EEPROM; two blocks.
inline constexpr std::size_t kAccelerationBlockBytes = 10;

/// From the 20 bytes at kAccelerationBlockAddress (fewer when the read failed): the first good
/// block, else typical values (0x80 and 0x9a of 8 bits). A block is good when its checksum (sum of
/// nine bytes + 0x55) is right and its numbers are possible, so never a division by zero.
AccelerationCalibration ParseAcceleration(reports::Bytes blocks);

/// Specific force in SI units, frame S.
struct Acceleration {
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;  ///< Bits 0, 1, 2: x, y, z at the end of the count range.
};

/// 1 g is standard gravity. A count whose upper 8 bits are 0 or 255 is clipped.
Acceleration Calibrate(const AccelerationCalibration& calibration,
                       const std::array<std::uint16_t, 3>& counts);

/// Checksum of the EEPROM's and the Nunchuk's blocks: the bytes' sum + 0x55, 8 bits.
std::uint8_t SumChecksum(reports::Bytes bytes);

/// Whether the block's last byte is the SumChecksum of those before it; true of the camera's block
/// (11 bytes at EEPROM 0x0000 and 0x000b) and the accelerometer's.
bool EndsInSumChecksum(reports::Bytes block);

/// CRC-32 of zlib over several pieces as if they were one.
std::uint32_t Crc32(std::initializer_list<reports::Bytes> pieces);

/// All the same byte, as a device gives that has nothing stored.
bool AllEqual(reports::Bytes bytes, std::uint8_t value);

/// Bias of a gyroscope, its reading at rest, estimated again whenever the device lies still.
///
/// Still: for a whole window the specific force is near 1 g and the angular velocity hardly varies
/// and is within what a bias can be. The window's mean is the bias then; otherwise the last one
/// stays. A turn at a slow constant rate about the vertical looks the same; nobody's hand does
/// that.
class GyroscopeBias {
 public:
  static constexpr double kWindowS = 1;
  static constexpr int kMinSamples = 20;
  static constexpr double kMaxGapS = 0.25;            ///< A longer one restarts the window.
  static constexpr double kMaxForceErrorMps2 = 0.6;   ///< Limit of | |f| - g | in each sample.
  static constexpr double kMaxDeviationRadps = 0.02;  ///< Standard deviation of each axis.
  /// An uncalibrated MotionPlus is 300 counts off, 16 degrees/s in the slow range.
  static constexpr double kMaxBiasRadps = 0.6;

  /// One sample, both vectors in the same frame. Samples that are not finite or go back in time
  /// restart the window.
  void Take(std::int64_t sampled_ns, const Eigen::Vector3d& specific_force_mps2,
            const Eigen::Vector3d& angular_velocity_radps);

  /// To be taken off; zero as long as the device has not been still.
  const Eigen::Vector3d& bias_radps() const { return bias_radps_; }
  bool known() const { return known_; }

 private:
  void Begin(std::int64_t sampled_ns);

  Eigen::Vector3d bias_radps_ = Eigen::Vector3d::Zero();
  bool known_ = false;

  // The window under way.
  int samples_ = 0;
  std::int64_t first_ns_ = 0;
  std::int64_t newest_ns_ = 0;
  Eigen::Vector3d mean_radps_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares_radps2_ = Eigen::Vector3d::Zero();  // Sum of squared deviations.
};

/// The MotionPlus' gyroscope, to SI in the Wiimote's sensor frame S.
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
struct MotionPlusCalibration {
  struct Range {
    std::array<int, 3> zero{};   ///< Counts of 16 bits, four times a packet's; yaw, roll, pitch.
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
inline constexpr std::uint16_t kMotionPlusBlockBytes = 32;

/// The block is used when its CRC-32 is right (over bytes 0 to 13 and 16 to 29; upper half at 14,
/// lower half at 30), degrees are not 0 and every scale is well off its zero. Anything else gives
/// typical values and the problem by name.
MotionPlusCalibration ParseMotionPlus(reports::Bytes block);

/// Angular velocity in SI units, frame S.
struct GyroscopeReading {
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();
  bool clipped = false;  ///< An axis is at the end of its 14 bits.
};

/// Each axis by the range that it has in this packet. The bias is not taken off: GyroscopeBias.
GyroscopeReading Calibrate(const MotionPlusCalibration& calibration,
                           const reports::MotionPlusCounts& counts);

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
struct NunchukCalibration {
  std::array<int, 3> zero_counts{0x200, 0x200, 0x200};   ///< Counts of 10 bits, raw axes.
  std::array<int, 3> one_g_counts{0x2cc, 0x2cc, 0x2cc};  ///< Above zero_counts by 100 to 400.
  struct Stick {
    int low = 32;
    int middle = 128;
    int high = 224;
  };
  Stick stick_x;
  Stick stick_y;
  stream::CalibrationOrigin origin = stream::CalibrationOrigin::kDefaults;
  std::string problem;  ///< Error in the device's own blocks; empty when there is none.
};

inline constexpr std::uint32_t kNunchukBlockAddress = 0xa40020;  ///< Registers; two blocks.
inline constexpr std::uint16_t kNunchukBlockBytes = 16;

/// From 32 bytes (16 of the MotionPlus' copy; fewer when the read failed): the first good block,
/// else typical values. A block is good when both checksums are right (sum of 14 bytes + 0x55, and
/// that + 0x55) and its accelerometer's numbers are possible. A good block with an impossible stick
/// keeps its accelerometer, takes a typical stick and says so.
NunchukCalibration ParseNunchuk(reports::Bytes blocks);

/// Stick and specific force of a Nunchuk, in its frame S.
struct NunchukReading {
  double stick_x = 0;  ///< -1 left to 1 right.
  double stick_y = 0;  ///< -1 back to 1 front.
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;  ///< Bits 0, 1, 2: x, y, z at the end of the count range.
};

/// Converts counts to SI units.
NunchukReading Calibrate(const NunchukCalibration& calibration,
                         const reports::NunchukCounts& counts);

}  // namespace footing::calibration
