#include "clients/stream/stand_in.h"

#include <array>
#include <cstdio>
#include <utility>

#include "common/units/units.h"

namespace footing::stream_client {
namespace {

using device_models::BalanceBoard;
using device_models::Wiimote;

/// Two of a run must not share it: it tells devices apart.
std::string SerialOf(std::uint64_t seed) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "02:%02x:%02x:%02x:%02x:%02x",
                static_cast<unsigned>((seed >> 32) & 0xff),
                static_cast<unsigned>((seed >> 24) & 0xff),
                static_cast<unsigned>((seed >> 16) & 0xff),
                static_cast<unsigned>((seed >> 8) & 0xff), static_cast<unsigned>(seed & 0xff));
  return text.data();
}

}  // namespace

StandIn::StandIn(std::uint64_t seed, device_models::LinkQuality link, stream::DeviceRole role,
                 SpecificForce force)
    : seed_(seed),
      link_config_(device_models::WiimoteLink(link, seed)),
      role_(role),
      force_(std::move(force)),
      identity_{5, Wiimote::kVendor, Wiimote::kProduct, Wiimote::kName, SerialOf(seed)} {
  Begin();
}

StandIn::StandIn(std::uint64_t seed, device_models::LinkQuality link, stream::DeviceRole role,
                 CornerForces forces)
    : seed_(seed),
      link_config_(device_models::BoardLink(link, seed)),
      role_(role),
      forces_(std::move(forces)),
      identity_{5, BalanceBoard::kVendor, BalanceBoard::kProduct, BalanceBoard::kName,
                SerialOf(seed)} {
  Begin();
}

void StandIn::Begin() {
  if (force_) {
    wiimote_.emplace(seed_);
  } else {
    board_.emplace(seed_);
  }
  link_.emplace(link_config_, 0);
  next_ = link_->Next();
  leds_ = 0;
  rumble_ = false;
}

device_models::Controller& StandIn::controller() {
  return wiimote_ ? wiimote_->controller() : board_->controller();
}

std::vector<device_models::Report> StandIn::HandleOutput(std::span<const std::uint8_t> output) {
  return controller().HandleOutput(output);
}

double StandIn::NextArrivalSeconds() const { return NanosecondsToSeconds(next_.arrives_ns); }

StandIn::Delivery StandIn::Deliver() {
  Delivery delivery;
  delivery.arrives_s = NanosecondsToSeconds(next_.arrives_ns);
  delivery.sampled_s = NanosecondsToSeconds(next_.sampled_ns);
  delivery.report = wiimote_ ? wiimote_->Sample(force_(delivery.sampled_s))
                             : board_->Sample(forces_(delivery.sampled_s));
  next_ = link_->Next();
  return delivery;
}

std::string StandIn::Changes() {
  std::string line;
  if (controller().leds() != leds_) line += " LEDs " + std::to_string(controller().leds());
  if (controller().rumble() != rumble_)
    line += controller().rumble() ? " rumble on" : " rumble off";
  leds_ = controller().leds();
  rumble_ = controller().rumble();
  return line.empty() ? line : identity_.serial + line;
}

}  // namespace footing::stream_client
