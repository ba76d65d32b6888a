#pragma once

#include <string>

#include "common/body/body.h"
#include "common/stream/character.h"
#include "daemon/simulation/pose_service/pose_frame.h"
#include "daemon/simulation/pose_service/subject_body.h"
#include "footing/v1/character.pb.h"

namespace footing::pose_service {

/// From a frame of the pose engine to the message of the protocol. `mode` is "best" or "paper",
/// `tracker` the name of who tracks the hands.
v1::CharacterFrame ToCharacterFrame(const PoseFrame& frame, const Subject& subject,
                                    const std::string& mode, const std::string& world,
                                    const std::string& rig, const std::string& tracker = "");

/// One link a joint; its size is that of a ball about the joint that the limbs end in.
stream::Skeleton ToSkeleton(const body::Body& body);

}  // namespace footing::pose_service
