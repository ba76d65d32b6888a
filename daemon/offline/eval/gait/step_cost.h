#pragma once

#include "common/result/result.h"
#include "daemon/simulation/biped/command.h"

namespace footing::eval {

/// CPU time of the engine's step over that of bare mj_step, which replays the recorded generalised
/// forces from the same state and must end in the same state hash. The engine's output is read
/// every tenth step, as when published. Median over seven pairs taken A B B A.
Result<double> MeasureStepCostRatio(const biped::GaitCommand& command);

}  // namespace footing::eval
