#pragma once

#include "daemon/simulation/pose_service/pose_frame.h"
#include "daemon/simulation/pose_service/subject_body.h"
#include "footing/v1/character.pb.h"

namespace footing::pose_service {

/// The inputs of the pose engine as they took effect, for recordings.
v1::AppliedInput ToAppliedInput(const PoseApplied& applied, const Subject& subject);
/// The other way round, for replays.
PoseApplied PoseAppliedFrom(const v1::AppliedInput& message);
Subject SubjectFrom(const v1::AppliedInput& message);

}  // namespace footing::pose_service
