#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/base/units.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/noise.h"

namespace footing::virtual_devices {

enum class JoyconModel { kLeft, kRight, kPro };

/// Bits of JoyconSensors::buttons: a right one has A, a left one L.
inline constexpr std::uint32_t kJoyconA = 0x08, kJoyconL = 0x400000;

/// True inputs of one of the Switch's controllers. S: x left, y front (to the triggers), z down
/// (away from the buttons).
struct JoyconSensors {
  Eigen::Vector3d specific_force_S_mps2{0, 0, -kStandardGravityMps2};
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();  ///< Right-handed.
  double stick_x = 0;         ///< Its own stick, a Pro Controller's left one: -1 left to 1 right.
  double stick_y = 0;         ///< -1 back to 1 front.
  std::uint32_t buttons = 0;  ///< Bytes 3, 4 and 5 of a report, the first in bits 0 to 7.
};

/// The same with a real unit's noise.
JoyconSensors WithNoise(JoyconSensors sensors, noise::Random& random);

/// Newest last, 5 ms apart: the samples of one report.
using JoyconBurst = std::array<JoyconSensors, 3>;

/// Joy-Con (L), Joy-Con (R) or Pro Controller over Bluetooth, written from dekuNukem's notes: after
/// connecting it sends a simple report (3f) when a button changes, with subcommand 03 30 the full
/// one every 15 ms, whose first sample is its newest. Its sensors are off until 40 01. Its memory
/// is FF but for serial number, calibration and stick parameters, which are drawn from the seed.
class Joycon {
 public:
  Joycon(std::uint64_t seed, JoyconModel model);

  const Identity& identity() const { return identity_; }

  /// The answer to an output report, if it asks for one.
  std::vector<Report> HandleOutput(std::int64_t now_ns, std::span<const std::uint8_t> report);
  /// The report of a burst, taken at `now_ns`, in the mode set.
  std::vector<Report> Sample(std::int64_t now_ns, const JoyconBurst& burst);
  /// The same of sensors that did not change during a report.
  std::vector<Report> Sample(std::int64_t now_ns, const JoyconSensors& sensors) {
    return Sample(now_ns, JoyconBurst{sensors, sensors, sensors});
  }

  std::uint8_t leds() const { return leds_; }  ///< Bits 0 to 3.
  bool rumble() const { return vibration_ && shaking_; }
  std::uint8_t mode() const { return mode_; }
  /// 0: off, 1: rates, 2 and 3: a packed attitude in their place.
  std::uint8_t sensor_mode() const { return sensor_mode_; }
  /// As another program would set it.
  void set_sensor_mode(std::uint8_t mode) { sensor_mode_ = mode; }
  void set_mode(std::uint8_t mode) { mode_ = mode; }
  void set_battery(std::uint8_t level, bool charging);  ///< 0 empty to 4 full.
  /// Least time between two reports written to it; a real one disconnects from some 10 ms on.
  std::int64_t least_interval_ns() const { return least_interval_ns_; }

  /// Memory by address; what is not in it reads FF. To be damaged by tests of damage.
  std::map<std::uint32_t, std::uint8_t>& memory() { return memory_; }
  void Write(std::uint32_t address, std::span<const std::uint8_t> bytes);

 private:
  void PutHead(std::int64_t now_ns, const JoyconSensors& sensors, Report& report) const;
  void PutSample(const JoyconSensors& sensors, std::size_t at, Report& report);
  void Execute(std::span<const std::uint8_t> report, Report& reply);
  Eigen::Vector3d Raw(const Eigen::Vector3d& of_S) const;

  JoyconModel model_;
  Identity identity_;
  std::map<std::uint32_t, std::uint8_t> memory_;
  std::array<int, 3> turn_zero_{};
  int turn_coefficient_ = 13371;
  std::array<std::array<int, 2>, 3> stick_{};  ///< Centre, span below, span above; x, y.
  std::uint8_t mode_ = 0x3f;
  std::uint8_t sensor_mode_ = 0;
  std::uint8_t leds_ = 0;
  std::uint8_t battery_ = 0x80;  ///< As in a report: level in bits 5 to 7, charging in bit 4.
  bool vibration_ = false;
  bool shaking_ = false;
  std::uint32_t attitude_ = 1;  ///< Stands for the packed one, which no reader can take for rates.
  JoyconSensors last_;
  std::optional<std::int64_t> written_ns_;
  std::int64_t least_interval_ns_ = INT64_MAX;
};

}  // namespace footing::virtual_devices
