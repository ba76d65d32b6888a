#pragma once

#include <string>
#include <vector>

#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/insole_walk.h"

namespace footing::pose_run {

struct InsoleFrame {
  reconstruction::InsoleInputs inputs;
  Eigen::VectorXd q;
  std::array<double, momentum::kFeet> load_n{};
};

/// What a recorded motion would have given two insoles and two hand trackers, beside the truth.
struct InsoleRun {
  body::Body body;
  double rate_hz = 60;
  std::vector<InsoleFrame> frames;  ///< Begins with kStandS in the T-pose.
};

/// As RunPose; of the settings' errors, the white noise of a cell counts.
Result<InsoleRun> RunInsoles(const motion::Motion& clip, const Settings& settings,
                             const std::string& origin);

}  // namespace footing::pose_run
