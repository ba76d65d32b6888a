#pragma once

#include <vector>

#include "common/stream/contacts.h"
#include "common/stream/device.h"
#include "common/stream/hands.h"
#include "common/stream/sensor.h"
#include "common/stream/setup.h"

namespace footing::sensor {

/// Everything that one tick publishes.
struct TickContent {
  std::vector<stream::MotionSample> motion;
  std::vector<stream::BoardSample> boards;
  std::vector<stream::NunchukSample> nunchuks;
  std::vector<stream::GamepadSample> gamepads;
  std::vector<stream::CameraSample> cameras;
  std::vector<stream::HandSample> hands;
  std::vector<stream::ReferencePose> reference;
  std::vector<stream::ContactSample> contacts;
  std::vector<stream::RawReport> raw;
  std::vector<stream::RigFeatures> features;
  bool has_status = false;
  std::vector<stream::DeviceStatus> status;
  bool has_setup = false;
  std::vector<stream::RigSetup> setup;
};

/// Bounds a tick against a device that floods; a tick of eight devices has some ten of each.
inline constexpr std::size_t kMaxSamplesPerTick = 1024;
/// The same of poses, which are some 2 KiB each.
inline constexpr std::size_t kMaxReferencesPerTick = 64;
/// And of contact samples, which are some 0.7 KiB.
inline constexpr std::size_t kMaxContactsPerTick = 128;

}  // namespace footing::sensor
