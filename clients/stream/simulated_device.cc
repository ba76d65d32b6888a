#include "clients/stream/simulated_device.h"

#include <cstdio>
#include <limits>
#include <utility>

#include "common/base/units.h"

namespace footing::stream_client {

using virtual_devices::Report;

namespace {

/// What the host sets is not looked at.
SimulatedDevice::Shown Show(const RecordedDevice&, std::int64_t) { return {}; }

template <typename Remote>
SimulatedDevice::Shown Show(const Remote& remote, std::int64_t) {
  return {" LEDs " + std::to_string(remote.leds()), remote.rumble()};
}

SimulatedDevice::Shown Show(const virtual_devices::PsMove& move, std::int64_t now_ns) {
  char sphere[32];
  std::snprintf(sphere, sizeof sphere, " sphere #%06x", move.sphere_rgb(now_ns));
  return {sphere, move.rumble(now_ns) != 0};
}

std::vector<Report> Sample(virtual_devices::Wiimote& wiimote, std::int64_t now_ns,
                           const virtual_devices::WiimoteSensors& sensors) {
  return wiimote.Sample(now_ns, sensors);
}

std::vector<Report> Sample(virtual_devices::BalanceBoard& board, std::int64_t,
                           const virtual_devices::CornerForces& forces) {
  const auto report = board.Sample(forces);
  return report ? std::vector<Report>{*report} : std::vector<Report>{};
}

std::vector<Report> Sample(virtual_devices::PsMove& move, std::int64_t now_ns,
                           const virtual_devices::MoveSensors& sensors) {
  return move.Sample(now_ns, sensors);
}

}  // namespace

SimulatedDevice::SimulatedDevice(Device device, stream::DeviceRole role,
                                 const virtual_devices::LinkConfig& link)
    : fresh_(std::move(device)), device_(fresh_), role_(role), link_config_(link), link_(link, 0) {
  Restart();
}

SimulatedDevice::SimulatedDevice(virtual_devices::Wiimote wiimote, WiimoteMotion motion,
                                 stream::DeviceRole role, const virtual_devices::LinkConfig& link)
    : SimulatedDevice(Device(Wiimote{std::move(wiimote), std::move(motion)}), role, link) {}

SimulatedDevice::SimulatedDevice(virtual_devices::BalanceBoard board, CornerForces forces,
                                 stream::DeviceRole role, const virtual_devices::LinkConfig& link)
    : SimulatedDevice(Device(Board{std::move(board), std::move(forces)}), role, link) {}

SimulatedDevice::SimulatedDevice(virtual_devices::PsMove move, MoveMotion motion,
                                 stream::DeviceRole role, const virtual_devices::LinkConfig& link)
    : SimulatedDevice(Device(Move{std::move(move), std::move(motion)}), role, link) {}

SimulatedDevice::SimulatedDevice(RecordedDevice recorded, stream::DeviceRole role)
    : SimulatedDevice(Device(Recorded{std::move(recorded)}), role, {}) {}

const virtual_devices::Identity& SimulatedDevice::identity() const {
  return std::visit(
      [](const auto& felt) -> const auto& { return felt.device.identity(); }, device_);
}

std::vector<Report> SimulatedDevice::HandleOutput(double now_s,
                                                  std::span<const std::uint8_t> output) {
  const std::int64_t now_ns = SecondsToNanoseconds(now_s);
  return std::visit([=](auto& felt) { return felt.device.HandleOutput(now_ns, output); }, device_);
}

Report SimulatedDevice::Feature(std::uint8_t id, std::size_t size) {
  if (auto* recorded = std::get_if<Recorded>(&device_)) return recorded->device.Feature(id, size);
  auto* move = std::get_if<Move>(&device_);
  return move == nullptr ? Report() : move->device.Feature(id, size).value_or(Report());
}

double SimulatedDevice::attaches_s() const {
  const auto* recorded = std::get_if<Recorded>(&device_);
  return recorded == nullptr ? 0 : recorded->device.attaches_s();
}

double SimulatedDevice::detaches_s() const {
  const auto* recorded = std::get_if<Recorded>(&device_);
  return recorded == nullptr ? std::numeric_limits<double>::infinity()
                             : recorded->device.detaches_s();
}

SimulatedDevice::Arrival SimulatedDevice::Next() {
  if (const auto* recorded = std::get_if<Recorded>(&device_)) {
    const double time_s =
        recorded->device.NextTime().value_or(std::numeric_limits<double>::infinity());
    return {time_s, time_s};
  }
  const virtual_devices::LinkModel::Arrival arrival = link_.Next();
  return {NanosecondsToSeconds(arrival.arrives_ns), NanosecondsToSeconds(arrival.sampled_ns)};
}

std::vector<Report> SimulatedDevice::Deliver(double sampled_s) {
  if (auto* recorded = std::get_if<Recorded>(&device_)) return {recorded->device.Take()};
  const bool fresh = sampled_s != held_s_;
  held_s_ = sampled_s;
  return std::visit(
      [=](auto& felt) -> std::vector<Report> {
        if constexpr (requires { felt.motion; }) {
          if (fresh) felt.held = felt.motion(sampled_s);
          return Sample(felt.device, SecondsToNanoseconds(sampled_s), felt.held);
        } else {
          return {};
        }
      },
      device_);
}

void SimulatedDevice::Restart() {
  device_ = fresh_;
  link_ = virtual_devices::LinkModel(link_config_, 0);
  held_s_ = -1;
  shown_ = Show(0);
}

SimulatedDevice::Shown SimulatedDevice::Show(double now_s) const {
  const std::int64_t now_ns = SecondsToNanoseconds(now_s);
  return std::visit([=](const auto& felt) { return stream_client::Show(felt.device, now_ns); },
                    device_);
}

std::optional<std::uint32_t> SimulatedDevice::SphereLight(double now_s) const {
  const auto* move = std::get_if<Move>(&device_);
  if (move == nullptr) return std::nullopt;
  return move->device.sphere_rgb(SecondsToNanoseconds(now_s));
}

std::string SimulatedDevice::Changes(double now_s) {
  const Shown shown = Show(now_s);
  std::string line;
  if (shown.lights != shown_.lights) line += shown.lights;
  if (shown.rumble != shown_.rumble) line += shown.rumble ? " rumble on" : " rumble off";
  shown_ = shown;
  return line.empty() ? line : identity().serial + line;
}

}  // namespace footing::stream_client
