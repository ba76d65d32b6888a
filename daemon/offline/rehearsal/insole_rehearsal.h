#pragma once

#include <string>
#include <vector>

#include "daemon/offline/rehearsal/rehearsal.h"
#include "daemon/simulation/reconstruction/insole_walk.h"

namespace footing::rehearsal {

struct InsoleFrame {
  reconstruction::InsoleInputs inputs;
  Eigen::VectorXd q;
  std::array<double, momentum::kFeet> load_n{};
};

/// What a recorded motion would have told two insoles and two hand trackers, beside the truth.
struct InsoleRehearsal {
  body::Body body;
  double rate_hz = 60;
  std::vector<InsoleFrame> frames;  ///< Begins with kStandS in the T-pose.
};

/// As Rehearse; of the settings' errors, the white noise of a cell counts.
Result<InsoleRehearsal> RehearseInsoles(const motion::Motion& clip, const Settings& settings,
                                        const std::string& origin);

}  // namespace footing::rehearsal
