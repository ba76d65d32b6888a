#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/device_models/balance_board.h"
#include "common/device_models/link_model.h"
#include "common/device_models/ps_move.h"
#include "common/device_models/wiimote.h"
#include "common/stream/device.h"

namespace footing::stream_client {

/// One device stand-in: a device model, what its sensor feels, and the link it is heard over. It
/// knows no clock; times are seconds since its motion began.
class StandIn {
 public:
  using WiimoteMotion = std::function<device_models::WiimoteSensors(double t_s)>;
  using CornerForces = std::function<device_models::CornerForces(double t_s)>;
  using MoveMotion = std::function<device_models::MoveSensors(double t_s)>;

  StandIn(device_models::Wiimote wiimote, WiimoteMotion motion, stream::DeviceRole role,
          const device_models::LinkConfig& link);
  StandIn(device_models::BalanceBoard board, CornerForces forces, stream::DeviceRole role,
          const device_models::LinkConfig& link);
  StandIn(device_models::PsMove move, MoveMotion motion, stream::DeviceRole role,
          const device_models::LinkConfig& link);

  const device_models::Identity& identity() const;
  stream::DeviceRole role() const { return role_; }

  /// What the device answers to an output report.
  std::vector<device_models::Report> HandleOutput(double now_s,
                                                  std::span<const std::uint8_t> output);
  /// A feature report of `size` bytes; empty when the device refuses.
  device_models::Report Feature(std::uint8_t id, std::size_t size);

  struct Arrival {
    double arrives_s = 0;
    double sampled_s = 0;  ///< When the sensor took the value that arrives.
  };
  /// The next delivery; later than the one before.
  Arrival Next();
  /// The reports with the value of `sampled_s`; none while a mode is wanted and the host has set
  /// none.
  std::vector<device_models::Report> Deliver(double sampled_s);
  /// The motion begins anew at time 0, with the device fresh from its box, as after a new
  /// connection.
  void Restart();

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
  using Wiimote = Felt<device_models::Wiimote, device_models::WiimoteSensors>;
  using Board = Felt<device_models::BalanceBoard, device_models::CornerForces>;
  using Move = Felt<device_models::PsMove, device_models::MoveSensors>;
  using Device = std::variant<Wiimote, Board, Move>;

  StandIn(Device device, stream::DeviceRole role, const device_models::LinkConfig& link);

  Shown Show(double now_s) const;

  Device fresh_;
  Device device_;
  stream::DeviceRole role_;
  device_models::LinkConfig link_config_;
  device_models::LinkModel link_;
  double held_s_ = -1;
  Shown shown_;  ///< As told last.
};

}  // namespace footing::stream_client
