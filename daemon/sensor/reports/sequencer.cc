#include "daemon/sensor/reports/sequencer.h"

#include <algorithm>
#include <utility>

#include "common/base/units.h"

namespace footing::handshake {
namespace {

constexpr std::int64_t kSenselessNs = 1'000'000'000;  // Bytes without sense for longer: check.
constexpr std::int64_t kQuietNs = 10'000'000'000;     // Settled for longer: checked at once.

}  // namespace

void PortCheck::Request(std::int64_t now_ns) {
  if (requested_) return;
  if (now_ns - done_ns_ > kQuietNs) wait_s_ = 0;
  requested_ = true;
  due_ns_ = now_ns + static_cast<std::int64_t>(std::max(wait_s_, config_.settle_s) * 1e9);
  wait_s_ = std::clamp(2 * wait_s_, config_.min_s, config_.max_s);
}

bool PortCheck::BeginIfDue(std::int64_t now_ns) {
  if (!requested_ || now_ns < due_ns_) return false;
  requested_ = false;
  return true;
}

void ExtensionPort::StartOver() {
  ready_ = false;
  identity_tries_ = 0;
}

void ExtensionPort::Disturb(std::int64_t until_ns) {
  disturbed_until_ns_ = until_ns;
  ready_ = false;
}

void ExtensionPort::BecomeReady(std::int64_t now_ns) {
  if (ready_) return;
  ready_ = true;
  ++epoch_;
  sense_ns_ = now_ns;
}

void ExtensionPort::Publish(stream::Extension extension) {
  if (published_ != stream::Extension::kUnspecified && extension != published_) ++changes_;
  published_ = extension;
}

bool ExtensionPort::Senseless(std::int64_t now_ns) const {
  return now_ns - sense_ns_ > kSenselessNs;
}

void KeepAlive::OnData(std::int64_t now_ns) {
  data_ns_ = now_ns;
  wait_s_ = config_.reassert_min_s;
}

void KeepAlive::OnStatus(std::int64_t now_ns) {
  if (first_due_ || !after_status_.Spend(now_ns)) return;
  first_due_ = true;
  first_ns_ = now_ns + SecondsToNanoseconds(config_.after_status_s);
  second_due_ = true;
  second_ns_ = now_ns + SecondsToNanoseconds(config_.second_try_s);
}

KeepAlive::Action KeepAlive::SetMode() {
  ++reasserts_;
  return Action::kSetMode;
}

KeepAlive::Action KeepAlive::Advance(std::int64_t now_ns) {
  if (first_due_ && now_ns >= first_ns_) {
    first_due_ = false;
    return SetMode();
  }
  if (second_due_ && now_ns >= second_ns_) {
    second_due_ = false;
    // Data that came earlier may be the last before the driver's own mode took hold.
    if (SilenceS(now_ns) < config_.second_try_s / 2) return Action::kNone;
    next_ns_ = now_ns + SecondsToNanoseconds(std::max(wait_s_, config_.reassert_min_s));
    return SetMode();
  }
  const double silence_s = SilenceS(now_ns);
  if (silence_s < config_.silence_s || now_ns < next_ns_) return Action::kNone;
  if (silence_s >= config_.ask_after_s &&
      now_ns - asked_ns_ >= SecondsToNanoseconds(config_.ask_after_s)) {
    asked_ns_ = now_ns;
    return Action::kAskStatus;
  }
  wait_s_ = std::clamp(wait_s_, config_.reassert_min_s, config_.reassert_max_s);
  next_ns_ = now_ns + SecondsToNanoseconds(wait_s_);
  wait_s_ *= 2;
  return SetMode();
}

namespace {

// A MotionPlus that was on for longer was switched off by chance.
constexpr std::int64_t kUndoneSoonNs = 10'000'000'000;
constexpr int kUndoneMost = 5;       // Switched off by another program this often in a row: theirs.
constexpr int kChildBitPackets = 4;  // In a row: rubbish packets have the bit at random.

}  // namespace

void MotionPlus::OnFoundActive() {
  active_ = true;
  calibration = calibration::ParseMotionPlus({});
}

bool MotionPlus::TakeVerification(bool active, std::int64_t now_ns, int tries) {
  active_ = active;
  if (!active_) return ++activations_ < tries;
  activated_ns_ = now_ns;
  return false;
}

void MotionPlus::StartOver() {
  active_ = false;
  activations_ = 0;
  polling_ = false;
}

void MotionPlus::TakeInactive(bool found, std::int64_t now_ns) {
  if (!std::exchange(lost_, false) || !found) return;
  undone_ = now_ns - activated_ns_ < kUndoneSoonNs ? undone_ + 1 : 1;
}

bool MotionPlus::given_up() const { return undone_ >= kUndoneMost; }

bool MotionPlus::ChildChanged(bool connected, bool known) {
  child_bit_differs_ = connected == known ? 0 : child_bit_differs_ + 1;
  if (child_bit_differs_ < kChildBitPackets) return false;
  child_bit_differs_ = 0;
  return true;
}

bool MotionPlus::StartPoll(std::int64_t now_ns, std::int64_t interval_ns) {
  if (active_ || given_up() || now_ns < poll_ns_) return false;
  poll_ns_ = now_ns + interval_ns;
  polling_ = true;
  return true;
}

namespace {

using reports::Extension;
using reports::MemoryRead;
using reports::Space;

constexpr std::int64_t kJumpNs = 1'000'000'000;  // Time unseen for longer is a suspension.

}  // namespace

HandshakeSequencer::HandshakeSequencer(const HandshakeConfig& config, const Plan& plan,
                                       std::span<const Plan* const> plans)
    : config_(config),
      plan_(&plan),
      plans_(plans),
      mode_(plan.mode),
      question_(config.question),
      port_check_(config.port),
      keep_alive_(config.keep_alive) {
  camera_.wanted = config.camera;
}

std::uint8_t HandshakeSequencer::WantedMode() const {
  if (!plan_->remote) return plan_->mode;
  if (camera_.wanted) return extension_found() ? 0x37 : 0x33;
  return extension_found() ? 0x35 : 0x31;
}

/// Basic, 10 bytes, fits report 0x37; extended, 12 bytes, report 0x33.
std::uint8_t HandshakeSequencer::CameraFormat() const { return WantedMode() == 0x37 ? 1 : 3; }

void HandshakeSequencer::SetCamera(bool on) {
  if (plan_->remote) camera_.Want(on);
}

void HandshakeSequencer::EnterBlock() {
  const Block& block = plan_->blocks[blocks_.size()];
  question_.Enter(Step::kOwnBlock, MemoryRead(block.space, block.address, block.size));
}

void HandshakeSequencer::EnterMode() {
  const std::uint8_t before = mode_;
  mode_ = WantedMode();
  const bool flowing = live_ && keep_alive_.SilenceS(now_ns_) < config_.keep_alive.silence_s;
  if (flowing && mode_ == before) {
    BecomeLive();
  } else {
    Enter(Step::kMode);
  }
}

void HandshakeSequencer::Advance(std::int64_t now_ns, Outputs& outputs) {
  if (now_ns_ != 0 && now_ns - now_ns_ > kJumpNs) {
    keep_alive_.Shift(now_ns);
    port_.OnSense(now_ns);
  }
  now_ns_ = now_ns;
  if (live_) Watch(now_ns, outputs);
  if (step() == Step::kLive) return;
  switch (question_.Advance(now_ns)) {
    case Question::Wait::kWaiting:
      return;
    case Question::Wait::kGiveUp:
      Proceed();
      break;
    case Question::Wait::kNotAsked:
    case Question::Wait::kAskAgain:
      break;
  }
  if (question_.MayAsk(now_ns) && step() != Step::kLive) Ask(now_ns, outputs);
}

reports::OutputReport HandshakeSequencer::Output() const {
  constexpr std::uint32_t kMotionPlusModeRegister = 0xa600fe;
  constexpr std::uint32_t kCameraFormatRegister = 0xb00033;
  if (step() == Step::kMode) return reports::SetMode(mode_, true);
  if (step() == Step::kMotionPlusActivate) {
    // Alone, with a Nunchuk or with a Classic passed through.
    const std::uint8_t mode = port_.child() == Extension::kNunchuk   ? 0x05
                              : port_.child() == Extension::kClassic ? 0x07
                                                                     : 0x04;
    return reports::WriteMemory(Space::kRegisters, kMotionPlusModeRegister, {&mode, 1});
  }
  if (step() == Step::kCameraFormat) {
    const std::uint8_t format = CameraFormat();
    return reports::WriteMemory(Space::kRegisters, kCameraFormatRegister, {&format, 1});
  }
  return FixedOutput(step());
}

void HandshakeSequencer::Ask(std::int64_t now_ns, Outputs& outputs) {
  if (!writes_.Spend(now_ns)) return;
  question_.SetAsked(now_ns);
  if (auto request = question_.ReadRequest()) {
    outputs.push_back(std::move(*request));
    return;
  }
  if (step() == Step::kStatus) {
    status_.SetAsked(now_ns);
    // Mute, then off; nobody waits for these.
    outputs.push_back({0x19, 0x04});
    outputs.push_back({0x14, 0x00});
  }
  if (step() == Step::kExtensionKey || step() == Step::kMotionPlusActivate) {
    port_.Disturb(now_ns + SecondsToNanoseconds(config_.dead_window_s));
  }
  outputs.push_back(Output());
}

void HandshakeSequencer::Proceed() {
  switch (step()) {
    case Step::kStatus:
      if (has_acceleration_ || !plan_->remote) {
        EnterAfterAcceleration();
      } else {
        Enter(Step::kAccelerationBlocks);
      }
      return;
    case Step::kExtensionKey:
      Enter(Step::kExtensionPlain);
      return;
    case Step::kExtensionPlain:
      Enter(Step::kExtensionIdentity);
      return;
    case Step::kMotionPlusKey:
      Enter(Step::kMotionPlusIdentity);
      return;
    case Step::kMotionPlusActivate:
      Enter(Step::kMotionPlusVerify);
      question_.Pause(config_.dead_window_s);
      return;
    case Step::kCameraPower:
    case Step::kCameraLogic:
    case Step::kCameraStart:
    case Step::kCameraGain:
    case Step::kCameraLimits:
    case Step::kCameraFormat:
    case Step::kCameraGo:
      ProceedWithCamera();
      return;
    case Step::kMode:
      BecomeLive();
      return;
    case Step::kAccelerationBlocks:
    case Step::kExtensionIdentity:
    case Step::kNunchukBlock:
    case Step::kOwnBlock:
    case Step::kMotionPlusIdentity:
    case Step::kMotionPlusBlock:
    case Step::kMotionPlusVerify:
      port_.GiveUp(config_.question.tries);
      FinishRead({});
      return;
    case Step::kLive:
      return;
  }
}

void HandshakeSequencer::ProceedWithCamera() {
  constexpr Step kSteps[] = {Step::kCameraPower, Step::kCameraLogic,  Step::kCameraStart,
                             Step::kCameraGain,  Step::kCameraLimits, Step::kCameraFormat,
                             Step::kCameraGo};
  if (step() == Step::kCameraFormat) camera_.format = CameraFormat();
  for (std::size_t i = 0; i + 1 < std::size(kSteps); ++i) {
    if (step() != kSteps[i]) continue;
    Enter(kSteps[i + 1]);
    return;
  }
  EnterMode();
}

void HandshakeSequencer::Take(std::int64_t now_ns, const reports::InputReport& report,
                              Outputs& outputs) {
  if (const auto* status = std::get_if<reports::Status>(&report.body)) {
    answered_ = true;
    TakeStatus(now_ns, *status);
  } else if (const auto* memory = std::get_if<reports::MemoryData>(&report.body)) {
    answered_ = true;
    TakeMemory(*memory);
  } else if (const auto* acknowledgement = std::get_if<reports::Acknowledgement>(&report.body)) {
    answered_ = true;
    if (question_.Take(*acknowledgement)) Proceed();
  } else if (const auto* data = std::get_if<reports::Data>(&report.body)) {
    TakeData(now_ns, *data);
  }
  if (step() != Step::kLive && !question_.asked()) Advance(now_ns, outputs);
}

void HandshakeSequencer::TakeMemory(const reports::MemoryData& memory) {
  switch (question_.Take(memory)) {
    case Question::Reading::kNone:
      return;
    case Question::Reading::kDone:
      FinishRead(std::vector<std::uint8_t>(question_.bytes()));
      return;
    case Question::Reading::kRefused:
      if (step() == Step::kMotionPlusIdentity || !question_.tries_left()) {
        Proceed();
      } else {
        question_.Retry();
        question_.Pause(config_.port.settle_s);
      }
      return;
  }
}

void HandshakeSequencer::FinishRead(const std::vector<std::uint8_t>& bytes) {
  if (step() == Step::kExtensionIdentity) {
    TakeIdentity(bytes);
  } else if (step() == Step::kMotionPlusIdentity) {
    TakeMotionPlusIdentity(bytes);
  } else if (step() == Step::kMotionPlusVerify) {
    TakeVerification(bytes);
  } else if (step() == Step::kAccelerationBlocks) {
    acceleration_ = calibration::ParseAcceleration(bytes);
    if (question_.ReadAgain(acceleration_.origin)) return;
    has_acceleration_ = true;
    EnterAfterAcceleration();
  } else if (step() == Step::kNunchukBlock) {
    port_.nunchuk = calibration::ParseNunchuk(bytes);
    if (question_.ReadAgain(port_.nunchuk.origin)) return;
    EnterAfterChild();
  } else if (step() == Step::kMotionPlusBlock) {
    motion_plus_.calibration = calibration::ParseMotionPlus(bytes);
    if (question_.ReadAgain(motion_plus_.calibration.origin)) return;
    Enter(Step::kMotionPlusActivate);
  } else if (step() == Step::kOwnBlock) {
    blocks_.push_back(bytes);
    if (blocks_.size() < plan_->blocks.size()) {
      EnterBlock();
    } else {
      EnterMode();
    }
  }
}

void HandshakeSequencer::BecomeLive() {
  Enter(Step::kLive);
  const bool first = !live_;
  if (first) keep_alive_.OnData(now_ns_);
  live_ = true;
  if (!port_.ready()) motion_plus_.ForgetChildBits();
  port_.BecomeReady(now_ns_);
  if (first && answered_ && config_.motion_plus && plan_->remote) {
    Enter(Step::kMotionPlusKey);  // Data need not wait for it.
    return;
  }
  port_.Publish(extension());
  motion_plus_.PollAt(now_ns_ + SecondsToNanoseconds(config_.motion_plus_poll_s));
  port_check_.SetDone(now_ns_);
  // Not ready is not none: what the status shows is examined again.
  const bool shown = status_.newest && status_.newest->extension;
  const bool differs = status_.newest && shown != extension_found();
  if (plan_->remote && (check_after_ || differs)) port_check_.Request(now_ns_);
  check_after_ = false;
}

stream::CalibrationOrigin HandshakeSequencer::acceleration_origin() const {
  return live_ ? acceleration_.origin : stream::CalibrationOrigin::kUnspecified;
}

std::string HandshakeSequencer::Note(std::int64_t now_ns) const {
  if (!live_) {
    return step() == Step::kStatus && question_.tries() > 1 ? "does not answer; wake it up" : "";
  }
  if (keep_alive_.SilenceS(now_ns) > 1) {
    return "sends no data; press its power button, or change its batteries";
  }
  if (!plan_->remote) return "";
  if (!acceleration_.problem.empty()) return acceleration_.problem;
  if (motion_plus_.active() && !motion_plus_.calibration.problem.empty()) {
    return motion_plus_.calibration.problem;
  }
  if (port_.child() == Extension::kNunchuk && !port_.nunchuk.problem.empty()) {
    return port_.nunchuk.problem;
  }
  if (!motion_plus_.given_up()) return "";
  return "MotionPlus left off: another program or hid_wiimote keeps switching it off; put "
         "'options "
         "hid ignore_special_drivers=1' into /etc/modprobe.d/footing.conf, reboot and reconnect";
}

// The sequencer's part at the extension port: what is plugged in, and what comes and goes while
// data flow.
namespace {

using stream::CalibrationOrigin;

bool IsActiveMotionPlus(Extension extension) {
  return extension == Extension::kMotionPlus || extension == Extension::kMotionPlusNunchuk ||
         extension == Extension::kMotionPlusClassic;
}

}  // namespace

stream::Extension HandshakeSequencer::extension() const {
  if (!live_) return stream::Extension::kUnspecified;
  if (!plan_->remote) return stream::Extension::kNone;
  const Extension child = port_.child();
  if (motion_plus_.active()) {
    if (child == Extension::kNunchuk) return stream::Extension::kMotionPlusNunchuk;
    if (child == Extension::kClassic) return stream::Extension::kMotionPlusClassic;
    return stream::Extension::kMotionPlus;
  }
  if (!port_.has_child()) return stream::Extension::kNone;
  if (child == Extension::kNunchuk) return stream::Extension::kNunchuk;
  if (child == Extension::kClassic) return stream::Extension::kClassic;
  return stream::Extension::kUnknown;
}

CalibrationOrigin HandshakeSequencer::extension_origin() const {
  return live_ && port_.child() == Extension::kNunchuk ? port_.nunchuk.origin
                                                       : CalibrationOrigin::kUnspecified;
}

CalibrationOrigin HandshakeSequencer::gyroscope_origin() const {
  return live_ && motion_plus_.active() ? motion_plus_.calibration.origin
                                        : CalibrationOrigin::kUnspecified;
}

void HandshakeSequencer::EnterAfterAcceleration() {
  // Without a status nobody knows: look.
  const bool plugged = !status_.newest || status_.newest->extension || !plan_->remote;
  if (!answered_) {
    Enter(Step::kMode);
  } else if (plugged) {
    Enter(Step::kExtensionKey);
  } else {
    EnterAfterChild();
  }
}

void HandshakeSequencer::EnterAfterIdentity() {
  if (plan_->remote) {
    if (port_.child() == Extension::kNunchuk) {
      Enter(Step::kNunchukBlock);
    } else {
      EnterAfterChild();
    }
  } else if (blocks_.size() < plan_->blocks.size()) {
    EnterBlock();
  } else {
    EnterMode();
  }
}

void HandshakeSequencer::EnterAfterChild() {
  if (live_ && config_.motion_plus && plan_->remote && !motion_plus_.given_up()) {
    Enter(Step::kMotionPlusKey);
  } else {
    EnterCameraOrMode();
  }
}

void HandshakeSequencer::EnterCameraOrMode() {
  if (camera_.NeedsSetUp(CameraFormat())) {
    Enter(Step::kCameraPower);
  } else {
    EnterMode();
  }
}

void HandshakeSequencer::TakeIdentity(const std::vector<std::uint8_t>& bytes) {
  const Extension found = reports::IdentifyExtension(bytes);
  // Not ready, or a MotionPlus that the key should have switched off.
  const bool unsettled = found == Extension::kNotReady || IsActiveMotionPlus(found);
  if (unsettled && port_.AskAgain(config_.question.tries)) {
    Enter(Step::kExtensionKey);
    question_.Pause(config_.port.settle_s);
    return;
  }
  if (IsActiveMotionPlus(found)) {
    // It stays on; the port is checked again later.
    motion_plus_.OnFoundActive();
    port_.set_child(found == Extension::kMotionPlusNunchuk   ? Extension::kNunchuk
                    : found == Extension::kMotionPlusClassic ? Extension::kClassic
                                                             : Extension::kNotReady);
    EnterCameraOrMode();
    return;
  }
  for (const Plan* plan : plans_) {
    const bool ready = found != Extension::kNotReady;
    if (ready && !plan->remote && bytes[4] == plan->identity[0] && bytes[5] == plan->identity[1]) {
      plan_ = plan;
    }
  }
  if (plan_->remote) port_.set_child(found);
  EnterAfterIdentity();
}

void HandshakeSequencer::TakeMotionPlusIdentity(const std::vector<std::uint8_t>& bytes) {
  const bool found = reports::IdentifyExtension(bytes) == Extension::kMotionPlusInactive;
  const bool others = bytes.size() > 2 && bytes[2] == 0xa4;  // A reply to the kernel driver's read.
  if (!found && others && question_.tries_left()) {
    question_.Retry();
    return;
  }
  motion_plus_.TakeInactive(found, now_ns_);
  if (motion_plus_.EndPoll()) {
    Enter(Step::kLive);
    if (found) port_check_.Request(now_ns_);
  } else if (found && !motion_plus_.given_up()) {
    Enter(Step::kMotionPlusBlock);
  } else {
    EnterCameraOrMode();
  }
}

void HandshakeSequencer::TakeVerification(const std::vector<std::uint8_t>& bytes) {
  const bool active = IsActiveMotionPlus(reports::IdentifyExtension(bytes));
  if (motion_plus_.TakeVerification(active, now_ns_, config_.question.tries)) {
    Enter(Step::kMotionPlusActivate);
    return;
  }
  check_after_ = !active;
  EnterCameraOrMode();
}

void HandshakeSequencer::StartOver() {
  port_.StartOver();
  motion_plus_.StartOver();
  Enter(Step::kExtensionKey);
}

void HandshakeSequencer::Watch(std::int64_t now_ns, Outputs& outputs) {
  switch (keep_alive_.Advance(now_ns)) {
    case KeepAlive::Action::kSetMode:
      if (step() != Step::kMode && writes_.Spend(now_ns)) {
        outputs.push_back(reports::SetMode(mode_, true));
      }
      break;
    case KeepAlive::Action::kAskStatus:
      RequestStatus(now_ns);
      break;
    case KeepAlive::Action::kNone:
      break;
  }
  WatchStatus(now_ns, outputs);
  if (step() == Step::kLive && plan_->remote) WatchPort(now_ns, outputs);
}

void HandshakeSequencer::WatchStatus(std::int64_t now_ns, Outputs& outputs) {
  if (config_.status_interval_s > 0 &&
      now_ns - status_.asked_ns() >= SecondsToNanoseconds(config_.status_interval_s)) {
    RequestStatus(now_ns);
  }
  if (status_.due() && writes_.Spend(now_ns)) {
    status_.SetSent();
    outputs.push_back(reports::RequestStatus());
  }
}

void HandshakeSequencer::WatchPort(std::int64_t now_ns, Outputs& outputs) {
  if (port_check_.requested()) {
    if (port_check_.BeginIfDue(now_ns)) StartOver();
  } else if (camera_.changed) {
    camera_.changed = false;
    if (camera_.wanted) {
      Enter(Step::kCameraPower);
      return;
    }
    camera_.format = 0;
    outputs.push_back({0x13, 0x00});
    outputs.push_back({0x1a, 0x00});
    EnterMode();
  } else if (config_.motion_plus &&
             motion_plus_.StartPoll(now_ns, SecondsToNanoseconds(config_.motion_plus_poll_s))) {
    Enter(Step::kMotionPlusIdentity);
  }
}

void HandshakeSequencer::TakeStatus(std::int64_t now_ns, const reports::Status& status) {
  status_.newest = status;
  if (step() == Step::kStatus) {
    Proceed();
    return;
  }
  if (!live_) return;
  keep_alive_.OnStatus(now_ns);
  const bool wanted = status_.TakeWanted();
  if (!plan_->remote || port_.disturbed(now_ns)) return;
  if (!status.extension && extension_found()) port_.set_unready();
  // Otherwise compared when it is live again.
  if (step() != Step::kLive && !motion_plus_.polling()) return;
  if (status.extension == extension_found() && wanted) return;
  motion_plus_.Suspect();
  port_check_.Request(now_ns);
}

void HandshakeSequencer::TakeData(std::int64_t now_ns, const reports::Data& data) {
  if (step() == Step::kMode && question_.asked() && data.id == mode_) BecomeLive();
  if (!live_ || data.id != mode_) return;
  keep_alive_.OnData(now_ns);
  if (port_.ready() && step() == Step::kLive) WatchExtension(now_ns, data);
}

void HandshakeSequencer::WatchExtension(std::int64_t now_ns, const reports::Data& data) {
  const reports::Bytes bytes = data.extension();
  if (motion_plus_.active()) {
    const auto connected = reports::ChildConnected(bytes);
    if (connected) port_.OnSense(now_ns);
    // A child that comes or goes shows nowhere else.
    if (connected && motion_plus_.ChildChanged(*connected, port_.has_child())) {
      port_check_.Request(now_ns);
    }
  } else if (port_.child() != Extension::kNunchuk || reports::DecodeNunchuk(bytes)) {
    port_.OnSense(now_ns);
  }
  if (port_.Senseless(now_ns)) {
    port_.OnSense(now_ns);
    motion_plus_.Suspect();
    port_check_.Request(now_ns);
  }
}

}  // namespace footing::handshake
