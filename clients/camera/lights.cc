#include "clients/camera/lights.h"

#include <algorithm>
#include <utility>

#include "common/frames/camera_file.h"
#include "common/wire/wire.h"

namespace footing::camera {
namespace {

constexpr std::uint32_t kAnswerWithinMs = 3000;

transport::ClientOptions OptionsFor(const transport::Address& address) {
  transport::ClientOptions options;
  options.address = address;
  options.client_name = "footing-camera";
  options.role = v1::ROLE_CONTROL;
  options.channels = {"status"};
  options.max_hz = 10;
  return options;
}

}  // namespace

Lights::Lights(boost::asio::io_context& io, const transport::Address& address,
               std::function<void()> on_devices)
    : on_devices_(std::move(on_devices)),
      client_(io, OptionsFor(address),
              {.on_welcome = [](const v1::Welcome&) {},
               .on_tick = [this](const v1::Tick& tick) { OnTick(tick); },
               .on_gap = [](const v1::Gap&) {},
               .on_state = [this](transport::LinkState, const std::string& why) { link_ = why; }}) {
}

void Lights::OnTick(const v1::Tick& tick) {
  if (!tick.has_status()) return;
  moves_.clear();
  for (const v1::DeviceStatus& one : tick.status().devices()) {
    stream::DeviceStatus device = wire::FromProto(one);
    if (device.kind == stream::DeviceKind::kPsMove && device.state != stream::DeviceState::kLost &&
        frames::CanHoldSphere(device.role))
      moves_.push_back(std::move(device));
  }
  std::stable_sort(moves_.begin(), moves_.end(),
                   [](const auto& a, const auto& b) { return a.role < b.role; });
  has_list_ = true;
  on_devices_();
}

void Lights::Set(std::uint32_t device, std::uint32_t rgb, std::function<void(Result<void>)> done) {
  v1::Command command;
  command.set_deadline_ms(kAnswerWithinMs);
  command.mutable_set_sphere()->set_device(device);
  command.mutable_set_sphere()->set_rgb(rgb);
  client_.Send(std::move(command), [done = std::move(done)](const v1::CommandResult& result) {
    done(result.ok() ? Result<void>() : Failure(result.message()));
  });
}

}  // namespace footing::camera
