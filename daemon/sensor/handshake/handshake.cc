#include "daemon/sensor/handshake/handshake.h"

#include <algorithm>

#include "common/units/units.h"
namespace footing::handshake {
namespace {

using reports::Extension;
using reports::MemoryRead;
using reports::Space;
using stream::CalibrationOrigin;
using stream::DeviceKind;

constexpr double kJumpS = 1;             // Time that passes unseen for longer is a suspension.
constexpr double kNoAckTimeoutS = 0.05;  // Of a device that never acknowledged.
constexpr std::int64_t kStatusSpacingNs = 1'000'000'000;

}  // namespace

Handshake::Handshake(const HandshakeConfig& config, const std::string& product_name)
    : config_(config),
      named_board_(product_name.find("RVL-WBC") != std::string::npos),
      kind_(named_board_ ? DeviceKind::kBalanceBoard : DeviceKind::kWiimote),
      mode_(named_board_ ? 0x34 : 0x31),
      keep_alive_(config.keep_alive) {}

std::uint8_t Handshake::mode() const { return mode_; }

std::uint8_t Handshake::WantedMode() const {
  if (is_board()) return 0x34;
  const bool extension = has_child() || motion_plus_active_;
  if (config_.camera) return extension ? 0x37 : 0x33;
  return extension ? 0x35 : 0x31;
}

/// Basic, 10 bytes, fits report 0x37; extended, 12 bytes, report 0x33.
std::uint8_t Handshake::CameraFormat() const { return WantedMode() == 0x37 ? 1 : 3; }

bool Handshake::RequestStatus(std::int64_t now_ns) {
  if (status_asked_ns_ != 0 && now_ns - status_asked_ns_ < kStatusSpacingNs) return false;
  status_due_ = true;
  status_asked_ns_ = now_ns;
  return true;
}

void Handshake::SetCamera(bool on) {
  if (on == config_.camera || is_board()) return;
  config_.camera = on;
  camera_due_ = true;
}

void Handshake::Enter(Step step) {
  step_ = step;
  asked_ = false;
  tries_ = 0;
  read_ = ReadOf(step);
  read_again_ = false;
}

void Handshake::Advance(std::int64_t now_ns, Outputs& outputs) {
  if (now_ns_ != 0 && now_ns - now_ns_ > SecondsToNanoseconds(kJumpS)) {
    keep_alive_.Shift(now_ns);
    extension_data_ns_ = now_ns;
  }
  now_ns_ = now_ns;
  if (live_) Watch(now_ns, outputs);
  if (step_ == Step::kLive) return;
  if (asked_) {
    const bool by_ack = EndsWithAcknowledgement(step_);
    const double timeout_s = !by_ack         ? config_.reply_timeout_s
                             : acknowledges_ ? config_.ack_timeout_s
                                             : kNoAckTimeoutS;
    if (now_ns - asked_ns_ < SecondsToNanoseconds(timeout_s)) return;
    if (tries_ >= (by_ack && !acknowledges_ ? 1 : config_.tries)) {
      if (by_ack && !acknowledged_) acknowledges_ = false;
      Proceed();
    }
  }
  if (pause_s_ > 0) {
    not_before_ns_ = now_ns + SecondsToNanoseconds(pause_s_);
    pause_s_ = 0;
  }
  if (step_ != Step::kLive && now_ns >= not_before_ns_) Ask(now_ns, outputs);
}

reports::OutputReport Handshake::Output() const {
  constexpr std::uint32_t kMotionPlusModeRegister = 0xa600fe;
  constexpr std::uint32_t kCameraFormatRegister = 0xb00033;
  if (step_ == Step::kMode) return reports::SetMode(mode_, true);
  if (step_ == Step::kMotionPlusActivate) {
    // Alone, with a Nunchuk or with a Classic passed through.
    const std::uint8_t mode = child_ == Extension::kNunchuk   ? 0x05
                              : child_ == Extension::kClassic ? 0x07
                                                              : 0x04;
    return reports::WriteMemory(Space::kRegisters, kMotionPlusModeRegister, {&mode, 1});
  }
  if (step_ == Step::kCameraFormat) {
    const std::uint8_t format = CameraFormat();
    return reports::WriteMemory(Space::kRegisters, kCameraFormatRegister, {&format, 1});
  }
  return FixedOutput(step_);
}

void Handshake::Ask(std::int64_t now_ns, Outputs& outputs) {
  if (!writes_.Take(now_ns)) return;
  asked_ = true;
  asked_ns_ = now_ns;
  ++tries_;
  if (read_) {
    read_->Restart();
    outputs.push_back(read_->Request());
    return;
  }
  if (step_ == Step::kStatus) {
    status_asked_ns_ = now_ns;
    // Mute, then off; nobody waits for these.
    outputs.push_back({0x19, 0x04});
    outputs.push_back({0x14, 0x00});
  }
  if (step_ == Step::kExtensionKey || step_ == Step::kMotionPlusActivate) {
    dead_until_ns_ = now_ns + SecondsToNanoseconds(config_.dead_window_s);
    extension_ready_ = false;
  }
  outputs.push_back(Output());
}

void Handshake::Proceed() {
  switch (step_) {
    case Step::kStatus:
      Enter(has_acceleration_ || named_board_ ? AfterAcceleration() : Step::kAccelerationBlocks);
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
      pause_s_ = config_.dead_window_s;
      return;
    case Step::kCameraPower:
      Enter(Step::kCameraLogic);
      return;
    case Step::kCameraLogic:
      Enter(Step::kCameraStart);
      return;
    case Step::kCameraStart:
      Enter(Step::kCameraGain);
      return;
    case Step::kCameraGain:
      Enter(Step::kCameraLimits);
      return;
    case Step::kCameraLimits:
      Enter(Step::kCameraFormat);
      return;
    case Step::kCameraFormat:
      camera_format_ = CameraFormat();
      Enter(Step::kCameraGo);
      return;
    case Step::kCameraGo:
      EnterMode();
      return;
    case Step::kMode:
      BecomeLive();
      return;
    case Step::kAccelerationBlocks:
    case Step::kExtensionIdentity:
    case Step::kNunchukBlock:
    case Step::kBoardBlock:
    case Step::kBoardTemperature:
    case Step::kMotionPlusIdentity:
    case Step::kMotionPlusBlock:
    case Step::kMotionPlusVerify:
      identity_tries_ = config_.tries;
      FinishRead({});
      return;
    case Step::kLive:
      return;
  }
}

void Handshake::Take(std::int64_t now_ns, const reports::InputReport& report, Outputs& outputs) {
  if (const auto* status = std::get_if<reports::Status>(&report.body)) {
    answered_ = true;
    TakeStatus(now_ns, *status);
  } else if (const auto* memory = std::get_if<reports::MemoryData>(&report.body)) {
    answered_ = true;
    TakeMemory(*memory);
  } else if (const auto* acknowledgement = std::get_if<reports::Acknowledgement>(&report.body)) {
    answered_ = true;
    TakeAcknowledgement(*acknowledgement);
  } else if (const auto* data = std::get_if<reports::Data>(&report.body)) {
    TakeData(now_ns, *data);
  }
  if (step_ != Step::kLive && !asked_) Advance(now_ns, outputs);
}

void Handshake::TakeMemory(const reports::MemoryData& memory) {
  if (!read_ || !asked_) return;
  switch (read_->Take(memory)) {
    case MemoryRead::Progress::kForeign:
    case MemoryRead::Progress::kMore:
      return;
    case MemoryRead::Progress::kDone:
      FinishRead(std::vector<std::uint8_t>(read_->bytes()));
      return;
    case MemoryRead::Progress::kRefused:
      if (step_ == Step::kMotionPlusIdentity || tries_ >= config_.tries) {
        Proceed();
      } else {
        asked_ = false;
        pause_s_ = config_.settle_s;
      }
      return;
  }
}

void Handshake::TakeAcknowledgement(const reports::Acknowledgement& acknowledgement) {
  acknowledged_ = acknowledges_ = true;
  if (!asked_ || !EndsWithAcknowledgement(step_) ||
      acknowledgement.report != AcknowledgedReport(step_)) {
    return;
  }
  // 7 and 8: nothing there; the identity that is read next tells. Any other error means busy, and
  // the time-out asks again.
  if (acknowledgement.error == 0 || acknowledgement.error >= 7) Proceed();
}

bool Handshake::ReadAgain(CalibrationOrigin origin) {
  if (origin != CalibrationOrigin::kDefaults || read_again_ || tries_ >= config_.tries) {
    return false;
  }
  read_again_ = true;
  asked_ = false;
  return true;
}

void Handshake::FinishRead(const std::vector<std::uint8_t>& bytes) {
  if (step_ == Step::kExtensionIdentity) {
    TakeIdentity(bytes);
  } else if (step_ == Step::kMotionPlusIdentity) {
    TakeMotionPlusIdentity(bytes);
  } else if (step_ == Step::kMotionPlusVerify) {
    TakeVerification(bytes);
  } else if (step_ == Step::kAccelerationBlocks) {
    acceleration_ = calibration::ParseAcceleration(bytes);
    if (ReadAgain(acceleration_.origin)) return;
    has_acceleration_ = true;
    Enter(AfterAcceleration());
  } else if (step_ == Step::kNunchukBlock) {
    nunchuk_ = calibration::ParseNunchuk(bytes);
    if (ReadAgain(nunchuk_.origin)) return;
    Enter(AfterChild());
  } else if (step_ == Step::kMotionPlusBlock) {
    motion_plus_ = calibration::ParseMotionPlus(bytes);
    if (ReadAgain(motion_plus_.origin)) return;
    Enter(Step::kMotionPlusActivate);
  } else if (step_ == Step::kBoardBlock) {
    board_block_ = bytes;
    Enter(Step::kBoardTemperature);
  } else if (step_ == Step::kBoardTemperature) {
    board_ = calibration::ParseBoard(board_block_, bytes);
    has_board_ = board_.origin == CalibrationOrigin::kDevice;
    EnterMode();
  }
}

void Handshake::EnterMode() {
  const std::uint8_t before = mode_;
  mode_ = WantedMode();
  const bool flowing = live_ && keep_alive_.SilenceS(now_ns_) < config_.keep_alive.silence_s;
  if (flowing && mode_ == before) {
    BecomeLive();
  } else {
    Enter(Step::kMode);
  }
}

void Handshake::BecomeLive() {
  Enter(Step::kLive);
  const bool first = !live_;
  if (first) keep_alive_.TakeData(now_ns_);
  live_ = true;
  if (!extension_ready_) {
    extension_ready_ = true;
    ++extension_epoch_;
    child_bit_differs_ = 0;
    extension_data_ns_ = now_ns_;
  }
  if (first && answered_ && config_.motion_plus && !is_board()) {
    Enter(Step::kMotionPlusKey);  // Data need not wait for it.
    return;
  }
  if (published_ != stream::Extension::kUnspecified && extension() != published_) {
    ++extension_changes_;
  }
  published_ = extension();
  poll_ns_ = now_ns_ + SecondsToNanoseconds(config_.motion_plus_poll_s);
  redone_ns_ = now_ns_;
  // Not ready is not none: what the status shows is looked at again.
  const bool shown = status_ && status_->extension;
  const bool found = has_child() || motion_plus_active_;
  if (!is_board() && (redo_after_ || (status_ && shown != found))) WantRedo(now_ns_);
  redo_after_ = false;
}

stream::CalibrationOrigin Handshake::calibration_origin() const {
  if (!live_) return CalibrationOrigin::kUnspecified;
  return is_board() ? board_.origin : acceleration_.origin;
}

stream::CalibrationOrigin Handshake::extension_origin() const {
  return live_ && child_ == Extension::kNunchuk ? nunchuk_.origin : CalibrationOrigin::kUnspecified;
}

stream::CalibrationOrigin Handshake::gyroscope_origin() const {
  return live_ && motion_plus_active_ ? motion_plus_.origin : CalibrationOrigin::kUnspecified;
}

std::string Handshake::Note(std::int64_t now_ns) const {
  if (!live_) return step_ == Step::kStatus && tries_ > 1 ? "does not answer; wake it up" : "";
  if (keep_alive_.SilenceS(now_ns) > 1) {
    return "sends no data; press its power button, or change its batteries";
  }
  if (is_board()) return board_.problem;
  if (!acceleration_.problem.empty()) return acceleration_.problem;
  if (motion_plus_active_ && !motion_plus_.problem.empty()) return motion_plus_.problem;
  if (child_ == Extension::kNunchuk && !nunchuk_.problem.empty()) return nunchuk_.problem;
  if (motion_plus_given_up()) {
    return "MotionPlus left off: another program or hid_wiimote keeps switching it off; put "
           "'options "
           "hid ignore_special_drivers=1' into /etc/modprobe.d/footing.conf, reboot and reconnect";
  }
  return "";
}

}  // namespace footing::handshake
