#pragma once

#include "daemon/simulation/gait_service/frame.h"
#include "footing/v1/character.pb.h"

namespace footing::gait_service {

/// The engine's inputs as a message, and back for replays: bit for bit.
v1::AppliedInput ToAppliedInput(const Applied& applied);
Applied FromAppliedInput(const v1::AppliedInput& message);

/// The interface in force, which each message names so that a recording can be run again. One that
/// names none is from before there were others: wrist.
void SetInterface(const mapping::InterfaceOptions& options, v1::AppliedInput& message);
mapping::InterfaceOptions InterfaceOf(const v1::AppliedInput& message);

}  // namespace footing::gait_service
