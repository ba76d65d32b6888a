#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/stream/device.h"
#include "daemon/sensor/reports/output_report.h"

/// Reports of the Switch's controllers over Bluetooth: bytes to counts, and back.
///
/// The layout is that of dekuNukem's notes ("bluetooth_hid_notes",
/// "bluetooth_hid_subcommands_notes") and of the kernel's hid-nintendo, which agree, except where
/// recorded traffic shows otherwise: the first of the three samples of a report is the newest, as
/// in SDL.
namespace footing::reports {

enum class JoyconModel { kLeft, kRight, kPro };

inline constexpr std::size_t kJoyconReportBytes = 49;  ///< Both ways, the id byte included.
inline constexpr std::uint8_t kJoyconRumble = 0x10;
inline constexpr std::uint8_t kJoyconCommand = 0x01;
inline constexpr std::uint8_t kJoyconSimple = 0x3f;
inline constexpr std::uint8_t kJoyconMotion = 0x30;
inline constexpr std::uint8_t kJoyconReplyId = 0x21;

/// Subcommands. Those that write the device's memory or its pairing are never sent.
enum class Subcommand : std::uint8_t {
  kDeviceInfo = 0x02,
  kReportMode = 0x03,
  kReadMemory = 0x10,
  kLamps = 0x30,
  kMotionSensor = 0x40,
  kVibration = 0x48,
};

/// Buttons: byte 3 of a report in bits 0 to 7 (right side), byte 4 in bits 8 to 15 (shared), byte 5
/// in bits 16 to 23 (left side).
enum JoyconButton : std::uint32_t {
  kJoyconY = 0x01,
  kJoyconX = 0x02,
  kJoyconB = 0x04,
  kJoyconA = 0x08,
  kJoyconR = 0x40,
  kJoyconZr = 0x80,
  kJoyconMinus = 0x100,
  kJoyconPlus = 0x200,
  kJoyconRightStick = 0x400,
  kJoyconLeftStick = 0x800,
  kJoyconHome = 0x1000,
  kJoyconCapture = 0x2000,
  kJoyconDown = 0x10000,
  kJoyconUp = 0x20000,
  kJoyconRight = 0x40000,
  kJoyconLeft = 0x80000,
  kJoyconL = 0x400000,
  kJoyconZl = 0x800000,
};

/// Raw axes x to the triggers, y left, z out of the buttons; y and z the other way of a right one.
struct JoyconSample {
  std::array<std::int16_t, 3> acceleration{};
  std::array<std::int16_t, 3> angular_velocity{};

  bool operator==(const JoyconSample&) const = default;
};

/// 12 bits each, rising to the right and to the front.
struct JoyconStick {
  std::uint16_t x = 0;
  std::uint16_t y = 0;

