#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/joycon.h"
#include "common/virtual/devices/wiimote.h"
#include "daemon/sensor/service/hub.h"

namespace footing::sensor {

/// A hub with device models at its ports and a clock that the test moves: ticks every 10 ms, a
/// report of every attached model a tick.
class Bench {
 public:
  using Model = std::variant<virtual_devices::Wiimote, virtual_devices::BalanceBoard,
                             virtual_devices::Joycon>;

  explicit Bench(const Config& config = {}, const setup::Storage& storage = {})
      : hub_(config, {[this](devices::DeviceHandle handle, const reports::OutputReport& report) {
                        Answer(handle, report);
                      },
                      [this](const LogLine& line) { log.push_back(line.text); },
                      [this] { return now_ns_; }, nullptr, nullptr, nullptr, storage,
                      [this](devices::DeviceHandle handle, const std::string&) {
                        refused.push_back(handle);
                      }}) {}

  devices::DeviceHandle Attach(Model model, const std::string& serial = "", bool simulated = true) {
    const auto& own = std::visit(
        [](const auto& one) -> const auto& { return one.identity(); }, model);
    devices::DeviceIdentity identity;
    identity.vendor = own.vendor;
    identity.product = own.product;
    identity.name = own.name;
    identity.serial = serial.empty() ? own.serial : serial;
    identity.place = "bench";
    identity.simulated = simulated;
    identity.wished_role = wish;
    const devices::DeviceHandle handle = ++last_handle_;
    models_.emplace(handle, std::move(model));
    hub_.OnAttach(handle, identity);
    return handle;
  }
  void Detach(devices::DeviceHandle handle) {
    models_.erase(handle);
    hub_.OnDetach(handle, "pulled");
  }
  void Receive(devices::DeviceHandle handle, const std::vector<std::uint8_t>& report) {
    hub_.OnReport(handle, {now_ns_, report, 0});
  }

  /// Runs ticks; what they publish adds up in `content`.
  void Advance(double seconds) {
    for (int tick = 0; tick < static_cast<int>(seconds / 0.01 + 0.5); ++tick) {
      now_ns_ += 10'000'000;
      for (auto answers = std::exchange(answers_, {}); const auto& [handle, report] : answers) {
        Receive(handle, report);
      }
      for (auto& [handle, model] : models_) {
        if (silent) continue;
        if (const auto report = Sample(model)) Receive(handle, *report);
      }
      Append(hub_.Tick(now_ns_));
    }
  }

  const stream::DeviceStatus& StatusOf(const std::string& serial) const {
    for (const auto& status : content.status) {
      if (status.serial == serial) return status;
    }
    ADD_FAILURE() << "no status of " << serial;
    static const stream::DeviceStatus kNone;
    return kNone;
  }
  template <typename Device>
  Device& ModelOf(devices::DeviceHandle handle) {
    return std::get<Device>(models_.at(handle));
  }
  Hub& hub() { return hub_; }
  std::int64_t now_ns() const { return now_ns_; }

  TickContent content;
  std::vector<std::string> log;
  std::vector<devices::DeviceHandle> refused;  ///< Devices that gave way to real ones.
  std::function<Eigen::Vector3d(double t_s)> force = [](double) {
    return Eigen::Vector3d(0, 0, -9.80665);
  };
  virtual_devices::CornerForces corners{150, 150, 150, 150};
  stream::DeviceRole wish = stream::DeviceRole::kUnspecified;
  bool silent = false;

 private:
  std::optional<virtual_devices::Report> Sample(Model& model) {
    if (auto* wiimote = std::get_if<virtual_devices::Wiimote>(&model)) {
      return wiimote->Sample(force(static_cast<double>(now_ns_) * 1e-9));
    }
    if (auto* joycon = std::get_if<virtual_devices::Joycon>(&model)) return Sample(*joycon);
    return std::get<virtual_devices::BalanceBoard>(model).Sample(corners);
  }
  /// Every 15 ms, at the tick that follows.
  std::optional<virtual_devices::Report> Sample(virtual_devices::Joycon& joycon) const {
    constexpr std::int64_t kPeriodNs = 15'000'000, kSpacingNs = 5'000'000;
    if (now_ns_ % kPeriodNs >= 10'000'000) return std::nullopt;
    const std::int64_t newest_ns = now_ns_ - now_ns_ % kPeriodNs;
    virtual_devices::JoyconBurst burst;
    for (std::size_t i = 0; i < burst.size(); ++i) {
      const std::int64_t at_ns = newest_ns - static_cast<std::int64_t>(2 - i) * kSpacingNs;
      burst[i].specific_force_S_mps2 = force(static_cast<double>(at_ns) * 1e-9);
    }
    const auto reports = joycon.Sample(newest_ns, burst);
    return reports.empty() ? std::nullopt : std::optional(reports.front());
  }
  void Answer(devices::DeviceHandle handle, const reports::OutputReport& report) {
    const auto model = models_.find(handle);
    if (model == models_.end()) return;
    auto answers = std::visit(
        [&](auto& one) {
          if constexpr (requires { one.HandleOutput(report); }) {
            return one.HandleOutput(report);
          } else {
            return one.HandleOutput(now_ns_, report);
          }
        },
        model->second);
    for (auto& answer : answers) answers_.emplace_back(handle, std::move(answer));
  }
  void Append(TickContent tick) {
    const auto add = [](auto& to, auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    if (!tick.config.empty()) content.config = tick.config;
    add(content.motion, tick.motion);
    add(content.boards, tick.boards);
    add(content.raw, tick.raw);
    add(content.hands, tick.hands);
    add(content.reference, tick.reference);
    add(content.contacts, tick.contacts);
    if (tick.has_setup) content.setup = std::move(tick.setup);
    content.features = std::move(tick.features);
    if (tick.has_status) content.status = std::move(tick.status);
  }

  std::int64_t now_ns_ = 1'000'000'000;
  devices::DeviceHandle last_handle_ = 0;
  std::map<devices::DeviceHandle, Model> models_;
  std::deque<std::pair<devices::DeviceHandle, virtual_devices::Report>> answers_;
  Hub hub_;
};

}  // namespace footing::sensor
