#include "daemon/offline/eval/held_joycons.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::eval {
namespace {

using stream::DeviceRole;
using virtual_devices::JoyconModel;

constexpr std::int64_t kStepNs = 5'000'000;

JoyconModel ModelFor(DeviceRole role) {
  const bool right = role == DeviceRole::kRightHand || role == DeviceRole::kRightLeg;
  return right ? JoyconModel::kRight : JoyconModel::kLeft;
}

}  // namespace

HeldJoycons::HeldJoycons(const std::vector<DeviceRole>& roles, std::uint64_t seed)
    : hub_({}, {[this](devices::DeviceHandle handle, const reports::OutputReport& report) {
                  Held& held = held_[handle - 1];
                  for (auto& answer : held.device.HandleOutput(now_ns_, report)) {
                    held.on_the_way.emplace_back(held.next.arrives_ns, std::move(answer));
                  }
                },
                [](const sensor::LogLine&) {}, [this] { return now_ns_; }}) {
  for (const DeviceRole role : roles) {
    const std::uint64_t own = 1000 * seed + held_.size();
    held_.push_back(
        {role, virtual_devices::Joycon(own, ModelFor(role)),
         virtual_devices::LinkModel(
             virtual_devices::JoyconLink(virtual_devices::LinkQuality::kGood, own), now_ns_),
         noise::Random(own)});
    held_.back().next = held_.back().link.Next();
  }
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const virtual_devices::Identity& own = held_[i].device.identity();
    devices::DeviceIdentity identity;
    identity.vendor = own.vendor;
    identity.product = own.product;
    identity.name = own.name;
    identity.serial = own.serial;
    identity.simulated = true;
    identity.wished_role = held_[i].role;
    hub_.OnAttach(i + 1, identity);
  }
  users::Felt at_rest;
  for (const DeviceRole role : roles) {
    at_rest.remotes[static_cast<std::size_t>(at_rest.remote_count++)] = {
        role, {0, 0, -kStandardGravityMps2}};
  }
  for (std::size_t live = 0; live < roles.size();) {
    Feel(at_rest);
    Feel(at_rest);
    const sensor::TickContent content = Tick();
    if (!content.has_status) continue;
    live = static_cast<std::size_t>(
        std::count_if(content.status.begin(), content.status.end(), [](const auto& status) {
          return status.state == stream::DeviceState::kLive && status.reports > 0;
        }));
  }
}

void HeldJoycons::Sample(const users::Felt& felt, Held& held) {
  virtual_devices::JoyconSensors sensors;
  for (int i = 0; i < felt.remote_count; ++i) {
    const users::FeltRemote& remote = felt.remotes[static_cast<std::size_t>(i)];
    if (remote.role == held.role) sensors.specific_force_S_mps2 = remote.specific_force_S_mps2;
  }
  sensors.stick_x = felt.stick_x;
  sensors.stick_y = felt.stick_y;
  sensors.buttons = felt.button_a ? virtual_devices::kJoyconA | virtual_devices::kJoyconL : 0;
  std::rotate(held.burst.begin(), held.burst.begin() + 1, held.burst.end());
  held.burst.back() = virtual_devices::WithNoise(sensors, held.random);
  if (held.next.sampled_ns > now_ns_ + kStepNs / 2) return;
  for (auto& report : held.device.Sample(now_ns_, held.burst)) {
    held.on_the_way.emplace_back(held.next.arrives_ns, std::move(report));
  }
  held.next = held.link.Next();
}

void HeldJoycons::Feel(const users::Felt& felt) {
  now_ns_ += kStepNs;
  for (Held& held : held_) Sample(felt, held);
  for (std::size_t i = 0; i < held_.size(); ++i) {
    auto& waiting = held_[i].on_the_way;
    while (!waiting.empty() && waiting.front().first <= now_ns_) {
      const auto [arrived_ns, report] = std::move(waiting.front());
      waiting.pop_front();
      hub_.OnReport(i + 1, {arrived_ns, report, 0});
    }
  }
}

}  // namespace footing::eval
