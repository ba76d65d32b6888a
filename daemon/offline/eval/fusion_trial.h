#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "common/base/result.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/options.h"

namespace footing::eval {

/// What of a fusion trial is shown.
struct FusionReport {
  nlohmann::ordered_json json;
  std::string figure;  ///< SVG: Figure 7 of the pose paper.
};

/// A person under boards and a simulated Kinect that loses a part of them, against the truth, four
/// ways: (a) the skeleton as it is, at its exposure, (b) the same skeleton solved for the most
/// likely pose, (c) boards and hands, and (d) boards, hands and joints, both by the engine that the
/// product runs (pose paper, section 7.3); the fields of `footing-eval fusion`. `run` has a
/// Kinect's joints.
Result<FusionReport> RunFusionTrial(const pose_run::PoseRun& run,
                                    const reconstruction::Models& models,
                                    const reconstruction::Options& options);

}  // namespace footing::eval
