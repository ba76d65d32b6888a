#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/offline/eval/replay.h"
#include "footing/v1/session.pb.h"

namespace footing::eval {

/// The ticks are of the pose engine.
bool IsPoseRecording(const std::vector<v1::Tick>& ticks);

/// Gives the applied inputs of footing-sim's ticks to a new pose engine at their steps, and
/// compares whole frames: everything but the CPU time, the overruns and the texts for people. Mode,
/// lag and subjects are those of the recording; the models come from `data_folder` (empty: the
/// installed ones). InvalidData when the recording does not begin with the engine's first step.
Result<EngineReplay> ReplayPose(const std::vector<v1::Tick>& ticks, const std::string& data_folder);

}  // namespace footing::eval
