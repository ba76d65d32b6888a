#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// What crosses a process border, as plain structs: proto/footing/v1 says what each field means.
namespace footing::stream {

enum class DeviceKind {
  kUnspecified = 0,
  kWiimote = 1,
  kBalanceBoard = 2,
  kPsMove = 3,
  kProController = 4,
};

enum class Extension {
  kUnspecified = 0,
  kNone = 1,
  kNunchuk = 2,
  kClassic = 3,
  kMotionPlus = 4,
  kMotionPlusNunchuk = 5,
  kMotionPlusClassic = 6,
  kUnknown = 7,
};

enum class DeviceRole {
  kUnspecified = 0,
  kLeftHand = 1,
  kRightHand = 2,
  kLeftLeg = 3,
  kRightLeg = 4,
  kHead = 5,
  kLeftBoard = 6,
  kRightBoard = 7,
  kEditor = 8,
  kTrunk = 9,
  kLeftUpperArm = 10,
  kRightUpperArm = 11,
  kLeftForearm = 12,
  kRightForearm = 13,
};

enum class DeviceState { kUnspecified = 0, kConnecting = 1, kLive = 2, kStale = 3, kLost = 4 };

enum class CalibrationOrigin {
  kUnspecified = 0,
  kDevice = 1,
  kDeviceCopy = 2,
  kDefaults = 3,
  kStored = 4
};

/// Short names, as config files, command lines and screens use them: "left_hand", "live", ...
const char* Name(DeviceKind kind);
const char* Name(DeviceRole role);
const char* Name(DeviceState state);
const char* Name(CalibrationOrigin origin);
const char* Name(Extension extension);
/// The role of that name; kUnspecified when there is none.
DeviceRole RoleNamed(const std::string& name);
/// All roles: "left_hand, right_hand, ...", for errors.
std::string RoleNames();

/// The lamps that show a role, bits 0 to 3: left hand 1, right hand 2, left leg 3, right leg 4,
/// head 1 and 4, trunk 1 and 3, editor 2 and 3, left upper arm 1 and 2, right upper arm 2 and 4,
/// left forearm 1 to 3, right forearm 2 to 4. A board has the first lamp alone: lit on the left
/// one, dark on the right one. 0 without a role.
std::uint32_t LedsOf(DeviceRole role);

struct DeviceStatus {
  std::uint32_t device = 0;
  std::string serial;
  DeviceKind kind = DeviceKind::kUnspecified;
  DeviceState state = DeviceState::kUnspecified;
  std::string rig;
  DeviceRole role = DeviceRole::kUnspecified;
  bool simulated = false;
  CalibrationOrigin calibration = CalibrationOrigin::kUnspecified;
  double report_rate_hz = 0;
  double jitter_ms = 0;
  std::uint64_t reports = 0;
  std::uint64_t gaps = 0;
  std::uint64_t repeats = 0;
  std::uint64_t clipped = 0;
  std::uint64_t undecodable = 0;
  double battery_fraction = -1;
  bool battery_low = false;
  std::uint32_t leds = 0;
  bool rumble = false;
  std::string note;
  std::string name;
  std::int64_t last_report_ns = 0;
  Extension extension = Extension::kUnspecified;
  CalibrationOrigin extension_calibration = CalibrationOrigin::kUnspecified;
  CalibrationOrigin gyroscope_calibration = CalibrationOrigin::kUnspecified;
  std::string driver;
  std::string place;
  std::uint64_t mode_reasserts = 0;
  std::uint64_t queue_drops = 0;
  std::uint64_t writes_failed = 0;
  std::uint64_t extension_changes = 0;
  bool tared = false;
  bool mounted = false;
  bool slipped = false;
  bool moved = false;
  double clock_offset_sd_ms = -1;
  std::uint32_t sphere_rgb = 0;
  std::uint32_t bus = 0;
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::vector<std::uint8_t> stored_calibration;
};

struct RawReport {
  std::uint32_t device = 0;
  std::int64_t received_ns = 0;
  std::vector<std::uint8_t> report;
  bool to_device = false;
  bool simulated = false;
  bool feature = false;
  std::int64_t true_ns = 0;
};

}  // namespace footing::stream
