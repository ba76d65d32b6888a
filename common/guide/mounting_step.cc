#include "common/guide/mounting_step.h"

#include <algorithm>
#include <cmath>

namespace footing::guide {
namespace {

constexpr std::int64_t kMovingNs = 500'000'000;
constexpr double kNotKnownMps2 = 99;

std::string Tenths(double value) {
  const long tenths = std::lround(value * 10);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

bool WasMounted(const stream::DeviceStatus& device, const Situation& now) {
  for (const auto& rig : *now.setup) {
    for (const auto& item : rig.items) {
      const bool is_mounting = item.name == Name(Item::kMounting);
      if (rig.rig == device.rig && is_mounting && item.serial == device.serial) return true;
    }
  }
  return device.mounted;
}

bool IsFastened(const stream::DeviceStatus& device, const Situation& now,
                const SetUpOptions& options) {
  if (NeedsMounting(device.role)) return true;
  const auto& named = options.body_roles;
  return CanBeMounted(device.role) &&
         (options.mount_all || WasMounted(device, now) ||
          std::find(named.begin(), named.end(), device.role) != named.end());
}

/// Devices that are fastened to somebody; an editor's lies on the table.
std::vector<stream::DeviceStatus> Fastened(const Situation& now, const SetUpOptions& options) {
  std::vector<stream::DeviceStatus> fastened;
  for (const auto& device : now.recent->BodyDevices(options.rig)) {
    if (IsFastened(device, now, options)) fastened.push_back(device);
  }
  return fastened;
}

}  // namespace

Progress MountingStep::Solve(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  for (const auto& device : Fastened(now, options)) {
    Action solve;
    solve.kind = Action::Kind::kSolveMounting;
    solve.key = "mounting " + device.serial;
    solve.serial = device.serial;
    solve.still_from_ns = stretches_.still_from_ns();
    solve.still_to_ns = stretches_.still_to_ns();
    solve.steps_from_ns = stretches_.steps_from_ns();
    solve.steps_to_ns = stretches_.steps_to_ns();
    progress.actions.push_back(solve);
  }
  asked_ = true;
  waiting_ = progress.actions.size();
  return progress;
}

Progress MountingStep::Advance(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  const auto mounted = Fastened(now, options);
  progress.finished = mounted.empty();
  if (mounted.empty()) return progress;
  for (const Answer& answer : now.answers) {
    if (!asked_ || !answer.key.starts_with("mounting ")) continue;
    const bool passed = answer.ok && answer.residual <= kMountingBarDeg;
    std::string note = answer.message;
    if (answer.ok && !passed) note = "does not fit: fasten it tighter and take the steps again";
    results_.push_back(
        Outcome(Item::kMounting, answer.key.substr(9), passed, answer.residual, "deg", note));
    if (--waiting_ > 0) continue;
    progress.results = results_;
    progress.finished = true;
    return progress;
  }
  if (asked_) return progress;
  double moving_mps2 = 0;
  for (const auto& device : mounted) {
    const Motion motion =
        now.recent->DeviceMotion(device.device, now.now_ns - kMovingNs, now.now_ns);
    moving_mps2 = std::max(moving_mps2, motion.samples == 0 ? kNotKnownMps2 : motion.shake_mps2);
  }
  stretches_.Advance(now.now_ns, moving_mps2);
  progress.feedback = "moves by " + Tenths(moving_mps2) + " m/s2";
  switch (stretches_.phase()) {
    case StillThenSteps::Phase::kStill:
      progress.gesture = stream::Gesture::kHoldStill;
      progress.prompt = "Put the devices on as shown, then stand still for two seconds.";
      progress.feedback += ", still for " + Tenths(stretches_.still_s(now.now_ns)) + " s";
      for (const auto& device : mounted) {
        if (progress.picture.find(Picture(device.role)) == std::string::npos) {
          progress.picture += Picture(device.role);
        }
        progress.picture += "  " + Wearing(device.role) + "\n";
      }
      break;
    case StillThenSteps::Phase::kSteps:
      progress.gesture = stream::Gesture::kTakeSteps;
      progress.prompt =
          "Now take three steps forward, starting with the left foot, and stand again.";
      break;
    case StillThenSteps::Phase::kDone:
      return Solve(now, options);
  }
  return progress;
}

}  // namespace footing::guide
