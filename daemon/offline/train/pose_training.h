#pragma once

#include <cstdint>
#include <vector>

#include "common/model/model.h"
#include "daemon/offline/learning/pose_regression.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/offline/train/motions.h"
#include "daemon/simulation/reconstruction/models.h"

/// How poses are learned from clips: simulated sensors, the reconstruction's own estimators, and a
/// regression on what these say.
namespace footing::train {

inline constexpr double kPosePieceS = 10;        ///< Frames of one piece are left out together.
inline constexpr std::size_t kFewestPeople = 3;  ///< Whose errors show those of the next person.
inline constexpr double kSettledS = 1.5;         ///< After the T-pose.

/// A clip, or its mirror image, and how its random errors and pieces are numbered.
struct PoseTake {
  const Clip* clip;
  bool mirrored = false;
  int piece = 0;   ///< Of its first piece.
  int person = 0;  ///< Number of the clip's subject.
  /// All that a person did is left out together; else pieces are.
  bool by_person = false;
  std::uint64_t seed = 1;
};

/// All clips and their mirror images; a clip and its image are in the same folds: those of people,
/// where there are kFewestPeople of them. `piece` is that of the first, and becomes that after the
/// last.
std::vector<PoseTake> TakesOf(const std::vector<const Clip*>& clips, std::uint64_t seed,
                              int& piece);

/// What two boards and two hand trackers would have measured, and a tracker of the head and a belt
/// where there are such.
Result<pose_run::PoseRun> SimulateTake(const PoseTake& take,
                                       pose_run::HeadDevice head = pose_run::HeadDevice::kNone,
                                       bool belt = false);

/// Appends the take's frames.
Result<void> AddExamples(const PoseTake& take, const reconstruction::Models& models,
                         learning::PoseCues cues, learning::PoseExamples& examples);

/// Fits what is foreseen by `cues` and appends it to the model, which has a basis of this scale.
learning::FittedPoseRegression AppendPoses(const learning::PoseExamples& examples,
                                           learning::PoseCues cues, const Eigen::VectorXd& scale,
                                           std::uint64_t seed, model::Model& model);

}  // namespace footing::train
