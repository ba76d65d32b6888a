#include "common/guide/device_steps.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::guide {
namespace {

constexpr double kMostLead = 99;

std::string Rounded(double value) { return std::to_string(std::lround(value)); }

/// The strongest of several signals, and the next one.
struct Strongest {
  std::uint32_t device = 0;
  double most = 0;
  double next = 0;

  void Add(std::uint32_t of_device, double signal) {
    if (signal > most) {
      next = most;
      most = signal;
      device = of_device;
    } else {
      next = std::max(next, signal);
    }
  }
  Pick One(double least_next, const std::string& note) const {
    return {Pick::Kind::kOne, device, std::min(kMostLead, most / std::max(next, least_next)), note};
  }
  Pick Ambiguous(const std::string& note) const {
    return {Pick::Kind::kAmbiguous, 0, most / next, note};
  }
};

}  // namespace

Pick WhichBoard(const std::vector<BoardLoad>& boards) {
  Strongest force_n;
  for (const BoardLoad& board : boards) {
    if (board.load.samples > 0) force_n.Add(board.device, board.load.mean_n);
  }
  if (force_n.most < kStoodOnN) return {Pick::Kind::kNone, 0, 0, "nobody stands on a board"};
  if (force_n.next > kFreeN) {
    return force_n.Ambiguous("two boards carry load (" + Rounded(force_n.most) + " N and " +
                             Rounded(force_n.next) + " N): stand on one alone");
  }
  return force_n.One(1.0, "carries " + Rounded(force_n.most) + " N");
}

Pick WhichShaken(const std::vector<DeviceMotion>& devices) {
  Strongest shake_mps2;
  for (const DeviceMotion& device : devices) {
    if (device.motion.samples > 0) shake_mps2.Add(device.device, device.motion.shake_mps2);
  }
  if (shake_mps2.most < kShakenMps2) return {Pick::Kind::kNone, 0, 0, "no device is shaken"};
  if (shake_mps2.most < kClearlyMore * shake_mps2.next) {
    return shake_mps2.Ambiguous("two devices move (" + Rounded(shake_mps2.most) + " and " +
                                Rounded(shake_mps2.next) + " m/s2): hold the others still");
  }
  return shake_mps2.One(0.1, "moves by " + Rounded(shake_mps2.most) + " m/s2");
}

namespace {

constexpr double kLeastBoardRateHz = 30;
constexpr double kLeastControllerRateHz = 60;
constexpr double kCheckForS = 2;
constexpr std::int64_t kGestureNs = 1'000'000'000;  // Looked at for a gesture.
constexpr std::int64_t kRestNs = 500'000'000;       // Between two gestures.

std::vector<stream::DeviceStatus> AllDevices(const Situation& now, const SetUpOptions& options) {
  std::vector<stream::DeviceStatus> all = now.recent->Boards(options.rig);
  for (const auto& device : now.recent->BodyDevices(options.rig)) all.push_back(device);
  return all;
}

bool IsBoardRole(stream::DeviceRole role) {
  return role == stream::DeviceRole::kLeftBoard || role == stream::DeviceRole::kRightBoard;
}

}  // namespace

