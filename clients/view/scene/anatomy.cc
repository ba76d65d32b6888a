#include "clients/view/scene/anatomy.h"

#include <utility>

namespace footing::scene {
namespace {

bool HasTree(const stream::Skeleton& skeleton) {
  for (std::size_t i = 0; i < skeleton.links.size(); ++i) {
    const int parent = skeleton.links[i].parent;
    if (i == 0 ? parent != -1 : parent < 0 || parent >= static_cast<int>(i)) return false;
  }
  return !skeleton.links.empty();
}

}  // namespace

Anatomy FindAnatomy(const stream::Skeleton& skeleton) {
  Anatomy anatomy;
  anatomy.landmarks.joint.fill(-1);
  if (!HasTree(skeleton)) return anatomy;
  std::vector<body::Joint> joints;
  for (const stream::Link& link : skeleton.links) {
    body::Joint joint;
    joint.name = link.name;
    joint.parent = link.parent;
    joints.push_back(std::move(joint));
    anatomy.parents.push_back(link.parent);
    anatomy.radii_m.push_back(static_cast<float>(0.5 * link.size_m.maxCoeff()));
  }
  const auto landmarks = body::FindLandmarks(body::MakeSkeleton(std::move(joints)));
  if (!landmarks) return anatomy;
  anatomy.landmarks = *landmarks;
  anatomy.person = true;
  return anatomy;
}

bool Fits(const Anatomy& anatomy, const std::vector<int>& parents) {
  return anatomy.person && anatomy.parents == parents;
}

}  // namespace footing::scene
