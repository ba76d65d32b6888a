#pragma once

#include "daemon/simulation/gait_service/publish.h"
#include "footing/v1/character.pb.h"

namespace footing::gait_service {

/// The engine's inputs as a message, and back for replays: bit for bit, but for the interface, of
/// which a message has the options. One that names no interface is from before there were several:
/// wrist.
v1::AppliedInput ToAppliedInput(const Applied& applied);
/// The other way round, for replays.
Applied FromAppliedInput(const v1::AppliedInput& message);

}  // namespace footing::gait_service
