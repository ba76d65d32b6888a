#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/wiimote.h"

namespace footing::device_faults {

using virtual_devices::Report;

/// A device on the bench: its side of the protocol, and what its sensors measure now. Time is
/// CLOCK_MONOTONIC.
class Model {
 public:
  virtual ~Model() = default;
  virtual const virtual_devices::Identity& identity() const = 0;
  virtual std::vector<Report> HandleOutput(std::int64_t now_ns,
                                           std::span<const std::uint8_t> report) = 0;
  virtual std::vector<Report> Sample(std::int64_t now_ns) = 0;
  virtual std::optional<Report> Feature(std::uint8_t, std::size_t) { return std::nullopt; }
  double period_s = 0.01;
};

class WiimoteModel : public Model {
 public:
  explicit WiimoteModel(std::uint64_t seed, const virtual_devices::WiimoteOptions& options = {})
      : wiimote(seed, options) {}
  const virtual_devices::Identity& identity() const override { return wiimote.identity(); }
  std::vector<Report> HandleOutput(std::int64_t now_ns,
                                   std::span<const std::uint8_t> report) override {
    return wiimote.HandleOutput(now_ns, report);
  }
  std::vector<Report> Sample(std::int64_t now_ns) override {
    virtual_devices::WiimoteSensors sensors;
    sensors.specific_force_S_mps2 = specific_force_S_mps2;
    sensors.buttons = buttons;
    sensors.nunchuk = nunchuk;
    sensors.angular_velocity_S_radps = turning ? turning(now_ns) : Eigen::Vector3d(0, 0, 0);
    return wiimote.Sample(now_ns, sensors);
  }

  virtual_devices::Wiimote wiimote;
  Eigen::Vector3d specific_force_S_mps2{0, 0, -9.80665};
  std::uint16_t buttons = 0;
  virtual_devices::NunchukSensors nunchuk;
  /// Angular velocity in S, rad/s, over CLOCK_MONOTONIC; null: none.
  std::function<Eigen::Vector3d(std::int64_t now_ns)> turning;
};

/// A Wiimote in a slot of a USB adapter, which has no serial.
class SlotModel : public WiimoteModel {
 public:
  explicit SlotModel(std::uint64_t seed) : WiimoteModel(seed), identity_(wiimote.identity()) {
    identity_.bus = 3;
  }
  const virtual_devices::Identity& identity() const override { return identity_; }

 private:
  virtual_devices::Identity identity_;
};

class BoardModel : public Model {
 public:
  explicit BoardModel(std::uint64_t seed) : board(seed) {}
  const virtual_devices::Identity& identity() const override { return board.identity(); }
  std::vector<Report> HandleOutput(std::int64_t, std::span<const std::uint8_t> report) override {
    return board.HandleOutput(report);
  }
  std::vector<Report> Sample(std::int64_t) override {
    auto report = board.Sample(forces);
    return report ? std::vector<Report>{*report} : std::vector<Report>{};
  }

  virtual_devices::BalanceBoard board;
  virtual_devices::CornerForces forces{150, 160, 170, 180};
};

}  // namespace footing::device_faults
