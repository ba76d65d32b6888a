#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/body/skeleton.h"
#include "common/virtual/motion/body_files.h"
#include "common/virtual/motion/motion.h"
#include "footing/v1/character.pb.h"

namespace footing::log_client {

/// One person's movement, from when their T-pose was taken, or the biped's.
struct ExportedMotion {
  std::string path;
  std::string subject;  ///< Code; empty where nobody was named.
  std::uint64_t frames = 0;
  std::uint64_t invalid_frames = 0;  ///< Part of `frames` reported not valid by the engine.
  double rate_hz = 0;
  double begin_s = 0;  ///< Its first frame, from the recording's first message on.
  /// The file with the stated errors of this person's angles; empty for the biped's.
  std::string angle_errors;
};

/// File format of an exported body.
enum class BodyFormat {
  kBvh,   ///< Skeleton and rotations.
  kTrc,   ///< Places of the joints.
  kMot,   ///< Angles of the joints, and in a second file the forces under the feet.
  kC3d,   ///< Places of the joints and the forces under the feet.
  kGltf,  ///< An animated figure that rests in a T-pose (motion::Humanoid).
};

/// How the skeleton of a BVH file is named and rests.
enum class BvhSkeleton {
  kCmu,       ///< As recorded: joints named as CMU's, thighs 20 degrees apart at rest.
  kHumanoid,  ///< A T-pose, and the names of Unity's human bones (motion::Humanoid).
};

/// Writes a file for each subject of a recording of the pose engine into `folder`:
/// "pose_1_p07.bvh", ...; of kMot "pose_1_p07.mot" and "pose_1_p07_grf.mot", and what OpenSim's
/// tools need besides: "pose_1_p07_loads.xml" and the scaled model "pose_1_p07.osim". Of the gait
/// engine it writes the biped as a person (BipedPerson): "gait_1.bvh". A recording without either
/// is InvalidData; an existing file is a usage error, unless `replace`.
///
/// Beside them stand the stated standard deviations of the angles: "pose_1_p07_errors.csv" for each
/// coordinate, and with kMot "pose_1_p07_sd.sto" with the columns and times of the angles, and
/// "pose_1_p07_angles.csv" with their change from standing (motion::AnglesCsv).
///
/// Where the pose is not valid, the places of joints have a gap; rotations and angles, whose files
/// cannot have one, keep the pose.
Result<std::vector<ExportedMotion>> ExportBodies(const std::string& recording,
                                                 const std::string& folder, BodyFormat format,
                                                 bool replace,
                                                 BvhSkeleton skeleton = BvhSkeleton::kCmu);

/// The skeleton of a frame, with the lengths that it has there. All joints turn about z, x, y of
/// W's axes at rest, as BVH files mostly do; ends do not turn. InvalidData where its links are not
/// a tree.
Result<body::Skeleton> SkeletonOf(const v1::Skeleton& skeleton, const v1::Character& first);
/// The pose of a frame on that skeleton: of equal angles those nearest to what stands in `q`.
void SetPose(const body::Skeleton& skeleton, const v1::Character& character,
             Eigen::Ref<Eigen::VectorXd> q);

/// Gathers frames of one reconstructed body into a motion.
///
/// Lengths are those of the first frame taken (links are rigid); every joint turns about three
/// axes. Frames before the T-pose are left out; where a frame is missing the one before stands.
class MotionGatherer {
 public:
  /// `is_biped`: the poses are those of BipedPerson, simulated and not estimated.
  explicit MotionGatherer(const v1::Skeleton& skeleton, bool is_biped = false)
      : skeleton_(skeleton), is_biped_(is_biped) {}

  void Add(const v1::CharacterFrame& frame, std::uint64_t log_time_ns = 0);
  /// Nothing where no frame was taken. InvalidData where frames and skeleton do not fit, or time
  /// does not go on.
  Result<motion::Motion> Finish() const;
  /// The loads of the feet at the instants of the poses of Finish(). A foot has none where its
  /// centre of pressure is not known, or while the boards or its insole measure nothing: the engine
  /// repeats the last load then.
  Result<std::vector<motion::FootForces>> Forces() const;
  /// Whether the engine reported each pose of Finish() as valid.
  Result<std::vector<bool>> Valid() const;
  /// The standard deviations that the engine states of the angles of each pose of Finish(),
  /// degrees, by body::kStatedAngles; empty rows in paper mode, and in recordings before they were
  /// stated.
  Result<std::vector<std::vector<double>>> AngleDeviations() const;
  bool empty() const { return frames_.empty(); }
  const std::string& subject() const { return subject_; }
  bool is_biped() const { return is_biped_; }
  /// Mass and height as the engine reported them last; nothing without a weight.
  std::optional<body::PersonParameters> Person() const;
  /// Lag of a pose behind its frame, s.
  double lag_s() const;
  /// Log time of the first frame taken.
  std::uint64_t begin_ns() const { return begin_ns_; }

 private:
  /// Frames at equal steps: the newest one of each step.
  struct Grid {
    double step_s = 0;
    std::vector<std::size_t> frames;
  };
  Result<Grid> MakeGrid() const;

  v1::Skeleton skeleton_;
  bool is_biped_ = false;
  std::vector<v1::CharacterFrame> frames_;
  std::string subject_;
  std::uint64_t begin_ns_ = 0;
};

}  // namespace footing::log_client
