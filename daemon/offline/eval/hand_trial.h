#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/offline/pose_run/held_hands.h"

namespace footing::eval {

struct HandTrialOptions {
  std::vector<double> hidden_s = {0.1, 0.25, 0.5};
  double seen_s = 2;
  double sphere_m = 0;      ///< From the device's sensors along its x.
  double lamp_m = 0;        ///< Above a hidden hand; 0: none.
  double common_share = 0;  ///< Of the camera's variance.
  std::uint64_t seed = 1;
};

/// Both hands of a motion before a camera 2.2 m ahead of the person, with errors and delays as
/// docs/evaluation/camera.md has measured them: errors at each tick of reconstruction::HandTrack,
/// from the camera alone, and of inertial::Track.
nlohmann::ordered_json RunHandTrial(const pose_run::ArmRun& run, const HandTrialOptions& options);

}  // namespace footing::eval
