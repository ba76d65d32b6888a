#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/motion.h"

namespace footing::log_client {

/// One person's movement, from when their T-pose was taken.
struct ExportedMotion {
  std::string path;
  std::string subject;  ///< Code; empty where nobody was named.
  std::uint64_t frames = 0;
  std::uint64_t invalid_frames = 0;  ///< Of `frames`: the engine reported them as not valid.
  double rate_hz = 0;
  double begin_s = 0;        ///< Its first frame, from the recording's first message on.
  std::string angle_errors;  ///< The file with the stated errors of this person's angles.
};

/// The joints of every frame, in the axes of TRC files (OpenSim: x ahead, y up, z right), from 0 s.
/// They are not seen in a frame that is not `valid`.
motion::MarkerTracks JointPlaces(const motion::Motion& motion, const std::vector<bool>& valid);

enum class BodyFormat {
  kBvh,  ///< Skeleton and rotations.
  kTrc,  ///< Places of the joints.
  kMot,  ///< Angles of the joints, and in a second file the forces under the feet.
  kC3d,  ///< Places of the joints and the forces under the feet.
};

/// Writes a file for each subject of a recording of the pose engine into `folder`:
/// "pose_1_p07.bvh", ...; of kMot "pose_1_p07.mot" and "pose_1_p07_grf.mot". A recording without
/// one is InvalidData; an existing file is a usage error, unless `replace`.
///
/// Beside them stand the stated standard deviations of the angles: "pose_1_p07_errors.csv" for each
/// coordinate, and with kMot "pose_1_p07_sd.sto" with the columns and times of the angles.
///
/// Where the pose is not valid, the places of joints have a gap; rotations and angles, whose files
/// cannot have one, keep the pose.
Result<std::vector<ExportedMotion>> ExportBodies(const std::string& recording,
                                                 const std::string& folder, BodyFormat format,
                                                 bool replace);

}  // namespace footing::log_client
