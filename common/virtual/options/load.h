#pragma once

#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"

/// Motion files by their paths: the edge around the pure readers of common/virtual/motion.
namespace footing::motion_files {

/// Facts that a motion file does not state.
struct LoadOptions {
  std::string skeleton = {};  ///< ASF file of an AMC motion.
  double amc_rate_hz = 120;   ///< AMC files do not say.
  /// Length of a BVH file's unit, which the file does not say; without it the first of centimetres,
  /// metres, millimetres and inches that makes a person of 0.9 to 2.3 m.
  std::optional<double> bvh_unit_m = {};
  std::string marker_set = {};  ///< Marker set of TRC and C3D; empty: the one that is there.
  std::string still = {};       ///< TRC or C3D of the same person standing still; may be empty.
  body::Sex sex = body::Sex::kMean;
};

/// A motion in W, whatever it was recorded as.
struct LoadedMotion {
  motion::Motion motion;
  /// One line: from markers the set, the height and the residual; of a BVH file that is not in
  /// centimetres its unit. Else empty.
  std::string note;
  std::optional<double> height_m;
};

/// By its ending: .bvh, .amc, .trc or .c3d.
bool IsMotionFile(const std::string& path);

/// Reads .bvh, .amc (with its skeleton), .trc and .c3d. The error of an unknown ending lists them.
/// Angles are motion::Canonical.
Result<LoadedMotion> LoadMotion(const std::string& path, const LoadOptions& options = {});

/// Ground forces of a .mot, .sto or .c3d file, in W.
Result<motion::GroundForces> LoadForces(const std::string& path);

/// Markers of a .trc or .c3d file, in W.
Result<motion::MarkerTracks> LoadMarkers(const std::string& path);

}  // namespace footing::motion_files