std::string RoleText(stream::DeviceRole role) {
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
    case stream::DeviceRole::kTrunk:
      return "the chest";
    case stream::DeviceRole::kLeftUpperArm:
      return "the left upper arm";
    case stream::DeviceRole::kRightUpperArm:
      return "the right upper arm";
    case stream::DeviceRole::kLeftForearm:
      return "the left forearm";
    case stream::DeviceRole::kRightForearm:
      return "the right forearm";
    case stream::DeviceRole::kPelvis:
      return "the belt";
    case stream::DeviceRole::kLeftThigh:
      return "the left thigh";
    case stream::DeviceRole::kRightThigh:
      return "the right thigh";
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

std::string FaultOf(const stream::DeviceStatus& device) {
  const bool board = device.kind == stream::DeviceKind::kBalanceBoard;
  if (device.state != stream::DeviceState::kLive) {
    return std::string("is ") + stream::Name(device.state) + ": press its button, or replug it";
  }
  if (device.battery_low) return "battery low: change the batteries now";
  if (device.calibration == stream::CalibrationOrigin::kDefaults) {
    return "uncalibrated: the calibration stored in it is invalid; use another device";
  }
  const double least_hz = board ? kLeastBoardRateHz : kLeastControllerRateHz;
  if (device.report_rate_hz < least_hz) {
    return "only " + std::to_string(std::lround(device.report_rate_hz)) +
           " reports per second: move closer, or use fewer devices on this adapter";
  }
  if (device.slipped) return "its mounting slipped: footing-ctl setup --only mounting";
  if (device.moved) return "the board was moved: footing-ctl setup --only layout --only tare";
  return "";
}

Progress AdapterStep::Advance(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  const auto devices = AllDevices(now, options);
  const bool simulated = std::any_of(devices.begin(), devices.end(),
                                     [](const auto& device) { return device.simulated; });
  if (!now.adapters.empty() || !devices.empty()) {
    std::string note = simulated ? "simulated devices need no adapter" : "devices are attached";
    if (!now.adapters.empty()) note = "Bluetooth adapter " + now.adapters.front();
    progress.results = {Outcome(Item::kAdapter, "", true, 0, "", note)};
    progress.finished = true;
    return progress;
  }
  progress.gesture = stream::Gesture::kSwitchOn;
  progress.prompt = "Plug in a Bluetooth adapter, or switch it on (rfkill unblock bluetooth).";
  progress.feedback = "no adapter in /sys/class/bluetooth";
  return progress;
}

Progress PairingStep::Advance(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  progress.gesture = stream::Gesture::kSwitchOn;
  progress.prompt =
      "Switch on every device of this rig (pair new ones in another terminal: footing-ctl pair). "
      "Press Enter when all are on.";
  const auto devices = AllDevices(now, options);
  std::size_t live = 0;
  for (const auto& device : devices) live += device.state == stream::DeviceState::kLive;
  if (live != seen_ || since_ns_ == 0) {
    seen_ = live;
    since_ns_ = now.now_ns;
  }
  progress.feedback =
      std::to_string(live) + " of " + std::to_string(devices.size()) + " attached devices live";
  const bool settled = now.now_ns - since_ns_ >= SecondsToNanoseconds(options.settle_s);
  if (live == 0 || live < devices.size() || (!settled && !now.enter)) return progress;
  for (const auto& device : devices) {
    progress.results.push_back(
        Outcome(Item::kPairing, device.serial, true, device.report_rate_hz, "Hz",
                std::string(stream::Name(device.kind)) + (device.simulated ? ", simulated" : "")));
  }
  progress.finished = true;
  return progress;
}

void RolesStep::BeginWith(const std::vector<stream::DeviceStatus>& devices,
                          const std::vector<stream::DeviceRole>& roles) {
  if (roles.size() > devices.size()) {
    results_.push_back(Outcome(Item::kRoles, "", false, 0, "",
                               std::to_string(roles.size()) + " roles are requested, but only " +
                                   std::to_string(devices.size()) +
                                   " devices are attached: add more with footing-ctl pair"));
    return;
  }
  wanted_.insert(wanted_.end(), roles.begin(), roles.end());
  if (devices.size() == 1 && roles.size() == 1) alone_.insert(roles.front());
}

void RolesStep::Begin(const Situation& now, const SetUpOptions& options) {
  const auto own = [](const std::vector<stream::DeviceStatus>& devices) {
    std::vector<stream::DeviceRole> roles;
    for (const auto& device : devices) {
      if (device.role != stream::DeviceRole::kUnspecified) roles.push_back(device.role);
    }
    return roles;
  };
  const auto boards = now.recent->Boards(options.rig);
  const auto body_devices = now.recent->BodyDevices(options.rig);
  BeginWith(boards, own(boards));
  BeginWith(body_devices, options.body_roles.empty() ? own(body_devices) : options.body_roles);
  phase_ = wanted_.empty() ? Phase::kEnd : Phase::kRest;
}

bool RolesStep::Resting(const Situation& now, const SetUpOptions& options) const {
  const std::int64_t from_ns = now.now_ns - kRestNs;
  for (const auto& device : now.recent->Boards(options.rig)) {
    const Load load = now.recent->BoardLoad(device.device, from_ns, now.now_ns);
    if (load.samples == 0 || load.mean_n > kFreeN) return false;
  }
  for (const auto& device : now.recent->BodyDevices(options.rig)) {
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
                             pick.lead > 0 ? "ratio" : "", RoleText(role) + pick.note));
  phase_ = Phase::kAssigning;
  return progress;
}

