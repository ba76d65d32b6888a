#pragma once

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "common/stream/device.h"
#include "common/virtual/devices/joycon.h"
#include "common/virtual/devices/link_model.h"
#include "common/virtual/people/style.h"
#include "daemon/sensor/service/hub.h"

namespace footing::eval {

/// Joy-Cons of a synthetic user, from what they feel to what footingd publishes: simulated devices
/// that speak their protocol over a good link, and footingd's own hub. Times are simulated.
class HeldJoycons {
 public:
  static constexpr double kStepS = 0.005;  ///< Between two samples of a sensor.

  /// One for each role, right ones for the right hand and leg; returns when all are live.
  HeldJoycons(const std::vector<stream::DeviceRole>& roles, std::uint64_t seed);

  /// The next sample of every sensor.
  void Feel(const users::Felt& felt);
  /// The content that footingd publishes now.
  sensor::TickContent Tick() { return hub_.Tick(now_ns_); }

 private:
  struct Held {
    stream::DeviceRole role = stream::DeviceRole::kUnspecified;
    virtual_devices::Joycon device;
    virtual_devices::LinkModel link;
    noise::Random random;
    virtual_devices::LinkModel::Arrival next = {};
    virtual_devices::JoyconBurst burst = {};
    /// Reports and when they arrive.
    std::deque<std::pair<std::int64_t, virtual_devices::Report>> on_the_way = {};
  };

  void Sample(const users::Felt& felt, Held& held);

  std::int64_t now_ns_ = 1'000'000'000;
  std::vector<Held> held_;
  sensor::Hub hub_;
};

}  // namespace footing::eval
