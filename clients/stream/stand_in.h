#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/device_models/balance_board.h"
#include "common/device_models/link_model.h"
#include "common/device_models/wiimote.h"
#include "common/stream/device.h"

namespace footing::stream_client {

/// One device stand-in: a device model, what its sensor feels, and the link it is heard over. It
/// knows no clock; times are seconds since its motion began.
class StandIn {
 public:
  using SpecificForce = std::function<Eigen::Vector3d(double t_s)>;
  using CornerForces = std::function<device_models::CornerForces(double t_s)>;

  StandIn(device_models::Wiimote wiimote, SpecificForce force, stream::DeviceRole role,
          const device_models::LinkConfig& link);
  StandIn(device_models::BalanceBoard board, CornerForces forces, stream::DeviceRole role,
          const device_models::LinkConfig& link);

  const device_models::Identity& identity() const;
  stream::DeviceRole role() const { return role_; }

  /// What the device answers to an output report.
  std::vector<device_models::Report> HandleOutput(std::span<const std::uint8_t> output);

  struct Arrival {
    double arrives_s = 0;
    double sampled_s = 0;  ///< When the sensor took the value that arrives.
  };
  /// The next delivery; later than the one before.
  Arrival Next();
  /// The report with the value of `sampled_s`; none while the host has set no mode.
  std::optional<device_models::Report> Deliver(double sampled_s);
  /// The motion begins anew at time 0, with the device fresh from its box, as after a new
  /// connection.
  void Restart();

  /// A line for the log when LEDs or rumble changed since the last call; empty otherwise.
  std::string Changes();

 private:
  using Device = std::variant<device_models::Wiimote, device_models::BalanceBoard>;

  Device fresh_;
  Device device_;
  SpecificForce force_;
  CornerForces forces_;
  stream::DeviceRole role_;
  device_models::LinkConfig link_config_;
  device_models::LinkModel link_;
  double held_s_ = -1;  ///< The sensor holds one value until it takes the next.
  Eigen::Vector3d held_force_ = Eigen::Vector3d::Zero();
  device_models::CornerForces held_corners_;
  std::uint8_t leds_ = 0;
  bool rumble_ = false;
};

}  // namespace footing::stream_client
