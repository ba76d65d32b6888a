#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "common/base/result.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/devices/scene.h"
#include "daemon/offline/pose_run/pose_run.h"

namespace footing::pose_run {

/// The clip with its landmarks only, behind a T-pose of kStandS. `origin` names it in errors.
Result<virtual_sensors::Scene> Stage(const motion::Motion& clip, const Settings& settings,
                                     const std::string& origin);

/// How many frames of settings.rate_hz the scene has, and the motion's column at each.
std::size_t FrameCount(const virtual_sensors::Scene& scene, double rate_hz);
Eigen::Index ColumnAt(const virtual_sensors::Scene& scene, double time_s);

}  // namespace footing::pose_run
