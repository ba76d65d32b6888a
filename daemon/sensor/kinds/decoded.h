#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "common/board/plate.h"
#include "common/stream/sensor.h"

/// What every kind of device gives: samples of one report in SI units, made with the device's own
/// calibration. They know no time: who stamps the samples adds device, report count, times, filter
/// and gyroscope bias.
namespace footing::decode {

struct BoardReading {
  board::CornerForces forces;  ///< As measured: neither tared nor clamped.
  bool uncalibrated = false;
};

/// The samples of one report.
struct Decoded {
  std::array<stream::MotionSample, 2> motion{};  ///< Older first, evenly spaced over the report.
  std::size_t motion_count = 0;
  std::optional<BoardReading> board;
  std::optional<stream::NunchukSample> nunchuk;
  std::optional<stream::GamepadSample> gamepad;
  std::optional<stream::CameraSample> camera;
  /// The samples are those of the report before, with other buttons: no new measurement.
  bool buttons_only = false;
  /// The device took a new measurement: some sample differs from the report before.
  bool changed = false;

  bool empty() const { return motion_count == 0 && !board && !nunchuk && !gamepad && !camera; }
};

}  // namespace footing::decode
