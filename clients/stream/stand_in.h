#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/device_models/balance_board.h"
#include "common/device_models/link_model.h"
#include "common/device_models/wiimote.h"
#include "common/stream/device.h"

namespace footing::stream_client {

/// What footingd is told when the device appears.
struct Identity {
  std::uint32_t bus = 5;  ///< Bluetooth.
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::string name;
  std::string serial;  ///< An address of its own, locally administered, drawn from the seed.
};

/// One device stand-in: a device model, what its sensor feels, and the link it is heard over.
///
/// The sensor takes a value at its own rate and holds it; the link delivers reports at its own
/// pace. So repeats and bursts arise as they do over Bluetooth (see device_models::LinkModel).
class StandIn {
 public:
  /// Of the time since the motion began. Called with times that never go back.
  using SpecificForce = std::function<Eigen::Vector3d(double t_s)>;
  using CornerForces = std::function<device_models::BoardForces(double t_s)>;

  /// A Wiimote; `seed` draws its calibration, its address and its link.
  StandIn(std::uint64_t seed, device_models::LinkQuality link, stream::DeviceRole role,
          SpecificForce force);
  /// A Balance Board.
  StandIn(std::uint64_t seed, device_models::LinkQuality link, stream::DeviceRole role,
          CornerForces forces);

  const Identity& identity() const { return identity_; }
  stream::DeviceRole role() const { return role_; }

  /// The motion begins, with the device fresh from its box and the link anew.
  void Begin();

  /// What the device answers to an output report.
  std::vector<device_models::Report> HandleOutput(std::span<const std::uint8_t> output);

  struct Delivery {
    double arrives_s = 0;                         ///< Since the motion began.
    double sampled_s = 0;                         ///< When the sensor took the value.
    std::optional<device_models::Report> report;  ///< None while the host has set no mode.
  };
  /// When the next report arrives.
  double NextArrivalSeconds() const;
  /// That report; the one after it is next.
  Delivery Deliver();

  /// A line for the log when LEDs or rumble changed since the last call; empty otherwise.
  std::string Changes();

 private:
  device_models::Controller& controller();

  std::uint64_t seed_;
  device_models::LinkConfig link_config_;
  stream::DeviceRole role_;
  SpecificForce force_;
  CornerForces forces_;
  Identity identity_;
  std::optional<device_models::Wiimote> wiimote_;
  std::optional<device_models::BalanceBoard> board_;
  std::optional<device_models::LinkModel> link_;
  device_models::LinkModel::Arrival next_;
  std::uint32_t leds_ = 0;
  bool rumble_ = false;
};

}  // namespace footing::stream_client