  bool operator==(const JoyconStick&) const = default;
};

/// A reply to a subcommand.
struct JoyconReply {
  bool acknowledged = false;
  std::uint8_t subcommand = 0;
  std::array<std::uint8_t, 34> data{};
};

/// An input report. Of one in simple mode nothing but its id is read.
struct JoyconReport {
  std::uint8_t id = 0;
  std::uint8_t timer = 0;    ///< 5 ms a count.
  std::uint8_t battery = 0;  ///< 0 empty to 4 full.
  bool charging = false;
  std::uint32_t buttons = 0;            ///< Bits of JoyconButton.
  std::array<JoyconStick, 2> sticks;    ///< Left, right.
  std::optional<JoyconReply> reply;     ///< In report 21.
  bool has_samples = false;             ///< In reports 30 to 33.
  std::array<JoyconSample, 3> samples;  ///< Older first.
};

/// None when the id is unknown or the bytes end too early; longer ones are taken.
std::optional<JoyconReport> DecodeJoycon(Bytes report);

/// A subcommand with neutral rumble and packet number 0; both are put in when it is written.
OutputReport JoyconCommand(Subcommand subcommand, std::span<const std::uint8_t> arguments);
/// Asks for `size` bytes of memory, at most 29.
OutputReport JoyconRead(std::uint32_t address, std::uint8_t size);
/// Rumble alone, off.
OutputReport JoyconRumbleOnly();
/// Every output report has the motor's eight bytes. At rest they must be exactly these, or some
/// copies rumble for ever (SDL).
void SetJoyconRumble(OutputReport& report, bool on);

/// Where in memory, and how many bytes.
struct JoyconBlock {
  std::uint32_t address = 0;
  std::uint8_t size = 0;
};
inline constexpr JoyconBlock kJoyconFactoryMotion = {0x6020, 24};
inline constexpr JoyconBlock kJoyconUserMotion = {0x8026, 26};  ///< Two bytes of mark first.
inline constexpr JoyconBlock kJoyconFactorySticks = {0x603d, 18};
inline constexpr JoyconBlock kJoyconUserSticks = {0x8010, 22};  ///< The same, twice.

/// Bytes of this block in the reply; empty when it is another's.
std::span<const std::uint8_t> BlockIn(const JoyconReply& reply, const JoyconBlock& block);

/// More than a subcommand in this time disconnects a controller (hid-nintendo).
inline constexpr std::int64_t kJoyconWriteIntervalNs = 25'000'000;
/// One count of the timer byte: 5.00 ms within 1 % in recorded traffic.
inline constexpr std::int64_t kJoyconTickNs = 5'000'000;

/// A controller's own time by the timer byte of its reports, as long as that keeps to the arrivals:
/// some copies count otherwise. A plain value.
class JoyconTimer {
 public:
  /// Time since any instant, ns. None for the first report, after a pause in which the byte may
  /// have gone round, and while the byte is not to be trusted; from there it counts from another
  /// instant.
  std::optional<std::int64_t> Advance(std::int64_t received_ns, std::uint8_t count);

 private:
  bool started_ = false;
  bool trusted_ = true;
  std::uint8_t count_ = 0;
  std::int64_t own_ns_ = 0;
  std::int64_t received_ns_ = 0;
  std::int64_t window_ns_ = 0;  ///< Arrivals and counts since the last judgement.
  int window_counts_ = 0;
};

}  // namespace footing::reports

namespace footing::calibration {

/// One axis of a stick, counts.
struct JoyconStickAxis {
  double centre = 2048;
  double below = 1434;  ///< From the centre to either end: 70 % of the half range (SDL).
  double above = 1434;
};

/// A controller's calibration. The accelerometer has none: its counts over 4096 are g within 2 % on
/// all recorded units; subtracting the memory's "origin" makes that 12 %.
struct JoyconCalibration {
  std::array<double, 3> gyroscope_zero_counts{};           ///< By raw axis.
  std::array<double, 3> gyroscope_gain_radps{};            ///< A count.
  std::array<std::array<JoyconStickAxis, 2>, 2> sticks{};  ///< Left and right; x and y.
  std::array<bool, 2> stick_known{};                       ///< Else by typical values.
  stream::CalibrationOrigin origin = stream::CalibrationOrigin::kDefaults;
  std::string problem;  ///< Empty when the device's own is used.
};

/// Blocks as read; empty ones were not answered. The user's block counts when it has its mark and
/// is plausible, else the factory's; without either the typical values hold.
struct JoyconBlocks {
  std::vector<std::uint8_t> factory_motion, user_motion, factory_sticks, user_sticks;
};
JoyconCalibration ParseJoycon(const JoyconBlocks& blocks);

/// One sample in SI units, frame S (docs/devices.md): left and Pro (y, x, -z) of the raw axes,
/// right
/// (-y, x, z).
struct JoyconReading {
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;  ///< Accelerometer; bits 0, 1, 2: x, y, z of S.
  bool angular_velocity_clipped = false;
};
JoyconReading Calibrate(const JoyconCalibration& calibration, reports::JoyconModel model,
                        const reports::JoyconSample& sample);

/// -1 to 1, x to the right and y to the front.
Eigen::Vector2d StickOf(const std::array<JoyconStickAxis, 2>& axes,
                        const reports::JoyconStick& stick);

}  // namespace footing::calibration
