#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/camera/find.h"
#include "common/frames/camera_file.h"
#include "common/virtual/camera/scene.h"
#include "daemon/offline/eval/report.h"

namespace footing::eval {

/// Counts of a trial so far.
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

/// Conditions of lens, light and surroundings: nominal, dim, soft, saturated, moving,
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

/// Errors of many estimates: those along the line of sight are depth, those across it lateral.
class SphereErrors {
 public:
  void Add(const sphere::Estimate& found, const Eigen::Vector3d& truth_m);
  nlohmann::ordered_json Json() const;
  /// Found where they are.
  int right() const { return found_ - wrong_; }

 private:
  std::vector<double> depth_mm_;
  int found_ = 0, wrong_ = 0;
  double lateral_mm2_ = 0, nees_ = 0, depth_nees_ = 0, variance_mm2_ = 0, confidence_ = 0;
};

/// One row for every sphere that is there or is found, in a CSV file.
class EstimateRows {
 public:
  /// Adds to the file; an empty path writes nothing.
  Result<void> Open(const std::string& path, const std::string& condition);
  void Add(int frame, std::size_t sphere, const std::optional<sphere::Estimate>& found,
           const std::optional<virtual_camera::Seen>& seen);

 private:
  std::ofstream file_;
  std::string condition_;
};

/// footing-eval sphere: positions of the spheres in the frames of a folder.
void AddSphereCommand(CLI::App& app, Shared& shared);

/// footing-eval spheres: errors of the sphere finder on rendered frames, by distance and condition.
void AddSpheresCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
