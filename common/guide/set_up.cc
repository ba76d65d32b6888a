#include "common/guide/set_up.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::guide {
namespace {

constexpr double kStillMps2 = 0.8;     // A standing person's hands and shins stay under half.
constexpr double kSteppingMps2 = 1.5;  // The slowest step shakes a shin or wrist more.
constexpr std::int64_t kWindowNs = 500'000'000;        // Window of the shake that Advance is given.
constexpr std::int64_t kStepsLeastNs = 1'000'000'000;  // Three steps take longer.
constexpr std::int64_t kStepsMostNs = 12'000'000'000;
constexpr std::int64_t kStandAgainNs = 700'000'000;

constexpr const char* kShin = R"(
        the leg from its outside
          |       |
          (       ) knee
          | .---. |
         =|=|[_]|=|=  <- strap    ^
          | | + | |               |  front (camera) up
          | |(A)| |
          | |ooo| |     buttons away from the leg
         =|=|   |=|=  <- strap
          | '---' |
          |       '----.
          '------------'  toes ->
)";

constexpr const char* kHead = R"(
             _^__^___^___
            |_________[_]|==>  front (camera)
           .-'----------'-.      where you look
          /                \     buttons up
         |==================|  <- head band
         |     c         o  |
         |                  >
          \            .____|
           |          |
)";

constexpr const char* kTrunk = R"(
            .--.         .--.
           /    '-------'    \
          |      .-----.      |   front (camera) up
          |======|[_]  |======|   <- strap
          |      | +   |      |
          |      |(A)  |      |   buttons away from the chest
          |      '-----'      |
)";

constexpr const char* kWrist = R"(
        front (camera) to the fingers  ==>
                                 ___
      ______________________.---'  /.______
              ||       ||          '-------)
         .----||-------||----.      -------)
         |::: ||o ooo  ||( + [|     -------)
         '----||-------||----'      ------)
      ________||_______||_______.________)
              ^ straps ^
        buttons up, on the back of the wrist; or held in the hand
)";

struct Mounted {
  const char* picture = "";
  const char* text = "";
};

/// How a device of that role is worn; nothing for one that needs no mounting.
Mounted MountedAs(stream::DeviceRole role) {
  switch (role) {
    case stream::DeviceRole::kLeftLeg:
      return {kShin, "left leg: outside of the shin, buttons outwards, front up"};
    case stream::DeviceRole::kRightLeg:
      return {kShin, "right leg: outside of the shin, buttons outwards, front up"};
    case stream::DeviceRole::kHead:
      return {kHead, "head: on top under the band, buttons up, front where you look"};
    case stream::DeviceRole::kTrunk:
      return {kTrunk, "trunk: on the breastbone under the strap, buttons outwards, front up"};
    case stream::DeviceRole::kLeftHand:
      return {kWrist, "left wrist: buttons up, front along the fingers"};
    case stream::DeviceRole::kRightHand:
      return {kWrist, "right wrist: buttons up, front along the fingers"};
    case stream::DeviceRole::kLeftBoard:
    case stream::DeviceRole::kRightBoard:
    case stream::DeviceRole::kLeftUpperArm:
    case stream::DeviceRole::kRightUpperArm:
    case stream::DeviceRole::kLeftForearm:
    case stream::DeviceRole::kRightForearm:
    case stream::DeviceRole::kPelvis:
    case stream::DeviceRole::kLeftThigh:
    case stream::DeviceRole::kRightThigh:
    case stream::DeviceRole::kEditor:
    case stream::DeviceRole::kUnspecified:
      return {};
  }
  return {};
}

}  // namespace

bool NeedsMounting(stream::DeviceRole role) {
  return CanBeMounted(role) && role != stream::DeviceRole::kLeftHand &&
         role != stream::DeviceRole::kRightHand;
}

bool CanBeMounted(stream::DeviceRole role) { return !Wearing(role).empty(); }

std::string Picture(stream::DeviceRole role) { return MountedAs(role).picture; }

std::string Wearing(stream::DeviceRole role) { return MountedAs(role).text; }

double StillThenSteps::still_s(std::int64_t now_ns) const {
  if (still_from_ns_ == 0) return 0;
  return std::clamp(NanosecondsToSeconds(now_ns - kWindowNs - still_from_ns_), 0.0, kStillForS);
}

