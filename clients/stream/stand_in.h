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

/// One device stand-in: a device model, what its sensor feels, and the link it is heard over.
///
/// The sensor takes a value at its own rate and holds it; the link delivers reports in intervals of
/// its own. So repeats and bursts arise as they do on a real link (a Wiimote samples at 100 Hz, a
/// board at about 60 Hz, both are heard at the link's pace).
class StandIn {
 public:
  using SpecificForce = std::function<Eigen::Vector3d(double t_s)>;
  using CornerForces = std::function<device_models::CornerForces(double t_s)>;

  StandIn(device_models::Wiimote wiimote, SpecificForce force, stream::DeviceRole role,
          device_models::LinkModel link);
  StandIn(device_models::BalanceBoard board, CornerForces forces, stream::DeviceRole role,
          device_models::LinkModel link);

  const device_models::Identity& identity() const;
  stream::DeviceRole role() const { return role_; }

  /// What the device answers to an output report.
  std::vector<device_models::Report> HandleOutput(std::span<const std::uint8_t> output,
                                                  std::int64_t now_ns);

  struct Delivery {
    std::optional<device_models::Report> report;  ///< None while the host has set no mode.
    double sampled_s = 0;                         ///< When the sensor took the value.
  };
  /// The report delivered at t_s since the start of the motion.
  Delivery Deliver(double t_s, std::int64_t now_ns);

  /// From one delivery to the next.
  std::int64_t NextIntervalNs() { return link_.NextIntervalNs(); }

  /// A line for the log when LEDs or rumble changed since the last call; empty otherwise.
  std::string Changes();

 private:
  std::optional<device_models::Wiimote> wiimote_;
  std::optional<device_models::BalanceBoard> board_;
  SpecificForce force_;
  CornerForces forces_;
  stream::DeviceRole role_;
  device_models::LinkModel link_;
  double sensor_rate_hz_;
  std::uint32_t leds_ = 0;
  bool rumble_ = false;
};

}  // namespace footing::stream_client
