#pragma once

#include <cstdint>
#include <optional>

#include "daemon/sensor/reports/memory_read.h"
#include "daemon/sensor/reports/output_report.h"

namespace footing::handshake {

/// The questions of a handshake, in the order in which they are asked.
enum class Step {
  kStatus,
  kAccelerationBlocks,
  // Extension port.
  kExtensionKey,
  kExtensionPlain,
  kExtensionIdentity,
  kNunchukBlock,
  kOwnBlock,  ///< One of the plan's blocks.
  // MotionPlus: found and read while inactive, since it hides what it was plugged over.
  kMotionPlusKey,
  kMotionPlusIdentity,
  kMotionPlusBlock,
  kMotionPlusActivate,
  kMotionPlusVerify,
  // Infrared camera.
  kCameraPower,
  kCameraLogic,
  kCameraStart,
  kCameraGain,
  kCameraLimits,
  kCameraFormat,
  kCameraGo,
  kMode,
  kLive,
};

/// What the step reads from memory, if it does.
std::optional<reports::MemoryRead> ReadOf(Step step);

/// What a step sends that is always the same; empty for reads, the mode, the activation and the
/// camera's format.
reports::OutputReport FixedOutput(Step step);

/// Steps that end with an acknowledgement, and go on without one.
bool EndsWithAcknowledgement(Step step);

/// Id of the report that such a step's acknowledgement names.
std::uint8_t AcknowledgedReport(Step step);

}  // namespace footing::handshake
