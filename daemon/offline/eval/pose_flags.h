#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/simulation/reconstruction/options.h"

namespace footing::eval {

/// The command line of footing-eval pose.
struct PoseFlags {
  PoseSceneOptions scene;
  reconstruction::Options options;
  std::vector<std::string> models, ablate, oracle, constants;
  std::string hands = "move", mode = "best", boards = "simulated", head = "none";
  double lag_ms = 0, loop_minutes = 0, yaw_error_deg = 0, height_m = 0;
  std::string figures;
  bool baselines = true, ablations = false, claims = false, same_person = false;
};

inline bool Has(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

void AddPoseFlags(CLI::App& command, PoseFlags& flags);
/// What the strings say, into the options.
Result<void> Translate(PoseFlags& flags);

}  // namespace footing::eval
