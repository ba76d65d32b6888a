#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/device_models/controller.h"
#include "common/device_models/extensions.h"
#include "common/device_models/identity.h"
#include "common/units/units.h"

namespace footing::device_models {

struct WiimoteOptions {
  bool tr = false;                  ///< RVL-CNT-01-TR, product 0330.
  bool motion_plus_inside = false;  ///< As every -TR has it.
};

/// What a Wiimote and what is plugged into it feel. Sensor frame S: x left, y front, z down.
struct WiimoteSensors {
  Eigen::Vector3d specific_force_S_mps2{0, 0, -kStandardGravityMps2};
  std::uint16_t buttons = 0;  ///< First button byte in bits 8 to 15.
  std::array<std::optional<CameraPoint>, 4> camera;
  NunchukSensors nunchuk;
  Eigen::Vector3d angular_velocity_S_radps{0, 0, 0};  ///< For a MotionPlus.
};

/// A Wiimote with its extension port: its calibration is drawn from the seed, as units differ. A
/// plain value; time is that of the calls and must not run backwards.
class Wiimote {
 public:
  explicit Wiimote(std::uint64_t seed, const WiimoteOptions& options = {});

  const Identity& identity() const { return identity_; }

  /// What is plugged in, and what that makes the device say: the unasked status 0x20, after which
  /// no data come until a mode is set. A MotionPlus adapter goes between the Wiimote and what is in
  /// the port; behind an active one a change shows in its packets alone.
  std::vector<Report> Plug(Accessory accessory, std::int64_t now_ns);
  /// Pulls the adapter with all behind it, or what is in the port. A MotionPlus inside stays.
  std::vector<Report> Pull(std::int64_t now_ns);
  /// Pulls what is in the MotionPlus' own port.
  std::vector<Report> PullBehind(std::int64_t now_ns);

  /// The answers to one output report, in order. Switching a MotionPlus on or off moves the detect
  /// pin: 20 ms without anything in the port, and status reports that say so.
  std::vector<Report> HandleOutput(std::int64_t now_ns, std::span<const std::uint8_t> report);
  /// What is due at this time: status reports, then the data report when the mode calls for one.
  std::vector<Report> Sample(std::int64_t now_ns, const WiimoteSensors& sensors);

  /// The same without a clock, for a Wiimote with nothing plugged in.
  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report) {
    return HandleOutput(now_ns_, report);
  }
  std::optional<Report> Sample(const Eigen::Vector3d& specific_force_S_mps2,
                               std::uint16_t buttons = 0);

  Controller& controller() { return controller_; }
  std::uint8_t leds() const { return controller_.leds(); }  ///< Bits 0 to 3.
  bool rumble() const { return controller_.rumble(); }
  bool motion_plus_active() { return controller_.memory().motion_plus_mode() != 0; }

  struct Axis {
    int zero_counts = 0x200;
    int one_g_counts = 0x268;
  };
  /// Raw axes x, y, z; what the EEPROM holds.
  const std::array<Axis, 3>& axes() const { return axes_; }
  const NunchukBlock& nunchuk_block() const { return nunchuk_block_; }
  const MotionPlusBlock& motion_plus_block() const { return motion_plus_block_; }

 private:
  std::vector<Report> Due(std::int64_t now_ns);
  Readings Read(const WiimoteSensors& sensors) const;
  ExtensionBytes NextPacket(const WiimoteSensors& sensors);
  ExtensionBytes ChildPacket(const WiimoteSensors& sensors);

  std::array<Axis, 3> axes_;
  NunchukBlock nunchuk_block_;
  MotionPlusBlock motion_plus_block_;
  WiimoteOptions options_;
  Identity identity_;
  Controller controller_;
  Accessory child_ = Accessory::kNone;
  std::int64_t now_ns_ = 0;
  std::optional<std::int64_t> port_ready_ns_;  ///< The end of the dead window.
  int rubbish_ = 0;                            ///< Packets after activation that mean nothing.
  bool childs_turn_ = false;
};

}  // namespace footing::device_models
