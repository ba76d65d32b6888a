#include "daemon/offline/eval/held_devices.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::eval {
namespace {

using stream::DeviceRole;
using virtual_devices::JoyconModel;
using virtual_devices::LinkQuality;

constexpr std::int64_t kStepNs = 5'000'000;

JoyconModel ModelFor(DeviceRole role) {
  const bool right = role == DeviceRole::kRightHand || role == DeviceRole::kRightLeg;
  return right ? JoyconModel::kRight : JoyconModel::kLeft;
}

Eigen::Vector3d ForceAt(DeviceRole role, const users::Felt& felt) {
  for (int i = 0; i < felt.remote_count; ++i) {
    const users::FeltRemote& remote = felt.remotes[static_cast<std::size_t>(i)];
    if (remote.role == role) return remote.specific_force_S_mps2;
  }
  return {0, 0, -kStandardGravityMps2};
}

}  // namespace

HeldDevices::HeldDevices(HeldKind kind, const std::vector<DeviceRole>& roles, std::uint64_t seed,
                         const users::Felt& at_rest)
    : hub_({}, {[this](devices::DeviceHandle handle, const reports::OutputReport& report) {
                  Held& held = held_[handle - 1];
                  auto* joycon = std::get_if<HeldJoycon>(&held.device);
                  if (joycon == nullptr) return;
                  for (auto& answer : joycon->device.HandleOutput(now_ns_, report)) {
                    held.on_the_way.emplace_back(held.next.arrives_ns, std::move(answer));
                  }
                },
                [](const sensor::LogLine&) {}, [this] { return now_ns_; }}) {
  for (const DeviceRole role : roles) Add(kind, role, 1000 * seed + held_.size());
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const virtual_devices::Identity& own = std::visit(
        [](const auto& one) -> const auto& { return one.identity(); }, held_[i].device);
    devices::DeviceIdentity identity;
    identity.vendor = own.vendor;
    identity.product = own.product;
    identity.name = own.name;
    identity.serial = own.serial;
    identity.simulated = true;
    identity.wished_role = held_[i].role;
    hub_.OnAttach(i + 1, identity);
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

void HeldDevices::Add(HeldKind kind, DeviceRole role, std::uint64_t seed) {
  if (kind == HeldKind::kPhone) {
    held_.push_back({role, virtual_devices::Phone(seed),
                     virtual_devices::LinkModel(
                         virtual_devices::PhoneLink(LinkQuality::kGood, seed), now_ns_)});
  } else {
    held_.push_back({role,
                     HeldJoycon{virtual_devices::Joycon(seed, ModelFor(role)), noise::Random(seed)},
                     virtual_devices::LinkModel(
                         virtual_devices::JoyconLink(LinkQuality::kGood, seed), now_ns_)});
  }
  held_.back().next = held_.back().link.Next();
}

void HeldDevices::Sample(const users::Felt& felt, const Eigen::Vector3d& force_S_mps2,
                         HeldJoycon& joycon, Held& held) {
  virtual_devices::JoyconSensors sensors;
  sensors.specific_force_S_mps2 = force_S_mps2;
  sensors.stick_x = felt.stick_x;
  sensors.stick_y = felt.stick_y;
  sensors.buttons = felt.button_a ? virtual_devices::kJoyconA | virtual_devices::kJoyconL : 0;
  std::rotate(joycon.burst.begin(), joycon.burst.begin() + 1, joycon.burst.end());
  joycon.burst.back() = virtual_devices::WithNoise(sensors, joycon.random);
  if (held.next.sampled_ns > now_ns_ + kStepNs / 2) return;
  for (auto& report : joycon.device.Sample(now_ns_, joycon.burst)) {
    held.on_the_way.emplace_back(held.next.arrives_ns, std::move(report));
  }
  held.next = held.link.Next();
}

void HeldDevices::Sample(const Eigen::Vector3d& force_S_mps2, virtual_devices::Phone& phone,
                         Held& held) {
  phone.Feel(now_ns_, {force_S_mps2});
  for (; held.next.sampled_ns <= now_ns_; held.next = held.link.Next()) {
    held.on_the_way.emplace_back(held.next.arrives_ns, phone.Event(held.next.sampled_ns));
  }
}

void HeldDevices::Feel(const users::Felt& felt) {
  now_ns_ += kStepNs;
  for (Held& held : held_) {
    const Eigen::Vector3d force_S_mps2 = ForceAt(held.role, felt);
    if (auto* joycon = std::get_if<HeldJoycon>(&held.device)) {
      Sample(felt, force_S_mps2, *joycon, held);
    } else {
      Sample(force_S_mps2, std::get<virtual_devices::Phone>(held.device), held);
    }
  }
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