Progress RolesStep::Ask(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  const stream::DeviceRole role = wanted_.front();
  const auto devices =
      IsBoardRole(role) ? now.recent->Boards(options.rig) : now.recent->BodyDevices(options.rig);
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
    progress.feedback = "this device has a role already: take another";
  }
  return progress;
}

Progress RolesStep::Advance(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  if (phase_ == Phase::kBegin) Begin(now, options);
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
    const bool boards = !now.recent->Boards(options.rig).empty();
    const bool one = alone_.count(wanted_.front()) > 0;  // The only one of its kind.
    progress.prompt =
        boards ? "Step off the boards and hold everything still." : "Hold everything still.";
    if (one) progress.prompt.clear();
    if (!one) progress.gesture = boards ? stream::Gesture::kStepOff : stream::Gesture::kHoldStill;
    if (one || Resting(now, options)) {
      phase_ = Phase::kAsk;
      rest_since_ns_ = now.now_ns - kRestNs;
    }
  }
  if (phase_ == Phase::kAsk) {
    const stream::DeviceRole role = wanted_.front();
    progress = Ask(now, options);
    if (alone_.count(role) == 0) {
      progress.prompt = (IsBoardRole(role) ? "Step on " : "Shake ") + RoleText(role) + " now.";
      progress.gesture = IsBoardRole(role) ? stream::Gesture::kStepOn : stream::Gesture::kShake;
      progress.role = role;
    }
  }
  if (phase_ == Phase::kEnd) {
    AddTheRest(now, options);
    progress.results = results_;
    progress.finished = true;
  }
  return progress;
}

/// Devices that no prompt asked about keep their roles.
void RolesStep::AddTheRest(const Situation& now, const SetUpOptions& options) {
  for (const auto& device : AllDevices(now, options)) {
    const bool reported = std::any_of(results_.begin(), results_.end(), [&](const auto& result) {
      return result.serial == device.serial;
    });
    if (reported) continue;
    const bool has_one = device.role != stream::DeviceRole::kUnspecified;
    results_.push_back(
        Outcome(Item::kRoles, device.serial, has_one, 0, "",
                has_one ? RoleText(device.role) + ", not asked for"
                        : "has no role: footing-ctl assign " + device.serial + " left_leg"));
  }
}

Progress ChecksStep::Advance(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  progress.prompt = "Checking the devices; nothing to do.";
  if (since_ns_ == 0) since_ns_ = now.now_ns;
  if (now.now_ns - since_ns_ < SecondsToNanoseconds(kCheckForS)) return progress;
  for (const auto& device : AllDevices(now, options)) {
    const std::string wrong = FaultOf(device);
    progress.results.push_back(Outcome(Item::kChecks, device.serial, wrong.empty(),
                                       device.report_rate_hz, "Hz",
                                       wrong.empty() ? RoleText(device.role) : wrong));
  }
  progress.finished = !progress.results.empty();
  return progress;
}

}  // namespace footing::guide
