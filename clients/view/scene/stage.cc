#include "clients/view/scene/stage.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/arrows.h"
#include "clients/view/scene/bird.h"
#include "clients/view/scene/ribbon.h"

namespace footing::scene {
namespace {

constexpr double kEmptyHipHeightM = 1.0;

/// The higher a thing, the wider and paler its spot.
Blob BlobUnder(const Eigen::Vector3d& p_m, double floor_m, double radius_m, double darkness) {
  const double height_m = std::max(0.0, p_m.z() - floor_m);
  const double wider = 1 + 0.35 * height_m;
  return {Eigen::Vector3d(p_m.x(), p_m.y(), floor_m).cast<float>(),
          static_cast<float>(radius_m * wider), static_cast<float>(darkness / (wider * wider))};
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
  AddBird(skeleton, pose, motion, floor_m, picture.birds);
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

Picture Stage::Advance(const Model& model, const WorldFrame& frame, double dt_s,
                       const StageOptions& options) {
  Picture picture;
  picture.ground_m = static_cast<float>(GroundHeight(model.track));
  Subject subject;
  subject.position_m.z() = kEmptyHipHeightM;
  bool first = true;
  for (const CharacterPose& pose : frame.characters) {
    if (!pose.valid) continue;
    AddCharacter(model, pose, dt_s, options, picture);
    if (first) subject = SubjectOf(model, pose);
    first = false;
  }
  camera_.Advance(subject, dt_s);
  picture.camera = camera_.Look();
  picture.focus_m = subject.position_m.cast<float>();
  picture.floor_m = static_cast<float>(
      HeightAt(model.track, subject.position_m.head<2>(), static_cast<double>(picture.ground_m)));
  return picture;
}

}  // namespace footing::scene
