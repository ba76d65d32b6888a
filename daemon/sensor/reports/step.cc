#include "daemon/sensor/reports/step.h"

#include "daemon/sensor/reports/acceleration.h"
#include "daemon/sensor/reports/calibration_motion_plus.h"
#include "daemon/sensor/reports/nunchuk.h"

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

}  // namespace footing::handshake
