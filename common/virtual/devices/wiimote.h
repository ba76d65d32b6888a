#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/base/units.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/extensions.h"

namespace footing::virtual_devices {

/// Ten bytes of EEPROM: zero, 1 g, volume, sum.
using AccelerationBlock = std::array<std::uint8_t, 10>;

/// Model and calibration of a simulated Wiimote.
struct WiimoteOptions {
  /// A 057e:0330, which always has a MotionPlus inside.
  bool tr = false;
  bool motion_plus_inside = false;
  /// Calibration of units that are known; else drawn from the seed.
  std::optional<AccelerationBlock> acceleration = std::nullopt;
  std::optional<NunchukBlock> nunchuk = std::nullopt;
  std::optional<MotionPlusBlock> motion_plus = std::nullopt;
};

/// True inputs of a Wiimote and its extension. S of the Wiimote: x left, y front, z down.
struct WiimoteSensors {
  Eigen::Vector3d specific_force_S_mps2{0, 0, -kStandardGravityMps2};
  std::uint16_t buttons = 0;  ///< First button byte in bits 8 to 15.
  std::array<std::optional<CameraPoint>, 4> camera;
  NunchukSensors nunchuk;
  GamepadSensors classic;
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();  ///< Right-handed.
};

/// A Wiimote and what is in its port: nothing, a Nunchuk, a Classic, a MotionPlus with or without
/// one of them behind it. Calibrations are drawn from the seed, as units differ.
///
/// When something comes or goes, a status report comes unasked and data stop until the mode is set
/// again; behind an active MotionPlus it shows in a bit of the packets only. A MotionPlus that is
/// switched on or off takes the port away for 20 ms (Dolphin's MotionPlus.cpp): a status report
/// without extension, then one of what is there. Its first two packets make no sense.
class Wiimote {
 public:
  static constexpr std::int64_t kDeadNs = 20'000'000;

  explicit Wiimote(std::uint64_t seed, const WiimoteOptions& options = {});

  const Identity& identity() const { return identity_; }

  /// Puts it into the port, or into the MotionPlus' own when there is one; what was there goes.
  /// Gives the reports that the Wiimote sends of it.
  std::vector<Report> Plug(Accessory accessory, std::int64_t now_ns);
  /// Pulls what is outermost: the Nunchuk or Classic, else the MotionPlus unless it is inside.
  std::vector<Report> Pull(std::int64_t now_ns);
  /// Pulls the MotionPlus with all that is in it.
  std::vector<Report> PullMotionPlus(std::int64_t now_ns);

  /// The answers to an output report.
  std::vector<Report> HandleOutput(std::int64_t now_ns, std::span<const std::uint8_t> report);
  /// The reports of one sample: what is due of the port, and the data report when the mode calls
  /// for one. Vectors are turned into counts by the device's own calibrations and end at the range.
  std::vector<Report> Sample(std::int64_t now_ns, const WiimoteSensors& sensors);

  /// The same without a clock: the port is never away.
  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report);
  std::optional<Report> Sample(const Eigen::Vector3d& specific_force_S_mps2,
                               std::uint16_t buttons = 0);

  /// The next so many requests for status or memory are refused with error 2, as a -TR does that is
  /// busy.
  void RefuseNext(int requests) { refusals_ = requests; }

  Controller& controller() { return controller_; }
  std::uint8_t leds() const { return controller_.leds(); }  ///< Bits 0 to 3.
  bool rumble() const { return controller_.rumble(); }
  Accessory accessory() const { return child_; }  ///< Not the MotionPlus.
  bool has_motion_plus() const { return controller_.memory().has_motion_plus(); }
  bool motion_plus_active() const { return controller_.memory().motion_plus_mode() != 0; }

  struct Axis {
    int zero_counts = 0x200;
    int one_g_counts = 0x268;
  };
  /// Raw axes x, y, z; what the EEPROM holds.
  const std::array<Axis, 3>& axes() const { return axes_; }
  const NunchukBlock& nunchuk_block() const { return nunchuk_; }
  const MotionPlusBlock& motion_plus_block() const { return motion_plus_; }

 private:
  void TakePortAway(std::int64_t now_ns, std::vector<Report>& reports);
  void Advance(std::int64_t now_ns, std::vector<Report>& reports);
  ExtensionBytes ExtensionPacket(const WiimoteSensors& sensors);
  ExtensionBytes PassedPacket(const WiimoteSensors& sensors);
  Readings Read(const WiimoteSensors& sensors);

