#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "clients/stream/recorded_device.h"
#include "common/stream/device.h"
#include "common/virtual/devices/balance_board.h"
#include "common/virtual/devices/link_model.h"
#include "common/virtual/devices/ps_move.h"
#include "common/virtual/devices/wiimote.h"

namespace footing::stream_client {

/// One simulated device: a device model, what its sensor feels, and the link it is heard over. It
/// has no clock; times are seconds since its motion began.
class SimulatedDevice {
 public:
  using WiimoteMotion = std::function<virtual_devices::WiimoteSensors(double t_s)>;
  using CornerForces = std::function<virtual_devices::CornerForces(double t_s)>;
  using MoveMotion = std::function<virtual_devices::MoveSensors(double t_s)>;

  SimulatedDevice(virtual_devices::Wiimote wiimote, WiimoteMotion motion, stream::DeviceRole role,
                  const virtual_devices::LinkConfig& link);
  SimulatedDevice(virtual_devices::BalanceBoard board, CornerForces forces, stream::DeviceRole role,
                  const virtual_devices::LinkConfig& link);
  SimulatedDevice(virtual_devices::PsMove move, MoveMotion motion, stream::DeviceRole role,
                  const virtual_devices::LinkConfig& link);
  /// Its reports, and when they come, are those of the recording.
  SimulatedDevice(RecordedDevice recorded, stream::DeviceRole role);

  const virtual_devices::Identity& identity() const;
  stream::DeviceRole role() const { return role_; }

  /// What the device answers to an output report.
  std::vector<virtual_devices::Report> HandleOutput(double now_s,
                                                    std::span<const std::uint8_t> output);
  /// A feature report of `size` bytes; empty when the device refuses.
  virtual_devices::Report Feature(std::uint8_t id, std::size_t size);

  struct Arrival {
    double arrives_s = 0;
    double sampled_s = 0;  ///< When the sensor took the value that arrives.
  };
  /// The next delivery; later than the one before. Infinitely late when a recording has no more.
  Arrival Next();
  /// When the device appears and when it is gone: 0 and never, but for those of a recording.
  double attaches_s() const;
  double detaches_s() const;
  /// The reports with the value of `sampled_s`; none while a mode is wanted and the host has set
  /// none.
  std::vector<virtual_devices::Report> Deliver(double sampled_s);
  /// The motion restarts at time 0 with the device in its initial state, as after a new connection.
  void Restart();

  /// Colour that its sphere shows, 0xRRGGBB; nothing of a device without one.
  std::optional<std::uint32_t> SphereLight(double now_s) const;

  /// A line for the log when lights or rumble changed since the last call; empty otherwise.
  std::string Changes(double now_s);

  /// What a person would see and feel of it.
  struct Shown {
    std::string lights;
    bool rumble = false;
  };

 private:
  /// The device itself and what it feels.
  template <typename Device, typename Sensors>
  struct Felt {
    Device device;
    std::function<Sensors(double)> motion;
    Sensors held{};  ///< The sensor holds one value until it takes the next.
  };
  using Wiimote = Felt<virtual_devices::Wiimote, virtual_devices::WiimoteSensors>;
  using Board = Felt<virtual_devices::BalanceBoard, virtual_devices::CornerForces>;
  using Move = Felt<virtual_devices::PsMove, virtual_devices::MoveSensors>;
  struct Recorded {
    RecordedDevice device;
  };
  using Device = std::variant<Wiimote, Board, Move, Recorded>;

  SimulatedDevice(Device device, stream::DeviceRole role, const virtual_devices::LinkConfig& link);

  Shown Show(double now_s) const;

  Device fresh_;
  Device device_;
  stream::DeviceRole role_;
  virtual_devices::LinkConfig link_config_;
  virtual_devices::LinkModel link_;
  double held_s_ = -1;
  Shown shown_;  ///< As reported last.
};

}  // namespace footing::stream_client
