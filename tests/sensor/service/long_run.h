#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/base/units.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/link_model.h"
#include "daemon/sensor/service/hub.h"
#include "tests/sensor/reports/port_model.h"

namespace footing::sensor {
using handshake::PortModel;
using virtual_devices::BalanceBoard;
using virtual_devices::LinkModel;
using virtual_devices::LinkQuality;
using virtual_devices::Report;

constexpr std::int64_t kTickNs = 10'000'000;

/// A hub, devices behind a link model, and a clock that runs faster than time.
class LongRun {
 public:
  explicit LongRun(LinkQuality quality) : quality_(quality) {}

  void Add(std::variant<PortModel, BalanceBoard> model) {
    const bool board = std::holds_alternative<BalanceBoard>(model);
    const auto seed = static_cast<std::uint64_t>(devices_.size() + 1);
    const LinkModel link(board ? virtual_devices::BoardLink(quality_, seed)
                               : virtual_devices::WiimoteLink(quality_, seed),
                         now_ns_);
    const auto& own = std::visit(
        [](const auto& one) -> const auto& { return one.identity(); }, model);
    devices::DeviceIdentity identity;
    identity.name = own.name;
    identity.serial = own.serial;
    const devices::DeviceHandle handle = devices_.size() + 1;
    auto& device =
        devices_.emplace(handle, Simulated{std::move(model), link, {}, {}}).first->second;
    device.next = device.link.Next();
    hub_.OnAttach(handle, identity);
  }

  /// Runs ticks; each one's content goes to `on_tick`.
  template <typename OnTick>
  void Advance(double seconds, OnTick on_tick) {
    const auto end_ns = now_ns_ + static_cast<std::int64_t>(seconds * 1e9);
    while (now_ns_ < end_ns) {
      const std::int64_t tick_ns = now_ns_ + kTickNs;
      for (auto& [handle, device] : devices_) {
        Deliver(handle, std::exchange(device.answers, {}));
        while (device.next.arrives_ns <= tick_ns) {
          now_ns_ = std::max(now_ns_, device.next.arrives_ns);
          const bool lost = loses && loses(handle, device.next.arrives_ns);
          if (const auto report = lost ? std::nullopt : Sample(device)) {
            if (keeps_truth)
              true_ns[{static_cast<std::uint32_t>(handle), device.next.arrives_ns}] =
                  device.next.sampled_ns;
            hub_.OnReport(handle, {device.next.arrives_ns, *report, 0});
          }
          device.next = device.link.Next();
        }
        now_ns_ = tick_ns - kTickNs;
      }
      now_ns_ = tick_ns;
      on_tick(hub_.Tick(now_ns_));
    }
  }
  void Jump(double seconds) {
    const auto jump_ns = static_cast<std::int64_t>(seconds * 1e9);
    now_ns_ += jump_ns;
    for (auto& [handle, device] : devices_) {
      while (device.next.arrives_ns < now_ns_) device.next = device.link.Next();
    }
  }

  std::int64_t now_ns() const { return now_ns_; }
  /// Hands swing with 1.5 Hz and 6 m/s² until then.
  double moves_until_s = 1e9;
  /// Reports that get lost on their way; null: none.
  std::function<bool(devices::DeviceHandle, std::int64_t arrives_ns)> loses = {};
  /// When the sample of a report was taken, by device and arrival; kept while `keeps_truth`.
  std::map<std::pair<std::uint32_t, std::int64_t>, std::int64_t> true_ns;
  bool keeps_truth = false;

 private:
  struct Simulated {
    std::variant<PortModel, BalanceBoard> model;
    LinkModel link;
    LinkModel::Arrival next;
    std::vector<Report> answers;
  };

  void Deliver(devices::DeviceHandle handle, const std::vector<Report>& reports) {
    for (const Report& report : reports) hub_.OnReport(handle, {now_ns_, report, 0});
  }

  std::optional<Report> Sample(Simulated& device) {
    const double t_s = static_cast<double>(device.next.sampled_ns) * 1e-9;
    const double swing = t_s < moves_until_s ? 6 * std::sin(2 * kPi * 1.5 * t_s) : 0;
    if (auto* wiimote = std::get_if<PortModel>(&device.model)) {
      return wiimote->Sample({0, swing, -kStandardGravityMps2});
    }
    return std::get<BalanceBoard>(device.model)
        .Sample({150 + swing, 150 + 0.5 * swing, 150 - swing, 150 - 0.5 * swing});
  }

  void Answer(devices::DeviceHandle handle, const reports::OutputReport& report) {
    Simulated& device = devices_.at(handle);
    auto answers =
        std::visit([&report](auto& one) { return one.HandleOutput(report); }, device.model);
    device.answers.insert(device.answers.end(), answers.begin(), answers.end());
  }

  LinkQuality quality_;
  std::int64_t now_ns_ = 1'000'000'000;
  std::map<devices::DeviceHandle, Simulated> devices_;
  Hub hub_{Config(),
           {[this](devices::DeviceHandle handle, const reports::OutputReport& report) {
              Answer(handle, report);
            },
            [](const LogLine&) {}, [this] { return now_ns_; }}};
};

inline PortModel WithNunchuk(std::uint64_t seed) {
  return PortModel(PortModel::Child::kNunchuk, false, seed);
}

}  // namespace footing::sensor
