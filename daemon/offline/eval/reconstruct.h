#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "daemon/offline/eval/report.h"
#include "daemon/offline/pose_run/pose_run.h"

namespace footing::eval {

/// `reconstruct`: the markers and force plates of a laboratory to the pose of the body, in files.
void AddReconstructCommand(CLI::App& app, Shared& shared);

/// Turn about the vertical, then shift, that lays the poses of a run, which begins over the boards
/// and looks along x, over those of the motion that it is of: the mean over all frames of the clip.
struct Placement {
  double yaw_rad = 0;
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();

  Eigen::Vector3d Place(const Eigen::Vector3d& p_W) const;
  Eigen::VectorXd Pose(const body::Skeleton& skeleton, Eigen::VectorXd q) const;
};
Placement PlacementOf(const pose_run::PoseRun& run, const motion::Motion& motion);

/// A table of angles at these times, s, linear between its rows; angles in degrees, and a knee that
/// bends by negative angles (models gait2392 and gait2354) by positive ones. InvalidData where the
/// table has no column "time", or its times do not cover these.
Result<motion::Table> AnglesAt(const motion::Table& table, const std::vector<double>& times_s,
                               const std::string& file);

}  // namespace footing::eval
