#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/frames/camera_file.h"
#include "common/base/result.h"
#include "common/virtual/camera/scene.h"

namespace footing::eval {

/// What a trial counted so far.
struct SphereProgress {
  int frames = 0, spheres = 0;
  int missed = 0;  ///< Not found, or in a wrong place.
  int extra = 0;   ///< Found with a confidence above 0.5 where none is.
};

/// Rendered frames of two spheres, magenta and cyan, at one distance from the camera's plane.
struct SphereTrial {
  std::string condition = "nominal";  ///< One of SphereConditions.
  double distance_m = 2;              ///< Along the optical axis; 0: 0.5 to 4 m, evenly.
  int frames = 100;
  std::uint64_t seed = 1;
  std::string rows;  ///< CSV file with a row for every sphere; empty: none.
  std::string out;   ///< Folder to write frames, truth.csv and camera.json into; empty: none.
  std::function<void(const SphereProgress&)> on_progress;  ///< Every 500 frames; may be empty.
};

/// The rate that is exceeded with a confidence of 5 % only, after so many events in so many trials.
double RateBound(int events, int trials);

/// What the lens, the light or the surroundings do: nominal, dim, soft, saturated, moving,
/// quarter_hidden, half_hidden, clutter, yuyv, bent_lens, other_limb, absent; lamp: clutter with a
/// sphere at the lamp's edge; and tracked, whose frames follow one another, so that the finder
/// knows where to look.
const std::vector<std::string>& SphereConditions();

/// The camera as a program knows it: lens, noise, and blur and limb calibrated on 24 other frames
/// of the same camera at 0.6 to 1.2 m, without truth.
Result<frames::CameraFile> CalibratedCamera(const std::string& condition, std::uint64_t seed);

/// Errors of the finder: those along the line of sight are depth, those across it lateral.
Result<nlohmann::ordered_json> RunSphereTrial(const SphereTrial& trial,
                                              const frames::CameraFile& camera);

}  // namespace footing::eval
