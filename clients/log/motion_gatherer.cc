#include "clients/log/motion_gatherer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/body/skeleton.h"
#include "common/wire/wire.h"

namespace footing::log_client {
namespace {

constexpr double kMostRateHz = 1000;
constexpr double kMostLagS = 10;
constexpr double kMostRowsPerFrame = 100;  // What is missing between frames is filled.

Eigen::Vector3d PlaceOf(const v1::Character& character, int link) {
  return wire::FromProto(character.links(link).position_m());
}

Eigen::Matrix3d TurnOf(const v1::Character& character, int link) {
  return wire::FromProto(character.links(link).orientation()).normalized().toRotationMatrix();
}

bool HasChild(const v1::Skeleton& skeleton, int link) {
  return std::any_of(skeleton.links().begin(), skeleton.links().end(),
                     [link](const v1::Link& other) { return other.parent() == link; });
}

/// All joints turn about z, x, y of W's axes at rest, as BVH files mostly do; ends do not turn.
Result<body::Skeleton> SkeletonOf(const v1::Skeleton& skeleton, const v1::Character& first) {
  std::vector<body::Joint> joints;
  for (int i = 0; i < skeleton.links_size(); ++i) {
    const v1::Link& link = skeleton.links(i);
    const bool fits = i == 0 ? link.parent() == -1 : link.parent() >= 0 && link.parent() < i;
    if (!fits) return InvalidData("the recorded skeleton is not a tree");
    body::Joint joint;
    joint.name = link.name();
    joint.parent = link.parent();
    if (i > 0) {
      joint.offset_m = TurnOf(first, link.parent()).transpose() *
                       (PlaceOf(first, i) - PlaceOf(first, link.parent()));
    }
    if (i == 0 || HasChild(skeleton, i)) {
      joint.rotations = {{body::Axis::kZ}, {body::Axis::kX}, {body::Axis::kY}};
    }
    joints.push_back(std::move(joint));
  }
  return body::MakeSkeleton(std::move(joints));
}

/// Whether the load of a foot is of this frame. Without both boards the engine repeats the last
/// loads of both feet, while each insole counts on its own.
bool IsFresh(const v1::BodyState& body, int side) {
  const auto measured = [&body](int foot) {
    return foot >= body.feet_told_size() || body.feet_told(foot);
  };
  return measured(side) && (body.contact_source() == "insoles" || measured(1 - side));
}

void SetPose(const body::Skeleton& skeleton, const v1::Character& character,
             Eigen::Ref<Eigen::VectorXd> q) {
  q.head<3>() = PlaceOf(character, 0);
  for (int i = 0; i < skeleton.size(); ++i) {
    const body::Joint& joint = skeleton.joint(i);
    if (joint.rotations.empty()) continue;
    const Eigen::Matrix3d R_WJ = TurnOf(character, i);
    const Eigen::Matrix3d R_PJ =
        joint.parent < 0 ? R_WJ
                         : Eigen::Matrix3d(TurnOf(character, joint.parent).transpose() * R_WJ);
    body::SetJointRotation(joint, R_PJ, q);
  }
}

}  // namespace

void MotionGatherer::Add(const v1::CharacterFrame& frame, std::uint64_t log_time_ns) {
  if (frame.characters_size() == 0) return;
  const v1::Character& character = frame.characters(0);
  if (!character.has_body() || !character.body().calibrated()) return;
  if (character.links_size() != skeleton_.links_size()) return;
  subject_ = character.body().subject();
  // The frame that completes the T-pose has no estimate yet.
  if (frames_.size() == 1 && !frames_[0].characters(0).valid() && character.valid()) {
    frames_.clear();
  }
  if (frames_.empty()) begin_ns_ = log_time_ns;
  frames_.push_back(frame);
}

double MotionGatherer::lag_s() const {
  const double lag_s = frames_.empty() ? 0 : frames_.front().characters(0).body().lag_s();
  return lag_s > 0 && lag_s < kMostLagS ? lag_s : 0;
}

Result<MotionGatherer::Grid> MotionGatherer::MakeGrid() const {
  if (frames_.size() < 2) return InvalidData("fewer than two frames of a body after its T-pose");
  double step_s = frames_.back().time_s() - frames_.front().time_s();
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    const double next_s = frames_[i].time_s() - frames_[i - 1].time_s();
    if (!(next_s > 0)) return InvalidData("the time of the frames does not go on");
    step_s = std::min(step_s, next_s);
  }
  if (step_s < 1 / kMostRateHz) return InvalidData("the frames are less than 1 ms apart");
  Grid grid;
  grid.step_s = step_s;
  const double start_s = frames_.front().time_s();
  const double steps = (frames_.back().time_s() - start_s) / step_s;
  if (!(steps < kMostRowsPerFrame * static_cast<double>(frames_.size()))) {
    return InvalidData("nearly all of the " + std::to_string(std::llround(std::min(steps, 1e15))) +
                       " frames between the first and the last one are missing");
  }
  const auto columns = static_cast<std::size_t>(std::llround(steps) + 1);
  std::size_t at = 0;
  for (std::size_t i = 0; i < columns; ++i) {
    const double time_s = start_s + static_cast<double>(i) * step_s;
    while (at + 1 < frames_.size() && frames_[at + 1].time_s() < time_s + 0.5 * step_s) ++at;
    grid.frames.push_back(at);
  }
  return grid;
}

