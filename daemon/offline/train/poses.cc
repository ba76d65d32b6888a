#include "daemon/offline/train/poses.h"

#include <algorithm>

#include "common/virtual/motion/edit.h"
#include "common/virtual/devices/scene.h"
#include "daemon/offline/learning/alignment.h"

namespace footing::train {
namespace {

constexpr double kRootHeightM = 1;

/// On the ground, and as large as a person whose root is 1 m high in the T-pose.
motion::Motion Standing(motion::Motion motion, const body::Landmarks& landmarks) {
  motion.q.row(2).array() -= virtual_sensors::FloorHeight(motion, landmarks);
  motion.q.topRows<3>() *= kRootHeightM / body::TPose(motion.skeleton, landmarks)(2);
  return motion;
}

/// The motions and their mirror images: people are as often left as right.
std::vector<motion::Motion> WithMirrors(const std::vector<Clip>& clips) {
  std::vector<motion::Motion> motions;
  for (const Clip& clip : clips) {
    const body::Landmarks& landmarks = clip.body.landmarks;
    motions.push_back(Standing(clip.motion, landmarks));
    motions.push_back(
        Standing(learning::Aligned(motion::Mirrored(clip.motion), landmarks), landmarks));
  }
  return motions;
}

/// Poses 60 times a second, a column each; all clips must have one layout.
Result<Eigen::MatrixXd> Poses(const std::vector<Clip>& clips,
                              const std::vector<motion::Motion>& motions) {
  constexpr double kRateHz = 60;
  const std::vector<std::string> dofs = DofNames(clips.front().motion.skeleton);
  std::vector<Eigen::VectorXd> columns;
  for (const Clip& clip : clips) {
    if (DofNames(clip.motion.skeleton) != dofs) {
      return InvalidData(clip.name + ": another skeleton layout than " + clips.front().name +
                         "; train a basis of one layout at a time");
    }
  }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(clips.front().motion.skeleton.dof);
  for (const motion::Motion& motion : motions) {
    const double step = std::max(1.0, motion.rate_hz / kRateHz);
    for (double at = 0; at < static_cast<double>(motion.frames()); at += step) {
      columns.push_back(
          motion::NearestPose(motion.skeleton, motion.q.col(static_cast<Eigen::Index>(at)), zero));
    }
  }
  Eigen::MatrixXd poses(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    poses.col(static_cast<Eigen::Index>(i)) = columns[i];
  }
  return poses;
}

}  // namespace

Result<TrainedBasis> TrainBasis(const std::vector<Clip>& clips) {
  const std::vector<motion::Motion> motions = WithMirrors(clips);
  const Result<Eigen::MatrixXd> poses = Poses(clips, motions);
  if (!poses) return poses.error();
  learning::PoseBasis basis = learning::MakeBasis(*poses, DofNames(clips.front().motion.skeleton));
  return TrainedBasis{std::move(basis), poses->cols()};
}

void AppendBasis(const learning::PoseBasis& basis, model::Model& model) {
  learning::AppendTensors(basis, model);
  model.tensors.push_back({.name = "root_height_m", .shape = {1}, .values = {kRootHeightM}});
}

}  // namespace footing::train
