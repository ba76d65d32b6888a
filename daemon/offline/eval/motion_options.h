#pragma once

#include <CLI/CLI.hpp>

#include "daemon/offline/eval/pose_scene.h"

namespace footing::eval {

/// Adds --motion, --skeleton and --still to a command that evaluates a motion.
void AddMotionOptions(CLI::App& command, PoseSceneOptions& scene);

}  // namespace footing::eval
