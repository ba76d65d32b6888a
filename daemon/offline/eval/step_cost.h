#pragma once

#include "common/base/result.h"
#include "daemon/offline/eval/ground_course.h"
#include "daemon/simulation/biped/command.h"

namespace footing::eval {

/// CPU time of the engine's step over that of bare mj_step, which replays the recorded generalised
/// forces from the same state and must end in the same state hash. The engine's output is read
/// every tenth step, as when published. Median over seven pairs taken A B B A. On a slope of the
/// kind the character climbs all the time, it meets the step up in the middle, and the pit lies
/// just ahead. The bare world looks at every pair of geoms.
Result<double> MeasureStepCostRatio(const biped::GaitCommand& command, const GroundKind& kind);

}  // namespace footing::eval
