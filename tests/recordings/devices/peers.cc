#include "tests/recordings/devices/peers.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/virtual/devices/controller.h"
#include "daemon/sensor/reports/input_report.h"

namespace footing::recordings {
namespace {

devices::DeviceIdentity IdentityOf(const virtual_devices::Identity& own) {
  devices::DeviceIdentity identity;
  identity.bus = devices::Bus::kBluetooth;
  identity.vendor = own.vendor;
  identity.product = own.product;
  identity.name = own.name;
  identity.serial = own.serial;
  return identity;
}

/// Swung forwards and backwards at 2 Hz, +-3 m/s², face up.
Eigen::Vector3d Swing(double t_s) {
  return {0, 3 * std::sin(2 * 3.14159265358979 * 2 * t_s), -9.80665};
}

std::int64_t Nanoseconds(double t_s) { return std::llround(t_s * 1e9); }

constexpr double kTwoPi = 2 * 3.14159265358979;

using Sensors = std::function<virtual_devices::WiimoteSensors(double t_s)>;
using Event = std::function<std::vector<Report>(virtual_devices::Wiimote&, std::int64_t now_ns)>;

/// `at_s`: when `event` happens, once; 0 never.
Peer MakeWiimote(const virtual_devices::Wiimote& fresh, const Sensors& sensors, double at_s = 0,
                 const Event& event = nullptr) {
  auto model = std::make_shared<virtual_devices::Wiimote>(fresh);
  const auto sample = [=, happened = at_s == 0](double t_s) mutable {
    std::vector<Report> reports;
    if (!happened && t_s >= at_s) {
      happened = true;
      reports = event(*model, Nanoseconds(t_s));
    }
    for (auto& report : model->Sample(Nanoseconds(t_s), sensors(t_s))) reports.push_back(report);
    return reports;
  };
  return {IdentityOf(model->identity()),
          [model](double t_s, std::span<const std::uint8_t> report) {
            return model->HandleOutput(Nanoseconds(t_s), report);
          },
          sample};
}

/// Stick in a circle of 1 Hz, C and Z pressed in turn, tilted to and fro.
virtual_devices::NunchukSensors Stick(double t_s) {
  virtual_devices::NunchukSensors sensors;
  sensors.stick_x = 0.9 * std::sin(kTwoPi * t_s);
  sensors.stick_y = 0.9 * std::cos(kTwoPi * t_s);
  sensors.c = std::fmod(t_s, 0.4) < 0.1;
  sensors.z = std::fmod(t_s + 0.2, 0.4) < 0.1;
  const double tilt_rad = 0.5 * std::sin(kTwoPi * 0.5 * t_s);
  sensors.specific_force_S_mps2 = {9.80665 * std::sin(tilt_rad), 0, -9.80665 * std::cos(tilt_rad)};
  return sensors;
}

/// Turned about all three axes, each fast enough in its turn to leave the slow range.
Eigen::Vector3d Turn(double t_s) {
  return {2 * std::sin(kTwoPi * t_s), 12 * std::sin(kTwoPi * t_s + 2),
          20 * std::sin(kTwoPi * 2 * t_s + 4)};
}

virtual_devices::WiimoteSensors Swung(double t_s) {
  virtual_devices::WiimoteSensors sensors;
  sensors.specific_force_S_mps2 = Swing(t_s);
  return sensors;
}

virtual_devices::WiimoteSensors Everything(double t_s) {
  virtual_devices::WiimoteSensors sensors = Swung(t_s);
  sensors.nunchuk = Stick(t_s);
  sensors.angular_velocity_S_radps = Turn(t_s);
  return sensors;
}

}  // namespace

Peer MakePlainWiimote() {
  return MakeWiimote(virtual_devices::Wiimote(11), [](double t_s) {
    virtual_devices::WiimoteSensors sensors = Swung(t_s);
    sensors.buttons = std::fmod(t_s, 0.5) < 0.1 ? reports::kA | reports::kUp : 0;
    return sensors;
  });
}

Peer MakeCamera() {
  return MakeWiimote(virtual_devices::Wiimote(20), [](double t_s) {
    virtual_devices::WiimoteSensors sensors = Swung(t_s);
    const int x = static_cast<int>(std::lround(512 + 300 * std::sin(kTwoPi * t_s)));
    sensors.camera[0] = virtual_devices::CameraPoint{x - 100, 300, 3};
    if (t_s < 1.2) sensors.camera[1] = virtual_devices::CameraPoint{x + 100, 310, 4};
    return sensors;
  });
}

Peer MakeExtended(virtual_devices::Accessory accessory, const virtual_devices::Wiimote& fresh,
                  double pulled_at_s) {
  virtual_devices::Wiimote wiimote = fresh;
  wiimote.Plug(accessory, 0);
  return MakeWiimote(wiimote, Everything, pulled_at_s,
                     [](auto& model, std::int64_t now_ns) { return model.Pull(now_ns); });
}

Peer MakeMove(std::uint64_t seed, virtual_devices::MoveModel which) {
  auto model = std::make_shared<virtual_devices::PsMove>(seed, which);
  const auto sample = [model](double t_s) {
    virtual_devices::MoveSensors sensors;
    sensors.specific_force_S_mps2 = Swing(t_s);
    sensors.angular_velocity_S_radps = Turn(t_s) / 2;
    sensors.magnetic_field_S_counts = {200 * std::sin(kTwoPi * t_s), 150, -300};
    sensors.trigger = std::max(0.0, std::sin(kTwoPi * t_s));
    sensors.buttons = std::fmod(t_s, 0.5) < 0.1 ? 1u << 19 : 0;
    return model->Sample(Nanoseconds(t_s), sensors);
  };
  return {IdentityOf(model->identity()),
          [model](double t_s, std::span<const std::uint8_t> report) {
            return model->HandleOutput(Nanoseconds(t_s), report);
          },
          sample,
          [model](std::uint8_t id, std::size_t size) {
            return model->Feature(id, size).value_or(Report{});
          }};
}

Peer MakeBoard() {
  auto model = std::make_shared<virtual_devices::BalanceBoard>(12);
  model->set_temperature(0x1f);  // Warmer than at its calibration.
  const auto sample = [model](double t_s) {
    // Nobody for the first 0.8 s, then 60 kg that lean to the left and back.
    const double kg = t_s < 0.8 ? 0 : 60;
    const double lean = 0.3 * std::sin(kTwoPi * t_s);
    const double left_n = kg * 9.80665 / 4 * (1 + lean);
    const double right_n = kg * 9.80665 / 4 * (1 - lean);
    const auto report = model->Sample({left_n, right_n, left_n, right_n});
    return report ? std::vector<Report>{*report} : std::vector<Report>{};
  };
  return {
      IdentityOf(model->identity()),
      [model](double, std::span<const std::uint8_t> report) { return model->HandleOutput(report); },
      sample};
}

}  // namespace footing::recordings
