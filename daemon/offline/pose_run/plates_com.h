#pragma once

#include <Eigen/Core>

#include "daemon/offline/pose_run/felt_forces.h"
#include "daemon/offline/pose_run/pose_run.h"

namespace footing::pose_run {

/// COM by the plates' own force (ComByForce), W, m, a column a frame of `run` from judged_from on.
/// `begin_s`: where in the run the clip begins, which `felt` is timed by. Empty for a trial of less
/// than five seconds, and for one that begins or ends with the COM faster than 0.3 m/s.
Eigen::Matrix3Xd ComByPlates(const PoseRun& run, const FeltForces& felt, double begin_s);

}  // namespace footing::pose_run
