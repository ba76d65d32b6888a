#include "daemon/sensor/reports/sequencer.h"

#include <utility>

#include "common/base/units.h"

namespace footing::handshake {
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
    port_.TakeSense(now_ns);
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
  if (!writes_.Take(now_ns)) return;
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
  if (first) keep_alive_.TakeData(now_ns_);
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

}  // namespace footing::handshake