void StillThenSteps::Advance(std::int64_t now_ns, double moving_mps2) {
  if (phase_ == Phase::kStill) {
    if (moving_mps2 > kStillMps2) {
      still_from_ns_ = 0;
      return;
    }
    // The whole window that the shake is taken over was still.
    if (still_from_ns_ == 0) still_from_ns_ = now_ns - kWindowNs;
    // The newest window may hold the beginning of a movement: it belongs to the steps.
    still_to_ns_ = now_ns - kWindowNs;
    if (NanosecondsToSeconds(still_to_ns_ - still_from_ns_) < kStillForS) return;
    moved_first_ns_ = 0;
    phase_ = Phase::kSteps;
    return;
  }
  if (phase_ == Phase::kDone) return;
  if (moving_mps2 > kSteppingMps2) {
    if (moved_first_ns_ == 0) moved_first_ns_ = now_ns;
    moved_last_ns_ = now_ns;
  } else if (moved_first_ns_ == 0) {
    // Still standing: the newest stillness is the one that counts, up to the first movement.
    if (moving_mps2 <= kStillMps2) {
      still_to_ns_ = now_ns - kWindowNs;
      still_from_ns_ =
          std::max(still_from_ns_, still_to_ns_ - SecondsToNanoseconds(2 * kStillForS));
    }
    return;
  }
  const bool stands_again = now_ns - moved_last_ns_ > kStandAgainNs;
  const bool took_steps = moved_last_ns_ - moved_first_ns_ > kStepsLeastNs;
  if (stands_again && !took_steps) {  // A twitch.
    *this = StillThenSteps();
    return;
  }
  if (stands_again || now_ns - moved_first_ns_ > kStepsMostNs) {
    steps_to_ns_ = now_ns;
    phase_ = Phase::kDone;
  }
}

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

SetUp::Step SetUp::StepOf(Item item) {
  switch (item) {
    case Item::kAdapter:
      return AdapterStep();
    case Item::kPairing:
      return PairingStep();
    case Item::kRoles:
      return RolesStep();
    case Item::kLayout:
      return LayoutStep();
    case Item::kTare:
      return TareStep();
    case Item::kMounting:
      return MountingStep();
    case Item::kWeigh:
      return WeighStep();
    case Item::kCamera:
      return CameraStep();
    case Item::kChecks:
      return ChecksStep();
  }
  return AdapterStep();
}

SetUp::SetUp(SetUpOptions options, std::vector<Item> items)
    : options_(std::move(options)), items_(std::move(items)) {
  options_.mount_all |= std::find(items_.begin(), items_.end(), Item::kMounting) != items_.end();
  if (items_.empty()) items_ = AllItems();
  step_ = StepOf(items_.front());
}

void SetUp::Begin() {
  if (index_ < items_.size()) step_ = StepOf(items_[index_]);
  progress_ns_ = 0;
  asked_.clear();
}

Progress SetUp::Advance(const Situation& now) {
  Progress progress;
  if (index_ >= items_.size()) {
    progress.finished = true;
    return progress;
  }
  progress = std::visit([&](auto& step) { return step.Advance(now, options_); }, step_);
  if (progress_ns_ == 0 || progress.prompt != asked_ || !progress.actions.empty()) {
    progress_ns_ = now.now_ns;
    asked_ = progress.prompt;
  }
  const bool given_up =
      !progress.finished && now.now_ns - progress_ns_ > SecondsToNanoseconds(options_.patience_s);
  if (given_up) {
    progress.results = {Outcome(items_[index_], "", false, 0, "",
                                "timed out: " + asked_ + " " + progress.feedback)};
  } else if (!progress.finished) {
    if (!refused_.empty() && !progress.prompt.empty()) {
      progress.prompt += " (Again, because " + refused_ + ")";
    }
    return progress;
  }
  const auto bad = std::find_if(progress.results.begin(), progress.results.end(),
                                [](const auto& result) { return !result.passed; });
  if (bad != progress.results.end() && !given_up && ++tried_ < options_.tries) {
    refused_ = bad->note;
    progress.results.clear();
    Begin();
  } else {
    results_.insert(results_.end(), progress.results.begin(), progress.results.end());
    refused_.clear();
    tried_ = 0;
    ++index_;
    Begin();
  }
  progress.finished = index_ >= items_.size();
  return progress;
}