  std::array<Axis, 3> axes_;
  NunchukBlock nunchuk_;
  MotionPlusBlock motion_plus_;
  bool motion_plus_inside_;
  Identity identity_;
  Controller controller_;
  Accessory child_ = Accessory::kNone;
  std::optional<std::int64_t> dead_until_ns_;
  int rubbish_packets_ = 0;
  bool child_turn_ = false;  ///< The next packet is the child's.
  int refusals_ = 0;
};

/// Models of the PS Move, with their USB ids.
enum class MoveModel {
  kZcm1,  ///< 054c:03d5: two samples a report, magnetometer.
  kZcm2,  ///< 054c:0c5e: one sample a report, sent twice; no magnetometer.
};

/// True inputs of a Move. S: x left, y front (to the sphere), z down (away from the buttons).
struct MoveSensors {
  Eigen::Vector3d specific_force_S_mps2{0, 0, -kStandardGravityMps2};
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();  ///< Right-handed.
  Eigen::Vector3d magnetic_field_S_counts = Eigen::Vector3d::Zero();   ///< +-2047.
  double trigger = 0;                                                  ///< 0 to 1.
  /// psmoveapi's bits: triangle 4, circle, cross, square, select 8, start 11, PS 16, Move 19,
  /// trigger 20.
  std::uint32_t buttons = 0;
  std::uint16_t temperature_raw = 1664;  ///< 12 bits of a thermistor; this is 20 degrees Celsius.
};

/// A PS Move over Bluetooth. It sends as soon as it is there. Axes and layout are those of the
/// moveonpc wiki: raw x to the right, y to the sphere, z out of the buttons.
class PsMove {
 public:
  /// The sphere and the motor go out unless their report comes again (psmoveapi: about 5 s).
  static constexpr std::int64_t kKeepAliveNs = 5'000'000'000;

  /// Its calibration is drawn from the seed.
  PsMove(std::uint64_t seed, MoveModel model);
  /// With the calibration of a unit that is known: 143 bytes of a ZCM1, 96 of a ZCM2.
  PsMove(std::uint64_t seed, MoveModel model, std::vector<std::uint8_t> blob);

  const Identity& identity() const { return identity_; }

  /// Takes the lights' report (id 0x06, or 0x02 of newer firmware): red, green, blue at 2, motor at
  /// 6. There are no answers.
  std::vector<Report> HandleOutput(std::int64_t now_ns, std::span<const std::uint8_t> report);
  /// Feature 0x10: the calibration's next piece of 49 bytes, in turn. 0x04: Bluetooth addresses, 16
  /// bytes, least significant first. Cut to `size`; none of other ids.
  std::optional<Report> Feature(std::uint8_t id, std::size_t size);

  /// The report of what is felt now. A ZCM1's older sample is half way from the last call's.
  std::vector<Report> Sample(std::int64_t now_ns, const MoveSensors& sensors);

  std::uint32_t sphere_rgb(std::int64_t now_ns) const { return Kept(now_ns) ? sphere_rgb_ : 0; }
  std::uint8_t rumble(std::int64_t now_ns) const { return Kept(now_ns) ? rumble_ : 0; }
  /// 0 to 5, 0xee while charging, 0xef when charged.
  void set_battery(std::uint8_t raw) { battery_ = raw; }
  MoveModel model() const { return model_; }
  /// Calibration in the feature reports; to be damaged by tests of damage.
  std::vector<std::uint8_t>& blob() { return blob_; }

 private:
  bool Kept(std::int64_t now_ns) const { return lights_ && now_ns - lights_ns_ < kKeepAliveNs; }
  void PutSample(const MoveSensors& sensors, std::size_t half, Report& report) const;

  MoveModel model_;
  std::vector<std::uint8_t> blob_;
  /// Raw axes: counts = zero + value * gain.
  std::array<double, 3> force_zero_{}, force_gain_{}, turn_zero_{}, turn_gain_{};
  Identity identity_;
  std::size_t next_piece_ = 0;
  std::uint8_t sequence_ = 0;
  std::uint8_t battery_ = 5;
  std::optional<MoveSensors> last_;
  bool lights_ = false;
  std::int64_t lights_ns_ = 0;
  std::uint32_t sphere_rgb_ = 0;
  std::uint8_t rumble_ = 0;
};

/// A blob as a factory would write it.
std::vector<std::uint8_t> DrawMoveBlob(std::uint64_t seed, MoveModel model);

}  // namespace footing::virtual_devices
