#include "daemon/sensor/handshake/handshake.h"

#include <algorithm>

namespace footing::handshake {
namespace {

using reports::MemoryRead;
using reports::Space;
using stream::DeviceKind;

constexpr std::uint32_t kExtensionKeyRegister = 0xa400f0;
constexpr std::uint32_t kExtensionPlainRegister = 0xa400fb;
constexpr std::uint32_t kIdentityAddress = 0xa400fa;
constexpr std::uint16_t kIdentityBytes = 6;

std::int64_t Nanoseconds(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

/// What a step reads from memory, if it does.
std::optional<MemoryRead> ReadOf(Step step) {
  switch (step) {
    case Step::kExtensionIdentity:
      return MemoryRead(Space::kRegisters, kIdentityAddress, kIdentityBytes);
    case Step::kAccelerationBlocks:
      return MemoryRead(Space::kEeprom, calibration::kAccelerationBlockAddress,
                        2 * calibration::kAccelerationBlockBytes);
    case Step::kBoardBlock:
      return MemoryRead(Space::kRegisters, calibration::kBoardBlockAddress,
                        calibration::kBoardBlockBytes);
    case Step::kBoardTemperature:
      return MemoryRead(Space::kRegisters, calibration::kBoardTemperatureAddress,
                        calibration::kBoardTemperatureBytes);
    case Step::kStatus:
    case Step::kExtensionKey:
    case Step::kExtensionPlain:
    case Step::kMode:
    case Step::kLive:
      break;
  }
  return std::nullopt;
}

/// Steps that end with an acknowledgement, and go on without one.
bool EndsWithAcknowledgement(Step step) {
  return step == Step::kExtensionKey || step == Step::kExtensionPlain || step == Step::kMode;
}

}  // namespace

Handshake::Handshake(const HandshakeConfig& config, const std::string& product_name)
    : config_(config),
      named_board_(product_name.find("RVL-WBC") != std::string::npos),
      kind_(named_board_ ? DeviceKind::kBalanceBoard : DeviceKind::kWiimote) {}

std::uint8_t Handshake::mode() const {
  if (kind_ == DeviceKind::kBalanceBoard) return 0x34;
  return extension_ ? 0x35 : 0x31;
}

stream::CalibrationOrigin Handshake::calibration_origin() const {
  if (!live()) return stream::CalibrationOrigin::kUnspecified;
  return kind_ == DeviceKind::kBalanceBoard ? board_.origin : acceleration_.origin;
}

std::string Handshake::Note(std::int64_t now_ns) const {
  if (!live()) return step_ == Step::kStatus && tries_ > 1 ? "does not answer; wake it up" : "";
  if (now_ns - data_ns_ > Nanoseconds(1)) {
    return "sends no data; press its power button, or change its batteries";
  }
  return kind_ == DeviceKind::kBalanceBoard ? board_.problem : acceleration_.problem;
}

void Handshake::Enter(Step step) {
  step_ = step;
  asked_ = false;
  tries_ = 0;
  read_ = ReadOf(step);
}

Step Handshake::AfterExtension() const {
  if (kind_ == DeviceKind::kBalanceBoard) return Step::kBoardBlock;
  return has_acceleration_ ? Step::kMode : Step::kAccelerationBlocks;
}

void Handshake::Advance(std::int64_t now_ns, Outputs& outputs) {
  if (live()) {
    KeepAlive(now_ns, outputs);
    return;
  }
  if (settle_) {
    not_before_ns_ = now_ns + Nanoseconds(config_.settle_s);
    settle_ = false;
  }
  if (now_ns < not_before_ns_) return;
  if (asked_) {
    const bool acknowledged = EndsWithAcknowledgement(step_);
    const double timeout_s = acknowledged ? config_.ack_timeout_s : config_.reply_timeout_s;
    if (now_ns - asked_ns_ < Nanoseconds(timeout_s)) return;
    if (tries_ >= config_.tries) GiveUp();
  }
  if (!live()) Ask(now_ns, outputs);
  if (live()) data_ns_ = now_ns;
}

void Handshake::Ask(std::int64_t now_ns, Outputs& outputs) {
  constexpr std::uint8_t kKey[] = {0x55};
  constexpr std::uint8_t kPlain[] = {0x00};
  asked_ = true;
  asked_ns_ = now_ns;
  ++tries_;
  if (read_) {
    read_->Restart();
    outputs.push_back(read_->Request());
  } else if (step_ == Step::kStatus) {
    outputs.push_back(reports::RequestStatus());
  } else if (step_ == Step::kExtensionKey) {
    outputs.push_back(reports::WriteMemory(Space::kRegisters, kExtensionKeyRegister, kKey));
  } else if (step_ == Step::kExtensionPlain) {
    outputs.push_back(reports::WriteMemory(Space::kRegisters, kExtensionPlainRegister, kPlain));
  } else if (step_ == Step::kMode) {
    outputs.push_back(reports::SetMode(mode(), true));
  }
}

/// No answer to the last question: on to the next step without it.
void Handshake::GiveUp() {
  switch (step_) {
    case Step::kStatus:
      Enter(named_board_ ? Step::kExtensionKey : Step::kAccelerationBlocks);
      return;
    case Step::kExtensionKey:
      Enter(Step::kExtensionPlain);
      return;
    case Step::kExtensionPlain:
      Enter(Step::kExtensionIdentity);
      return;
    case Step::kExtensionIdentity:
      Enter(AfterExtension());
      return;
    case Step::kAccelerationBlocks:
    case Step::kBoardBlock:
    case Step::kBoardTemperature:
      FinishRead({});
      return;
    case Step::kMode:
      Enter(Step::kLive);
      return;
    case Step::kLive:
      return;
  }
}

void Handshake::Take(std::int64_t now_ns, const reports::InputReport& report, Outputs& outputs) {
  const bool was_live = live();
  if (const auto* status = std::get_if<reports::Status>(&report.body)) {
    TakeStatus(now_ns, *status);
  } else if (const auto* memory = std::get_if<reports::MemoryData>(&report.body)) {
    TakeMemory(*memory);
  } else if (const auto* acknowledgement = std::get_if<reports::Acknowledgement>(&report.body)) {
    TakeAcknowledgement(*acknowledgement);
  } else if (const auto* data = std::get_if<reports::Data>(&report.body)) {
    TakeData(now_ns, *data);
  }
  if (live() && !was_live) data_ns_ = now_ns;
  if (!live() && !asked_) Advance(now_ns, outputs);
}

void Handshake::TakeStatus(std::int64_t now_ns, const reports::Status& status) {
  const bool changed = status_ && status.extension != status_->extension;
  status_ = status;
  if (step_ == Step::kStatus) {
    Enter(status.extension || named_board_ ? Step::kExtensionKey : Step::kAccelerationBlocks);
    if (!status.extension) extension_ = false;
    return;
  }
  if (!live()) return;
  if (changed && status.extension) {
    identity_tries_ = 0;
    Enter(Step::kExtensionKey);
    settle_ = true;
  } else if (changed && kind_ == DeviceKind::kWiimote) {
    extension_ = false;
    Enter(Step::kMode);
  } else {
    // The device is silent after it, or the kernel's driver sets its own mode now.
    reassert_ns_ = now_ns + Nanoseconds(config_.after_status_s);
    data_ns_ = std::min(data_ns_, now_ns - Nanoseconds(config_.silence_s));
  }
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
      if (tries_ >= config_.tries) {
        GiveUp();
      } else {
        asked_ = false;
        settle_ = true;
      }
      return;
  }
}

void Handshake::FinishRead(const std::vector<std::uint8_t>& bytes) {
  if (step_ == Step::kExtensionIdentity) {
    IdentifyExtension(bytes);
  } else if (step_ == Step::kAccelerationBlocks) {
    acceleration_ = calibration::ParseAcceleration(bytes);
    has_acceleration_ = true;
    Enter(Step::kMode);
  } else if (step_ == Step::kBoardBlock) {
    board_block_ = bytes;
    Enter(Step::kBoardTemperature);
  } else if (step_ == Step::kBoardTemperature) {
    board_ = calibration::ParseBoard(board_block_, bytes);
    Enter(Step::kMode);
  }
}

void Handshake::IdentifyExtension(const std::vector<std::uint8_t>& bytes) {
  const reports::Extension extension = reports::IdentifyExtension(bytes);
  if (extension == reports::Extension::kNotReady && ++identity_tries_ < config_.tries) {
    Enter(Step::kExtensionKey);
    settle_ = true;
    return;
  }
  if (extension == reports::Extension::kBalanceBoard) kind_ = DeviceKind::kBalanceBoard;
  extension_ = kind_ == DeviceKind::kWiimote;
  Enter(AfterExtension());
}

void Handshake::TakeAcknowledgement(const reports::Acknowledgement& acknowledgement) {
  // An error means busy or refused: the time-out asks again.
  if (!asked_ || acknowledgement.error != 0) return;
  if (acknowledgement.report == 0x16 && step_ == Step::kExtensionKey) {
    Enter(Step::kExtensionPlain);
  } else if (acknowledgement.report == 0x16 && step_ == Step::kExtensionPlain) {
    Enter(Step::kExtensionIdentity);
  } else if (acknowledgement.report == 0x12 && step_ == Step::kMode) {
    Enter(Step::kLive);
  }
}

void Handshake::TakeData(std::int64_t now_ns, const reports::Data& data) {
  if (step_ == Step::kMode && asked_ && data.id == mode()) Enter(Step::kLive);
  if (!live() || data.id != mode()) return;
  data_ns_ = now_ns;
  reassert_s_ = config_.reassert_min_s;
}

void Handshake::KeepAlive(std::int64_t now_ns, Outputs& outputs) {
  if (now_ns - data_ns_ < Nanoseconds(config_.silence_s) || now_ns < reassert_ns_) return;
  outputs.push_back(reports::SetMode(mode(), true));
  reassert_s_ = std::clamp(reassert_s_, config_.reassert_min_s, config_.reassert_max_s);
  reassert_ns_ = now_ns + Nanoseconds(reassert_s_);
  reassert_s_ *= 2;
}

}  // namespace footing::handshake
