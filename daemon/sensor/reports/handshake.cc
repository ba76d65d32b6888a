#include "daemon/sensor/reports/handshake.h"

#include <utility>

#include "common/base/units.h"
#include "daemon/sensor/reports/wiimote_calibration.h"

namespace footing::handshake {
namespace {

using reports::Bytes;
using reports::MemoryRead;
using reports::OutputReport;
using reports::Space;

constexpr std::uint32_t kExtensionKeyRegister = 0xa400f0;
constexpr std::uint32_t kExtensionPlainRegister = 0xa400fb;
constexpr std::uint32_t kExtensionIdentityRegister = 0xa400fa;
constexpr std::uint32_t kMotionPlusKeyRegister = 0xa600f0;
constexpr std::uint32_t kMotionPlusIdentityRegister = 0xa600fa;
constexpr std::uint16_t kIdentityBytes = 6;

// The camera is switched on as WiiBrew's page "Wiimote/IR camera" says, with the sensitivity that
// the console calls level 3.
constexpr std::uint32_t kCameraControlRegister = 0xb00030;
constexpr std::uint32_t kCameraGainRegister = 0xb00000;
constexpr std::uint32_t kCameraLimitsRegister = 0xb0001a;
constexpr std::uint8_t kCameraGain[] = {0x02, 0x00, 0x00, 0x71, 0x01, 0x00, 0xaa, 0x00, 0x64};
constexpr std::uint8_t kCameraLimits[] = {0x63, 0x03};

/// A switch of one byte, with an acknowledgement asked for.
OutputReport Switch(std::uint8_t id, bool on) {
  return {id, static_cast<std::uint8_t>(on ? 0x06 : 0x02)};
}

OutputReport WriteRegister(std::uint32_t address, std::uint8_t value) {
  return reports::WriteMemory(Space::kRegisters, address, Bytes(&value, 1));
}

}  // namespace

std::optional<MemoryRead> ReadOf(Step step) {
  switch (step) {
    case Step::kAccelerationBlocks:
      return MemoryRead(Space::kEeprom, calibration::kAccelerationBlockAddress,
                        2 * calibration::kAccelerationBlockBytes);
    case Step::kExtensionIdentity:
    case Step::kMotionPlusVerify:
      return MemoryRead(Space::kRegisters, kExtensionIdentityRegister, kIdentityBytes);
    case Step::kNunchukBlock:
      return MemoryRead(Space::kRegisters, calibration::kNunchukBlockAddress,
                        2 * calibration::kNunchukBlockBytes);
    case Step::kMotionPlusIdentity:
      return MemoryRead(Space::kRegisters, kMotionPlusIdentityRegister, kIdentityBytes);
    case Step::kMotionPlusBlock:
      return MemoryRead(Space::kRegisters, calibration::kMotionPlusBlockAddress,
                        calibration::kMotionPlusBlockBytes);
    case Step::kStatus:
    case Step::kExtensionKey:
    case Step::kExtensionPlain:
    case Step::kMotionPlusKey:
    case Step::kMotionPlusActivate:
    case Step::kCameraPower:
    case Step::kCameraLogic:
    case Step::kCameraStart:
    case Step::kCameraGain:
    case Step::kCameraLimits:
    case Step::kCameraFormat:
    case Step::kCameraGo:
    case Step::kMode:
    case Step::kOwnBlock:
    case Step::kLive:
      break;
  }
  return std::nullopt;
}

OutputReport FixedOutput(Step step) {
  switch (step) {
    case Step::kStatus:
      return reports::RequestStatus();
    case Step::kExtensionKey:
      return WriteRegister(kExtensionKeyRegister, 0x55);
    case Step::kExtensionPlain:
      return WriteRegister(kExtensionPlainRegister, 0x00);
    case Step::kMotionPlusKey:
      return WriteRegister(kMotionPlusKeyRegister, 0x55);
    case Step::kCameraPower:
      return Switch(0x13, true);
    case Step::kCameraLogic:
      return Switch(0x1a, true);
    case Step::kCameraStart:
      return WriteRegister(kCameraControlRegister, 0x01);
    case Step::kCameraGain:
      return reports::WriteMemory(Space::kRegisters, kCameraGainRegister, kCameraGain);
    case Step::kCameraLimits:
      return reports::WriteMemory(Space::kRegisters, kCameraLimitsRegister, kCameraLimits);
    case Step::kCameraGo:
      return WriteRegister(kCameraControlRegister, 0x08);
    case Step::kAccelerationBlocks:
    case Step::kExtensionIdentity:
    case Step::kNunchukBlock:
    case Step::kOwnBlock:
    case Step::kMotionPlusIdentity:
    case Step::kMotionPlusBlock:
    case Step::kMotionPlusActivate:
    case Step::kMotionPlusVerify:
    case Step::kCameraFormat:
    case Step::kMode:
    case Step::kLive:
      break;
  }
  return {};
}

bool EndsWithAcknowledgement(Step step) {
  return step != Step::kStatus && step != Step::kOwnBlock && step != Step::kLive && !ReadOf(step);
}

std::uint8_t AcknowledgedReport(Step step) {
  if (step == Step::kMode) return 0x12;
  if (step == Step::kCameraPower) return 0x13;
  return step == Step::kCameraLogic ? 0x1a : 0x16;
}

namespace {

constexpr double kNoAckTimeoutS = 0.05;  // For a device that never acknowledged.

}  // namespace

void Question::Enter(Step step, std::optional<MemoryRead> read) {
  step_ = step;
  asked_ = false;
  tries_ = 0;
  read_ = std::move(read);
  read_again_ = false;
}

Question::Wait Question::Advance(std::int64_t now_ns) {
  if (!asked_) return Wait::kNotAsked;
  const bool by_ack = EndsWithAcknowledgement(step_);
  const double timeout_s = !by_ack         ? config_.reply_timeout_s
                           : acknowledges_ ? config_.ack_timeout_s
                                           : kNoAckTimeoutS;
  if (now_ns - asked_ns_ < SecondsToNanoseconds(timeout_s)) return Wait::kWaiting;
  if (tries_ < (by_ack && !acknowledges_ ? 1 : config_.tries)) return Wait::kAskAgain;
  if (by_ack && !acknowledged_) acknowledges_ = false;
  return Wait::kGiveUp;
}

bool Question::MayAsk(std::int64_t now_ns) {
  if (pause_s_ > 0) {
    not_before_ns_ = now_ns + SecondsToNanoseconds(pause_s_);
    pause_s_ = 0;
  }
  return now_ns >= not_before_ns_;
}

void Question::SetAsked(std::int64_t now_ns) {
  asked_ = true;
  asked_ns_ = now_ns;
  ++tries_;
}

std::optional<reports::OutputReport> Question::ReadRequest() {
  if (!read_) return std::nullopt;
  read_->Restart();
  return read_->Request();
}

Question::Reading Question::Take(const reports::MemoryData& memory) {
  if (!read_ || !asked_) return Reading::kNone;
  switch (read_->Take(memory)) {
    case MemoryRead::Progress::kForeign:
    case MemoryRead::Progress::kMore:
      return Reading::kNone;
    case MemoryRead::Progress::kDone:
      return Reading::kDone;
    case MemoryRead::Progress::kRefused:
      return Reading::kRefused;
  }
  return Reading::kNone;
}

bool Question::Take(const reports::Acknowledgement& acknowledgement) {
  acknowledged_ = acknowledges_ = true;
  if (!asked_ || !EndsWithAcknowledgement(step_) ||
      acknowledgement.report != AcknowledgedReport(step_)) {
    return false;
  }
  // 7 and 8: nothing there; the identity read next decides. Any other error means busy, and
  // the time-out asks again.
  return acknowledgement.error == 0 || acknowledgement.error >= 7;
}

bool Question::ReadAgain(stream::CalibrationOrigin origin) {
  if (origin != stream::CalibrationOrigin::kDefaults || read_again_ || !tries_left()) return false;
  read_again_ = true;
  asked_ = false;
  return true;
}

}  // namespace footing::handshake
