#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/stream/device.h"

namespace footing::eval {

/// What the features should say at an instant of a walk.
struct WalkTruth {
  double frequency_hz = 0;
  double phase_rad = 0;
  double amplitude_mps2[2] = {0, 0};
  double roll_rad[2] = {0, 0};
  double pitch_rad[2] = {0, 0};
};

/// Somebody with two sensors who stands, takes three steps, stands, and walks: the specific force
/// of each in its perfect mounting's frame M (see daemon/sensor/mounting), left then right.
struct MountingWalk {
  std::string what;
  stream::DeviceRole roles[2] = {};
  double still_from_s = 0;
  double still_to_s = 0;
  double steps_to_s = 0;  ///< The steps begin where standing still ends.
  double walk_from_s = 0;
  double end_s = 0;
  std::function<Eigen::Vector3d(int side, double t_s)> force_M_mps2;
  /// None where a change is too fresh for features to have settled, and before the walk.
  std::function<std::optional<WalkTruth>(double t_s)> truth;
};

/// Two wrists by common/virtual/wrists: swings of 0.9, 1.2 and 1.6 Hz, inclined by up to 15
/// degrees.
MountingWalk SyntheticWalk();

/// Two shins of a person on motion capture: `standing` and `walking` are TRC files with the same
/// markers (metres, y up; names as OpenCap's: L_knee, L_ankle, L_shank_antsup, r_...; L.ASIS,
/// L.PSIS, r.ASIS, r.PSIS). The recorded stride is repeated, since recordings are short; the three
/// steps are that stride too, each leg from its own mid-stance and back to it. Truth is what the
/// features say of the same walk without noise and counts.
Result<MountingWalk> RecordedWalk(const std::string& standing, const std::string& walking);

}  // namespace footing::eval
