#pragma once

#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/virtual/devices/wiimote.h"
#include "tests/device_faults/model.h"

namespace footing::device_faults {

/// A PS Move on one of its links; on both it is one device, so `move` may be shared.
class MoveOnLink : public Model {
 public:
  static constexpr std::uint8_t kAddress = 0x04;
  static constexpr std::uint8_t kCalibration = 0x10;

  MoveOnLink(std::uint64_t seed, virtual_devices::MoveModel model)
      : MoveOnLink(std::make_shared<virtual_devices::PsMove>(seed, model), false) {}
  MoveOnLink(std::shared_ptr<virtual_devices::PsMove> shared, bool usb)
      : move(std::move(shared)), identity_(move->identity()) {
    period_s = 1 / 88.0;
    if (!usb) return;
    identity_.bus = 3;
    identity_.serial.clear();  // On the cable it is known by feature report 04 alone.
  }
  const virtual_devices::Identity& identity() const override { return identity_; }
  std::vector<Report> HandleOutput(std::int64_t now_ns,
                                   std::span<const std::uint8_t> report) override {
    return move->HandleOutput(now_ns, report);
  }
  std::vector<Report> Sample(std::int64_t now_ns) override { return move->Sample(now_ns, sensors); }
  std::optional<Report> Feature(std::uint8_t id, std::size_t size) override {
    if (id == kAddress && identity_.bus == 3) return Address();
    if (id == kCalibration) ++calibration_asked;
    return calibration_readable ? move->Feature(id, size) : std::nullopt;
  }

  std::shared_ptr<virtual_devices::PsMove> move;
  virtual_devices::MoveSensors sensors;
  bool calibration_readable = true;  ///< Over Bluetooth some kernels refuse it.
  int calibration_asked = 0;

 private:
  /// Its own address, least byte first; the host's follows.
  Report Address() const {
    Report report(16, 0);
    report[0] = kAddress;
    const std::string& serial = move->identity().serial;
    for (std::size_t i = 0; i < 6; ++i) {
      report[6 - i] =
          static_cast<std::uint8_t>(std::strtoul(serial.substr(3 * i, 2).c_str(), nullptr, 16));
    }
    return report;
  }

  virtual_devices::Identity identity_;
};

}  // namespace footing::device_faults
