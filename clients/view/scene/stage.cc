#include "clients/view/scene/stage.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/arrows.h"
#include "clients/view/scene/bird.h"
#include "clients/view/scene/body_stage.h"
#include "clients/view/scene/calibration.h"
#include "clients/view/scene/course.h"
#include "clients/view/scene/game_ghost.h"
#include "common/board/geometry.h"

namespace footing::scene {
namespace {

constexpr double kEmptyHipHeightM = 1.0;
constexpr double kSlopeHalfM = 0.3;
constexpr double kSteepest = 0.6;
/// The picture follows a head within this time, without its tremor.
constexpr double kRollS = 0.15;

/// The higher a thing, the wider and paler its spot.
Blob BlobUnder(const Eigen::Vector3d& p_m, double floor_m, double radius_m, double darkness) {
  const double height_m = std::max(0.0, p_m.z() - floor_m);
  const double wider = 1 + 0.35 * height_m;
  return {Eigen::Vector3d(p_m.x(), p_m.y(), floor_m).cast<float>(),
          static_cast<float>(radius_m * wider), static_cast<float>(darkness / (wider * wider))};
}

/// The rise is measured over 0.6 m; where that meets a step or an edge the ground counts as level.
Spot SpotUnder(const stream::Track& track, const Eigen::Vector2d& p_m, double floor_m) {
  const auto rise = [&](const Eigen::Vector2d& half_m) {
    const double difference_m =
        HeightAt(track, p_m + half_m, floor_m) - HeightAt(track, p_m - half_m, floor_m);
    const double slope = difference_m / (2 * half_m.norm());
    return std::abs(slope) < kSteepest ? static_cast<float>(slope) : 0.0f;
  };
  return {Eigen::Vector3d(p_m.x(), p_m.y(), floor_m).cast<float>(),
          {rise({kSlopeHalfM, 0}), rise({0, kSlopeHalfM})}};
}

BirdSkeleton SkeletonOf(const Model& model, std::uint32_t character) {
  for (const stream::Skeleton& skeleton : model.skeletons) {
    if (skeleton.character == character) return FindParts(skeleton);
  }
  return {};
}

Subject SubjectOf(const Model& model, const CharacterPose& pose) {
  const BirdSkeleton skeleton = SkeletonOf(model, pose.character);
  Subject subject;
  subject.position_m = pose.com_m;
  if (skeleton.body < static_cast<int>(pose.links.size())) {
    subject.position_m = pose.links[static_cast<std::size_t>(skeleton.body)].position_m;
  }
  subject.heading_rad = pose.gait.heading_rad;
  subject.speed_mps = pose.gait.speed_mps;
  return subject;
}

}  // namespace

void Stage::AddCharacter(const Model& model, const CharacterPose& pose, double dt_s,
                         const StageOptions& options, Picture& picture) {
  const auto ground_m = static_cast<double>(picture.ground_m);
  const BirdSkeleton skeleton = SkeletonOf(model, pose.character);
  BirdMotion& motion = motions_[pose.character];
  motion = scene::Advance(motion, skeleton, pose, dt_s);

  if (options.forces) AddForceArrows(pose, picture.forces);

  const double floor_m = HeightAt(model.track, pose.com_m.head<2>(), ground_m);
  AddBird(skeleton, pose, motion, floor_m, picture.figures);
  picture.spots.push_back(SpotUnder(model.track, pose.com_m.head<2>(), floor_m));
  picture.blobs.push_back(BlobUnder(pose.com_m, floor_m, 0.42, 0.75));
  for (const stream::Contact& foot : pose.contacts) {
    picture.blobs.push_back(BlobUnder(foot.position_m, floor_m, 0.15, 0.5));
  }
  const Eigen::Vector2d& next_m = pose.gait.next_foothold_m;
  if (!next_m.isZero()) {
    const double height_m = HeightAt(model.track, next_m, ground_m);
    picture.footholds.push_back(Eigen::Vector3d(next_m.x(), next_m.y(), height_m).cast<float>());
  }
}

void Stage::AddReconstructed(const Model& model, const CharacterPose& pose, double time_s,
                             std::int64_t now_ns, const StageOptions& options, Picture& picture) {
  ComTrail& trail = trails_[pose.character];
  if (pose.body->momentum_valid) trail.Add(time_s, pose.com_m);
  AddBody(model, pose, trail, now_ns, options, picture);
  const double floor_m = -board::kPlateHeightM;
  picture.spots.push_back(
      {Eigen::Vector3d(pose.com_m.x(), pose.com_m.y(), floor_m).cast<float>(), {0, 0}});
}

Picture Stage::AdvancePeople(const Model& model, const WorldFrame& frame, std::int64_t now_ns,
                             double dt_s, const StageOptions& options) {
  Picture picture;
  picture.studio = true;
  picture.ground_m = picture.floor_m = static_cast<float>(-board::kPlateHeightM);
  Eigen::Vector2d body_m(0, 0);
  for (const CharacterPose& pose : frame.characters) {
    if (!pose.body) continue;
    AddReconstructed(model, pose, frame.time_s, now_ns, options, picture);
    if (pose.body->calibrated) body_m = pose.com_m.head<2>();
  }
  front_.Advance(body_m, HasReference(model, now_ns) && !options.overlay_reference, dt_s);
  picture.camera = front_.Look();
  return picture;
}

Picture Stage::Advance(const Model& model, const WorldFrame& frame, std::int64_t now_ns,
                       double dt_s, const StageOptions& options) {
  if (model.observed.calibration) {
    Picture picture;
    AddCalibration(model, now_ns, picture);
    return picture;
  }
  if (!frame.characters.empty() && frame.characters.front().body) {
    return AdvancePeople(model, frame, now_ns, dt_s, options);
  }
  Picture picture;
  picture.ground_m = static_cast<float>(GroundHeight(model.track));
  Subject subject;
  subject.position_m.z() = kEmptyHipHeightM;
  double roll_rad = 0;
  bool first = true;
  for (const CharacterPose& pose : frame.characters) {
    if (!pose.valid) continue;
    AddCharacter(model, pose, dt_s, options, picture);
    if (first) subject = SubjectOf(model, pose);
    if (first) roll_rad = pose.interface.view_roll_rad;
    first = false;
  }
  AddGhostSegment(model.game, picture.ghosts);
  camera_.Advance(subject, dt_s);
  picture.camera = camera_.Look();
  roll_rad_ += (roll_rad - roll_rad_) * (1 - std::exp(-std::clamp(dt_s, 0.0, 1.0) / kRollS));
  picture.camera.roll_rad = roll_rad_;

  picture.floor_m = static_cast<float>(
      HeightAt(model.track, subject.position_m.head<2>(), static_cast<double>(picture.ground_m)));
  return picture;
}

}  // namespace footing::scene
