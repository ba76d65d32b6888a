#pragma once

#include <cstdint>
#include <deque>
#include <utility>
#include <variant>
#include <vector>

#include "common/stream/device.h"
#include "common/virtual/devices/joycon.h"
#include "common/virtual/devices/link_model.h"
#include "common/virtual/devices/phone.h"
#include "common/virtual/people/style.h"
#include "daemon/sensor/service/hub.h"

namespace footing::eval {

/// Devices that a synthetic user holds or wears.
enum class HeldKind {
  kWiimote,  ///< Its samples reach the features at once, without a link.
  kJoycon,
  kPhone,
};

/// Joy-Cons or phones of a synthetic user, from what they feel to what footingd publishes:
/// simulated devices that speak their protocol over a good link, and footingd's own hub. Times are
/// simulated.
class HeldDevices {
 public:
  static constexpr double kStepS = 0.005;  ///< Between two samples of a Joy-Con.

  /// One for each role, right Joy-Cons for the right hand and leg; returns when all are live, in
  /// the hands of somebody who feels `at_rest`.
  HeldDevices(HeldKind kind, const std::vector<stream::DeviceRole>& roles, std::uint64_t seed,
              const users::Felt& at_rest);

  /// The next input of every device, kStepS after the one before.
  void Feel(const users::Felt& felt);
  /// The content that footingd publishes now.
  sensor::TickContent Tick() { return hub_.Tick(now_ns_); }

 private:
  struct HeldJoycon {
    const virtual_devices::Identity& identity() const { return device.identity(); }

    virtual_devices::Joycon device;
    noise::Random random;
    virtual_devices::JoyconBurst burst = {};
  };
  struct Held {
    stream::DeviceRole role = stream::DeviceRole::kUnspecified;
    std::variant<HeldJoycon, virtual_devices::Phone> device;
    virtual_devices::LinkModel link;
    virtual_devices::LinkModel::Arrival next = {};
    /// Reports and when they arrive.
    std::deque<std::pair<std::int64_t, virtual_devices::Report>> on_the_way = {};
  };

  void Add(HeldKind kind, stream::DeviceRole role, std::uint64_t seed);
  void Sample(const users::Felt& felt, const Eigen::Vector3d& force_S_mps2, HeldJoycon& joycon,
              Held& held);
  void Sample(const Eigen::Vector3d& force_S_mps2, virtual_devices::Phone& phone, Held& held);

  std::int64_t now_ns_ = 1'000'000'000;
  std::vector<Held> held_;
  sensor::Hub hub_;
};

}  // namespace footing::eval
