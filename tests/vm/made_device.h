#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/virtual/devices/controller.h"
#include "tests/vm/ramp.h"

namespace footing::vm {

/// A device fresh from power-on, whatever its kind: its side of the protocol, and the ramp that it
/// measures. Time is an argument.
class MadeDevice {
 public:
  using Reports = std::vector<virtual_devices::Report>;

  virtual ~MadeDevice() = default;
  virtual const virtual_devices::Identity& identity() const = 0;
  virtual Reports HandleOutput(std::int64_t now_ns, std::span<const std::uint8_t> report) = 0;
  virtual Reports Sample(std::int64_t now_ns, std::uint64_t sample) = 0;
  virtual std::int64_t period_ns() const { return kSamplePeriodNs; }  ///< Between two of them.
  /// The status report that a device sends of itself, if its kind does.
  virtual Reports Status() { return {}; }
  virtual std::optional<virtual_devices::Report> Feature(std::uint8_t) { return std::nullopt; }
  virtual std::span<const std::uint8_t> descriptor() const = 0;
};

/// wiimote; wiimote_plus: of the type -TR, MotionPlus inside, a Nunchuk behind it; board;
/// move_zcm1, which measures two steps of the ramp a report; move_zcm2; joycon, a left one, which
/// measures three.
std::vector<std::string> Kinds();
/// Null for another name. The same seed is the same device, serial and all.
std::unique_ptr<MadeDevice> MakeDevice(const std::string& kind, std::uint64_t seed);

}  // namespace footing::vm
