#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/stream/sensor.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/sequencer.h"

/// Output of every kind of device: samples of one report in SI units, made with the device's own
/// calibration. They know no host time: who stamps the samples adds device, report count, times,
/// filter and gyroscope bias.
namespace footing::decode {

/// Forces of one Balance Board report, N.
struct BoardReading {
  board::CornerForces forces;  ///< As measured: neither tared nor clamped.
  bool uncalibrated = false;
};

/// The samples of one report.
struct Decoded {
  std::vector<stream::MotionSample> motion;  ///< Oldest first.
  /// Their sampled_ns are by the device's own clock, which began at any instant. Else they say
  /// nothing, and the samples are spread over a typical report.
  bool own_times = false;
  std::optional<BoardReading> board;
  std::optional<stream::NunchukSample> nunchuk;
  std::optional<stream::GamepadSample> gamepad;
  std::optional<stream::CameraSample> camera;
  /// The samples are those of the report before, with other buttons: no new measurement.
  bool buttons_only = false;
  /// The device took a new measurement: some sample differs from the report before.
  bool changed = false;

  bool empty() const { return motion.empty() && !board && !nunchuk && !gamepad && !camera; }
};

/// Bits of stream::GamepadButton from those of reports::ClassicButton.
std::uint32_t GamepadButtons(std::uint16_t classic_buttons);

/// By the nominal ranges of the sticks (6 bits left, 5 bits right, 0 in the middle) and triggers.
stream::GamepadSample ToGamepad(const reports::ClassicCounts& counts);

/// Other than repeated and the stamps.
bool SameReading(const stream::GamepadSample& a, const stream::GamepadSample& b);

/// Settings that the kinds of device share.
struct KindOptions {
  double local_gravity_mps2 = kStandardGravityMps2;  ///< Where boards stand.
  handshake::HandshakeConfig handshake;
};

/// How a device presents itself.
struct Product {
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::string name;
};

/// Where a kind of device is used, which decides the roles it can have.
enum class Placement {
  kOnBody,       ///< Worn or held: hands, legs, head.
  kUnderFeet,    ///< A board.
  kInBothHands,  ///< A gamepad: says nothing about the body.
  kByChoice,     ///< A gamepad with motion sensors: on the body where it is given such a role.
};

/// Typical intervals of a kind, before they are estimated.
struct Timing {
  double report_period_s = 0.01;
  double sensor_period_s = 0.01;
  double max_lag_s = 0.025;  ///< Longest delay of a report that sample times allow for.
  /// Share by which the device's own clock may be faster or slower than the host's.
  double own_rate_range = 2e-4;
};

/// A feature report to ask a device for.
struct FeatureRequest {
  std::uint8_t id = 0;
  std::size_t size = 0;  ///< The id byte included.
};

}  // namespace footing::decode
