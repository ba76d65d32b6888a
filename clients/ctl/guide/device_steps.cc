#include "clients/ctl/guide/device_steps.h"

#include <algorithm>
#include <cmath>

#include "clients/ctl/guide/pick.h"
#include "common/units/units.h"

namespace footing::guide {
namespace {

constexpr double kLeastBoardRateHz = 30;
constexpr double kLeastControllerRateHz = 60;
constexpr double kCheckForS = 2;
constexpr std::int64_t kGestureNs = 1'000'000'000;  // Looked at for a gesture.
constexpr std::int64_t kRestNs = 500'000'000;       // Between two gestures.

std::vector<stream::DeviceStatus> Everything(const Situation& now, const Wishes& wishes) {
  std::vector<stream::DeviceStatus> all = now.recent->Boards(wishes.rig);
  for (const auto& device : now.recent->Worn(wishes.rig)) all.push_back(device);
  return all;
}

bool IsBoardRole(stream::DeviceRole role) {
  return role == stream::DeviceRole::kLeftBoard || role == stream::DeviceRole::kRightBoard;
}

}  // namespace

std::string Spoken(stream::DeviceRole role) {
  switch (role) {
    case stream::DeviceRole::kLeftHand:
      return "the left wrist";
    case stream::DeviceRole::kRightHand:
      return "the right wrist";
    case stream::DeviceRole::kLeftLeg:
      return "the left shin";
    case stream::DeviceRole::kRightLeg:
      return "the right shin";
    case stream::DeviceRole::kHead:
      return "the head";
    case stream::DeviceRole::kLeftBoard:
      return "the left board";
    case stream::DeviceRole::kRightBoard:
      return "the right board";
    case stream::DeviceRole::kEditor:
      return "the editor remote";
    case stream::DeviceRole::kUnspecified:
      return "a device without a role";
  }
  return "";
}

std::string WrongWith(const stream::DeviceStatus& device) {
  const bool board = device.kind == stream::DeviceKind::kBalanceBoard;
  if (device.state != stream::DeviceState::kLive) {
    return std::string("is ") + stream::Name(device.state) + ": press its button, or replug it";
  }
  if (device.battery_low) return "battery low: change the batteries now";
  if (device.calibration == stream::CalibrationOrigin::kDefaults) {
    return "uncalibrated: its own calibration makes no sense; use another device";
  }
  const double least_hz = board ? kLeastBoardRateHz : kLeastControllerRateHz;
  if (device.report_rate_hz < least_hz) {
    return "only " + std::to_string(std::lround(device.report_rate_hz)) +
           " reports a second: go nearer, or take devices off this adapter";
  }
  if (device.slipped) return "its mounting slipped: footing-ctl setup --only mounting";
  if (device.moved) return "the board was moved: footing-ctl setup --only layout --only tare";
  return "";
}

Progress AdapterStep::Advance(const Situation& now, const Wishes& wishes) {
  Progress progress;
  const auto devices = Everything(now, wishes);
  const bool stand_ins = std::any_of(devices.begin(), devices.end(),
                                     [](const auto& device) { return device.simulated; });
  if (!now.adapters.empty() || !devices.empty()) {
    const auto count = static_cast<double>(now.adapters.size());
    std::string note = stand_ins ? "stand-ins need no adapter" : "devices are attached";
    if (!now.adapters.empty()) note = "Bluetooth adapter " + now.adapters.front();
    progress.results = {Outcome(Item::kAdapter, "", true, count, "adapters", note)};
    progress.finished = true;
    return progress;
  }
  progress.prompt = "Plug in a Bluetooth adapter, or switch it on (rfkill unblock bluetooth).";
  progress.feedback = "no adapter in /sys/class/bluetooth";
  return progress;
}

Progress PairingStep::Advance(const Situation& now, const Wishes& wishes) {
  Progress progress;
  progress.prompt =
      "Switch on every device of this rig (pair new ones in another terminal: footing-ctl pair). "
      "Enter when all are there.";
  const auto devices = Everything(now, wishes);
  std::size_t live = 0;
  for (const auto& device : devices) live += device.state == stream::DeviceState::kLive;
  if (live != seen_ || since_ns_ == 0) {
    seen_ = live;
    since_ns_ = now.now_ns;
  }
  progress.feedback =
      std::to_string(live) + " of " + std::to_string(devices.size()) + " attached devices live";
  const bool settled = now.now_ns - since_ns_ >= SecondsToNanoseconds(wishes.settle_s);
  if (live == 0 || live < devices.size() || (!settled && !now.enter)) return progress;
  for (const auto& device : devices) {
    progress.results.push_back(
        Outcome(Item::kPairing, device.serial, true, device.report_rate_hz, "Hz",
                std::string(stream::Name(device.kind)) + (device.simulated ? ", stand-in" : "")));
  }
  progress.finished = true;
  return progress;
}

void RolesStep::BeginWith(const std::vector<stream::DeviceStatus>& devices,
                          const std::vector<stream::DeviceRole>& roles) {
  if (roles.size() > devices.size()) {
    results_.push_back(Outcome(Item::kRoles, "", false, 0, "",
                               std::to_string(roles.size()) + " roles are asked for, but only " +
                                   std::to_string(devices.size()) +
                                   " devices are there: footing-ctl pair brings more"));
    return;
  }
  wanted_.insert(wanted_.end(), roles.begin(), roles.end());
  if (devices.size() == 1 && roles.size() == 1) alone_.insert(roles.front());
}

void RolesStep::Begin(const Situation& now, const Wishes& wishes) {
  const auto own = [](const std::vector<stream::DeviceStatus>& devices) {
    std::vector<stream::DeviceRole> roles;
    for (const auto& device : devices) {
      if (device.role != stream::DeviceRole::kUnspecified) roles.push_back(device.role);
    }
    return roles;
  };
  const auto boards = now.recent->Boards(wishes.rig);
  const auto worn = now.recent->Worn(wishes.rig);
  BeginWith(boards, own(boards));
  BeginWith(worn, wishes.worn.empty() ? own(worn) : wishes.worn);
  phase_ = wanted_.empty() ? Phase::kEnd : Phase::kRest;
}

bool RolesStep::Resting(const Situation& now, const Wishes& wishes) const {
  const std::int64_t from_ns = now.now_ns - kRestNs;
  for (const auto& device : now.recent->Boards(wishes.rig)) {
    const Load load = now.recent->BoardLoad(device.device, from_ns, now.now_ns);
    if (load.samples == 0 || load.mean_n > kFreeN) return false;
  }
  for (const auto& device : now.recent->Worn(wishes.rig)) {
    const Motion motion = now.recent->DeviceMotion(device.device, from_ns, now.now_ns);
    if (motion.samples == 0 || motion.shake_mps2 > kShakenMps2 / 2) return false;
  }
  return true;
}

Progress RolesStep::Assign(const stream::DeviceStatus& device, const Pick& pick) {
  const stream::DeviceRole role = wanted_.front();
  Progress progress;
  Action assign;
  assign.kind = Action::Kind::kAssign;
  assign.key = "assign";
  assign.serial = device.serial;
  assign.role = role;
  progress.actions = {assign};
  named_.insert(device.serial);
  results_.push_back(Outcome(Item::kRoles, device.serial, true, pick.lead,
                             pick.lead > 0 ? "ratio" : "", Spoken(role) + pick.note));
  phase_ = Phase::kAssigning;
  return progress;
}

Progress RolesStep::Ask(const Situation& now, const Wishes& wishes) {
  Progress progress;
  const stream::DeviceRole role = wanted_.front();
  const auto devices =
      IsBoardRole(role) ? now.recent->Boards(wishes.rig) : now.recent->Worn(wishes.rig);
  if (alone_.count(role) > 0 && devices.size() == 1) {
    Pick only;
    only.note = ", the only one of its kind";
    return Assign(devices.front(), only);
  }
  const std::int64_t from_ns = std::max(now.now_ns - kGestureNs, rest_since_ns_);
  if (now.now_ns - from_ns < kGestureNs) return progress;
  Pick pick;
  if (IsBoardRole(role)) {
    std::vector<BoardLoad> loads;
    for (const auto& device : devices) {
      loads.push_back({device.device, now.recent->BoardLoad(device.device, from_ns, now.now_ns)});
    }
    pick = WhichBoard(loads);
  } else {
    std::vector<DeviceMotion> motions;
    for (const auto& device : devices) {
      motions.push_back(
          {device.device, now.recent->DeviceMotion(device.device, from_ns, now.now_ns)});
    }
    pick = WhichShaken(motions);
  }
  progress.feedback = pick.note;
  if (pick.kind != Pick::Kind::kOne) return progress;
  for (const auto& device : devices) {
    if (device.device != pick.device) continue;
    if (named_.count(device.serial) == 0) {
      pick.note = " " + pick.note;
      return Assign(device, pick);
    }
    progress.feedback = "this one is named already: take another";
  }
  return progress;
}

Progress RolesStep::Advance(const Situation& now, const Wishes& wishes) {
  Progress progress;
  if (phase_ == Phase::kBegin) Begin(now, wishes);
  for (const Answer& answer : now.answers) {
    if (answer.key != "assign" || phase_ != Phase::kAssigning) continue;
    if (!answer.ok) {
      results_.back().passed = false;
      results_.back().note = answer.message;
    }
    wanted_.erase(wanted_.begin());
    phase_ = wanted_.empty() ? Phase::kEnd : Phase::kRest;
  }
  if (phase_ == Phase::kRest) {
    const bool boards = !now.recent->Boards(wishes.rig).empty();
    const bool one = alone_.count(wanted_.front()) > 0;  // Nothing to tell it from.
    progress.prompt =
        boards ? "Step off the boards and hold everything still." : "Hold everything still.";
    if (one) progress.prompt.clear();
    if (one || Resting(now, wishes)) {
      phase_ = Phase::kAsk;
      rest_since_ns_ = now.now_ns - kRestNs;
    }
  }
  if (phase_ == Phase::kAsk) {
    const stream::DeviceRole role = wanted_.front();
    progress = Ask(now, wishes);
    if (alone_.count(role) == 0) {
      progress.prompt = (IsBoardRole(role) ? "Step on " : "Shake ") + Spoken(role) + " now.";
    }
  }
  if (phase_ == Phase::kEnd) {
    AddTheRest(now, wishes);
    progress.results = results_;
    progress.finished = true;
  }
  return progress;
}

/// Devices that nobody was asked about keep what they are.
void RolesStep::AddTheRest(const Situation& now, const Wishes& wishes) {
  for (const auto& device : Everything(now, wishes)) {
    const bool told = std::any_of(results_.begin(), results_.end(), [&](const auto& result) {
      return result.serial == device.serial;
    });
    if (told) continue;
    const bool has_one = device.role != stream::DeviceRole::kUnspecified;
    results_.push_back(
        Outcome(Item::kRoles, device.serial, has_one, 0, "",
                has_one ? Spoken(device.role) + ", not asked for"
                        : "has no role: footing-ctl assign " + device.serial + " left_leg"));
  }
}

Progress ChecksStep::Advance(const Situation& now, const Wishes& wishes) {
  Progress progress;
  progress.prompt = "The devices are looked over; nothing to do.";
  if (since_ns_ == 0) since_ns_ = now.now_ns;
  if (now.now_ns - since_ns_ < SecondsToNanoseconds(kCheckForS)) return progress;
  for (const auto& device : Everything(now, wishes)) {
    const std::string wrong = WrongWith(device);
    progress.results.push_back(Outcome(Item::kChecks, device.serial, wrong.empty(),
                                       device.report_rate_hz, "Hz",
                                       wrong.empty() ? Spoken(device.role) : wrong));
  }
  progress.finished = !progress.results.empty();
  return progress;
}

}  // namespace footing::guide