namespace {

const stream::SetupItem* Find(const std::vector<stream::SetupItem>& items, Item item,
                              const std::string& serial) {
  for (const auto& one : items) {
    if (one.name == Name(item) && one.serial == serial) return &one;
  }
  return nullptr;
}

bool IsBalanceBoard(const stream::DeviceStatus& device) {
  return device.kind == stream::DeviceKind::kBalanceBoard;
}

/// Why the devices of now contradict an item that passed; empty when they do not.
std::string Contradiction(const stream::SetupItem& item,
                          const std::vector<stream::SetupItem>& items,
                          const std::vector<stream::DeviceStatus>& devices) {
  if (item.name == Name(Item::kLayout)) {
    for (const auto& device : devices) {
      if (!IsBalanceBoard(device)) continue;
      if (device.moved) return "a board was moved";
      const auto* roles = Find(items, Item::kRoles, device.serial);
      if (roles != nullptr && roles->wall_time_ns > item.wall_time_ns) {
        return "a board has a new role";
      }
    }
    return "";
  }
  if (item.serial.empty()) return "";
  const auto device = std::find_if(devices.begin(), devices.end(),
                                   [&](const auto& one) { return one.serial == item.serial; });
  if (device == devices.end()) return "this device is not on the rig any more";
  const auto* roles = Find(items, Item::kRoles, item.serial);
  if (item.name == Name(Item::kMounting)) {
    if (device->slipped) return "it slipped";
    if (!device->mounted) return "its mounting is not known any more";
    if (roles != nullptr && roles->wall_time_ns > item.wall_time_ns) return "its role is new";
  }
  if (item.name == Name(Item::kTare)) {
    if (device->moved) return "the board was moved";
    if (!device->tared) return "its tare is not known any more";
  }
  return "";
}

}  // namespace

std::vector<stream::SetupItem> Merged(const std::vector<stream::SetupItem>& recorded,
                                      const std::vector<stream::SetupItem>& results,
                                      const std::vector<stream::DeviceStatus>& rig_devices) {
  std::vector<stream::SetupItem> merged = recorded;
  for (const auto& result : results) {
    const auto same = std::find_if(merged.begin(), merged.end(), [&](const auto& one) {
      return one.name == result.name && one.serial == result.serial;
    });
    if (same == merged.end()) {
      merged.push_back(result);
    } else {
      *same = result;
    }
  }
  std::vector<stream::SetupItem> marked = merged;
  for (auto& item : marked) {
    if (!item.passed || item.stale) continue;
    const std::string why = Contradiction(item, merged, rig_devices);
    if (why.empty()) continue;
    item.stale = true;
    item.note = why + ": footing-ctl setup --only " + item.name;
  }
  std::stable_sort(marked.begin(), marked.end(), [](const auto& a, const auto& b) {
    return ItemNamed(a.name).value_or(Item::kChecks) < ItemNamed(b.name).value_or(Item::kChecks);
  });
  return marked;
}

bool Ready(const std::vector<stream::SetupItem>& items,
           const std::vector<stream::DeviceStatus>& rig_devices,
           std::vector<std::string>* missing) {
  std::vector<std::string> rest;
  const auto need = [&](Item item, const std::string& serial) {
    const auto* found = Find(items, item, serial);
    const std::string name = std::string(Name(item)) + (serial.empty() ? "" : " " + serial);
    if (found == nullptr) {
      rest.push_back(name + ": not done");
    } else if (!found->passed) {
      rest.push_back(name + ": " + found->note);
    } else if (found->stale) {
      rest.push_back(name + ": stale, " + found->note);
    }
  };
  bool boards = false;
  bool any = false;
  need(Item::kAdapter, "");
  for (const auto& device : rig_devices) {
    if (device.state == stream::DeviceState::kLost) continue;
    any = true;
    boards = boards || IsBalanceBoard(device);
    need(Item::kPairing, device.serial);
    need(Item::kRoles, device.serial);
    if (IsBalanceBoard(device)) need(Item::kTare, device.serial);
    const bool was_mounted =
        CanBeMounted(device.role) && Find(items, Item::kMounting, device.serial) != nullptr;
    if (was_mounted || NeedsMounting(device.role)) need(Item::kMounting, device.serial);
    need(Item::kChecks, device.serial);
  }
  if (boards) {
    need(Item::kLayout, "");
    need(Item::kWeigh, "");
  }
  if (!any) rest.push_back("no device is attached to this rig");
  const bool ready = rest.empty();
  if (missing != nullptr) *missing = std::move(rest);
  return ready;
}

}  // namespace footing::guide
