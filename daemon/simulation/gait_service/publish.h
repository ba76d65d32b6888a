#pragma once

#include <string>

#include "daemon/simulation/gait_service/frame.h"
#include "footing/v1/character.pb.h"

namespace footing::gait_service {

/// From a frame of the simulation thread to the messages of the protocol.
v1::CharacterFrame ToCharacterFrame(const Frame& frame, const std::string& world,
                                    const std::string& rig);
v1::Event ToEvent(const engine::EngineEvent& event, std::int64_t host_ns);

}  // namespace footing::gait_service
