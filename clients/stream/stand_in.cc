#include "clients/stream/stand_in.h"

#include <utility>

#include "common/units/units.h"

namespace footing::stream_client {

using device_models::BalanceBoard;
using device_models::Wiimote;

StandIn::StandIn(Wiimote wiimote, SpecificForce force, stream::DeviceRole role,
                 const device_models::LinkConfig& link)
    : fresh_(std::move(wiimote)),
      device_(fresh_),
      force_(std::move(force)),
      role_(role),
      link_config_(link),
      link_(link, 0) {}

StandIn::StandIn(BalanceBoard board, CornerForces forces, stream::DeviceRole role,
                 const device_models::LinkConfig& link)
    : fresh_(std::move(board)),
      device_(fresh_),
      forces_(std::move(forces)),
      role_(role),
      link_config_(link),
      link_(link, 0) {}

const device_models::Identity& StandIn::identity() const {
  return std::visit(
      [](const auto& device) -> const auto& { return device.identity(); }, device_);
}

std::vector<device_models::Report> StandIn::HandleOutput(std::span<const std::uint8_t> output) {
  return std::visit([output](auto& device) { return device.HandleOutput(output); }, device_);
}

StandIn::Arrival StandIn::Next() {
  const device_models::LinkModel::Arrival arrival = link_.Next();
  return {NanosecondsToSeconds(arrival.arrives_ns), NanosecondsToSeconds(arrival.sampled_ns)};
}

std::optional<device_models::Report> StandIn::Deliver(double sampled_s) {
  auto* wiimote = std::get_if<Wiimote>(&device_);
  if (sampled_s != held_s_) {
    held_s_ = sampled_s;
    if (wiimote != nullptr) {
      held_force_ = force_(sampled_s);
    } else {
      held_corners_ = forces_(sampled_s);
    }
  }
  if (wiimote != nullptr) return wiimote->Sample(held_force_);
  return std::get<BalanceBoard>(device_).Sample(held_corners_);
}

void StandIn::Restart() {
  device_ = fresh_;
  link_ = device_models::LinkModel(link_config_, 0);
  held_s_ = -1;
  leds_ = 0;
  rumble_ = false;
}

std::string StandIn::Changes() {
  const auto [leds, rumble] = std::visit(
      [](const auto& device) { return std::pair(device.leds(), device.rumble()); }, device_);
  std::string line;
  if (leds != leds_) line += " LEDs " + std::to_string(leds);
  if (rumble != rumble_) line += rumble ? " rumble on" : " rumble off";
  leds_ = leds;
  rumble_ = rumble;
  return line.empty() ? line : identity().serial + line;
}

}  // namespace footing::stream_client
