#include "clients/camera/light_checks.h"

#include <algorithm>
#include <string>
#include <utility>

#include "common/runtime/log.h"

namespace footing::camera {

LightChecks::LightChecks(const frames::CameraFile& camera, bool challenges, SetLight set,
                         std::function<std::int64_t()> now_ns)
    : challenges_(challenges), set_(std::move(set)), now_ns_(std::move(now_ns)) {
  for (const frames::HeldSphere& one : camera.spheres) held_.push_back({one.role, one.led_rgb});
}

std::uint32_t LightChecks::Wanted(const Held& held) const {
  return held.challenge.is_dark() ? 0 : *held.led_rgb;
}

void LightChecks::TakeMoves(const std::vector<stream::DeviceStatus>& moves) {
  for (Held& held : held_) {
    if (!held.led_rgb) continue;
    const auto move = std::find_if(moves.begin(), moves.end(),
                                   [&](const auto& one) { return one.role == held.role; });
    const auto device = move == moves.end() ? std::optional<std::uint32_t>() : move->device;
    if (device != held.device) {
      passed_before_ += held.challenge.passed();
      refused_before_ += held.challenge.refusals();
      held.challenge = Challenge();
      held.switches = 0;
      held.device = device;
    }
    if (!device || move->sphere_rgb == Wanted(held)) continue;
    set_(*device, Wanted(held), [serial = move->serial](Result<void> done) {
      if (!done) log::Warning(serial + ": its light cannot be set: " + done.error().message);
    });
  }
}

/// Sets a light as its challenge wants it, which waits for that.
void LightChecks::Switch(std::size_t sphere) {
  const Held& held = held_[sphere];
  set_(*held.device, Wanted(held),
       [this, sphere, device = held.device, switches = held.switches](Result<void> done) {
         Held& now = held_[sphere];
         if (now.device != device || now.switches != switches) return;
         if (done) {
           now.challenge.LightIsSet(now_ns_());
         } else {
           now.challenge.LightFailed();
         }
       });
}

void LightChecks::TakeFrame(std::int64_t exposed_ns, sphere::Finder& finder,
                            std::vector<std::optional<sphere::Estimate>>& found) {
  if (!challenges_) return;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    Held& held = held_[i];
    if (!held.device) {
      finder.LeaveOut(i, {});
      continue;
    }
    held.challenge.Take(found[i], exposed_ns);
    finder.LeaveOut(i, held.challenge.refused());
    if (const std::string message = held.challenge.TakeMessage(); !message.empty())
      log::Info(std::string(stream::Name(held.role)) + ": " + message);
    if (!held.challenge.accepts()) found[i].reset();
    if (std::exchange(held.switches, held.challenge.switches()) != held.switches) Switch(i);
  }
}

std::vector<LightVerdict> LightChecks::Verdicts() const {
  std::vector<LightVerdict> verdicts(held_.size());
  for (std::size_t i = 0; i < held_.size(); ++i) {
    if (!challenges_ || !held_[i].device) continue;
    const Challenge& challenge = held_[i].challenge;
    verdicts[i].accepts = challenge.accepts();
    verdicts[i].is_switching = challenge.is_dark() || challenge.step() == Challenge::Step::kBack;
    verdicts[i].refused = challenge.refused();
  }
  return verdicts;
}

int LightChecks::passed() const {
  int sum = passed_before_;
  for (const Held& held : held_) sum += held.challenge.passed();
  return sum;
}

int LightChecks::refusals() const {
  int sum = refused_before_;
  for (const Held& held : held_) sum += held.challenge.refusals();
  return sum;
}

}  // namespace footing::camera
