#include "clients/stream/stand_in.h"

#include <cmath>
#include <utility>

namespace footing::stream_client {
namespace {

// facts of the devices: an accelerometer read 100 times a second; a board whose values change about
// 60 times a second.
constexpr double kWiimoteSensorHz = 100;
constexpr double kBoardSensorHz = 60;

}  // namespace

StandIn::StandIn(device_models::Wiimote wiimote, SpecificForce force, stream::DeviceRole role,
                 device_models::LinkModel link)
    : wiimote_(std::move(wiimote)),
      force_(std::move(force)),
      role_(role),
      link_(std::move(link)),
      sensor_rate_hz_(kWiimoteSensorHz) {}

StandIn::StandIn(device_models::BalanceBoard board, CornerForces forces, stream::DeviceRole role,
                 device_models::LinkModel link)
    : board_(std::move(board)),
      forces_(std::move(forces)),
      role_(role),
      link_(std::move(link)),
      sensor_rate_hz_(kBoardSensorHz) {}

const device_models::Identity& StandIn::identity() const {
  return wiimote_ ? wiimote_->identity() : board_->identity();
}

std::vector<device_models::Report> StandIn::HandleOutput(std::span<const std::uint8_t> output,
                                                         std::int64_t now_ns) {
  return wiimote_ ? wiimote_->HandleOutput(output, now_ns) : board_->HandleOutput(output, now_ns);
}

StandIn::Delivery StandIn::Deliver(double t_s, std::int64_t now_ns) {
  Delivery delivery;
  delivery.sampled_s = std::floor(t_s * sensor_rate_hz_ + 1e-6) / sensor_rate_hz_;
  delivery.report = wiimote_ ? wiimote_->Sample(force_(delivery.sampled_s), now_ns)
                             : board_->Sample(forces_(delivery.sampled_s), now_ns);
  return delivery;
}

std::string StandIn::Changes() {
  const std::uint32_t leds = wiimote_ ? wiimote_->leds() : board_->leds();
  const bool rumble = wiimote_ && wiimote_->rumble();
  std::string line;
  if (leds != leds_) line += " LEDs " + std::to_string(leds);
  if (rumble != rumble_) line += rumble ? " rumble on" : " rumble off";
  leds_ = leds;
  rumble_ = rumble;
  return line.empty() ? line : identity().serial + line;
}

}  // namespace footing::stream_client
