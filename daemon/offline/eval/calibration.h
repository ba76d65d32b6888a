#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/eval/report.h"

namespace footing::eval {

/// Calibrations of rendered cameras, each at a place of its own in front of the boards.
struct CalibrationTrial {
  std::string method = "marks";  ///< One of CalibrationMethods.
  int boards = 2;
  double placement_sd_m = 0.001;  ///< Placing the sphere on a mark or in a pose, per axis.
  double distance_m = 2;          ///< From the camera to the origin, along the floor.
  int frames = 30;                ///< Per mark.
  int trials = 20;
  std::uint64_t seed = 1;
};

/// marks; gravity: a mark of each board also with the controller upright above it; poses: the
/// paper's three, of a person 1.75 m tall who differs from the mean by the spread of people.
const std::vector<std::string>& CalibrationMethods();

/// Renders the sphere on every mark, finds it, calibrates, and compares: the turn, and a hand 1.2 m
/// above the origin.
Result<nlohmann::ordered_json> RunCalibrationTrial(const CalibrationTrial& trial,
                                                   const std::function<void(int done)>& on_done);

/// footing-eval calibration: errors of the camera's pose by marks, gravity and three poses.
void AddCalibrationCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
