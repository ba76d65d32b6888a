#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/result/result.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/motion.h"
#include "footing/v1/character.pb.h"

namespace footing::log_client {

/// One person's movement, from when their T-pose was taken.
struct ExportedMotion {
  std::string path;
  std::string subject;  ///< Code; empty where nobody was named.
  std::uint64_t frames = 0;
  double rate_hz = 0;
};

/// Gathers frames of one reconstructed body into a motion.
///
/// Lengths are those of the first frame taken (links are rigid); every joint turns about three
/// axes. Frames before the T-pose are left out; where a frame is missing the one before stands.
class MotionGatherer {
 public:
  explicit MotionGatherer(const v1::Skeleton& skeleton) : skeleton_(skeleton) {}

  void Add(const v1::CharacterFrame& frame);
  /// Nothing where no frame was taken. InvalidData where frames and skeleton do not fit, or time
  /// does not go on.
  Result<motion::Motion> Finish() const;
  bool empty() const { return frames_.empty(); }
  const std::string& subject() const { return subject_; }

 private:
  v1::Skeleton skeleton_;
  std::vector<v1::CharacterFrame> frames_;
  std::string subject_;
};

/// The joints of every frame, in the axes of TRC files (OpenSim: x ahead, y up, z right), from 0 s.
motion::MarkerTracks JointPlaces(const motion::Motion& motion);

enum class BodyFormat {
  kBvh,  ///< Skeleton and rotations.
  kTrc,  ///< Places of the joints.
};

/// Writes a file for each subject of a recording of the pose engine into `folder`:
/// "pose_1_p07.bvh", ... A recording without one is InvalidData; an existing file is a usage error,
/// unless `replace`.
Result<std::vector<ExportedMotion>> ExportBodies(const std::string& recording,
                                                 const std::string& folder, BodyFormat format,
                                                 bool replace);

}  // namespace footing::log_client