Result<motion::Motion> MotionGatherer::Finish() const {
  const auto grid = MakeGrid();
  if (!grid) return grid.error();
  auto skeleton = SkeletonOf(skeleton_, frames_.front().characters(0));
  if (!skeleton) return skeleton.error();
  motion::Motion motion;
  motion.skeleton = std::move(skeleton).value();
  motion.rate_hz = std::round(1e6 / grid->step_s) * 1e-6;  // Times are rounded, too.
  motion.start_s = frames_.front().time_s();
  const auto columns = static_cast<Eigen::Index>(grid->frames.size());
  motion.q.setZero(motion.skeleton.dof, columns);
  for (Eigen::Index i = 0; i < columns; ++i) {
    if (i > 0) motion.q.col(i) = motion.q.col(i - 1);  // Angles stay on the same turn.
    const v1::CharacterFrame& frame = frames_[grid->frames[static_cast<std::size_t>(i)]];
    SetPose(motion.skeleton, frame.characters(0), motion.q.col(i));
  }
  return motion;
}

Result<std::vector<FootForces>> MotionGatherer::Forces() const {
  const auto grid = MakeGrid();
  if (!grid) return grid.error();
  std::vector<FootForces> forces(grid->frames.size());
  const auto lag = static_cast<std::size_t>(std::llround(lag_s() / grid->step_s));
  for (std::size_t i = 0; i < forces.size(); ++i) {
    // A frame has the newest loads, and the pose of a lag before them.
    const std::size_t then = i < lag ? 0 : i - lag;
    const v1::BodyState& body = frames_[grid->frames[then]].characters(0).body();
    for (int side = 0; side < std::min(2, body.feet_size()); ++side) {
      const v1::BodyFoot& foot = body.feet(side);
      if (!foot.cop_valid() || !(foot.load_n() > 0) || !IsFresh(body, side)) continue;
      forces[i][static_cast<std::size_t>(side)] = {foot.load_n(), wire::FromProto(foot.cop_m())};
    }
  }
  return forces;
}

Result<std::vector<bool>> MotionGatherer::Valid() const {
  const auto grid = MakeGrid();
  if (!grid) return grid.error();
  std::vector<bool> valid;
  for (const std::size_t frame : grid->frames) {
    valid.push_back(frames_[frame].characters(0).valid());
  }
  return valid;
}

}  // namespace footing::log_client
