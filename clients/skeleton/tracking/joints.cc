#include "clients/skeleton/tracking/joints.h"

#include <algorithm>

namespace footing::skeleton {

Joint Mirrored(Joint joint) {
  if (joint == Joint::kHead || joint == Joint::kNeck || joint == Joint::kTorso) return joint;
  // From the shoulders to the hands left is even; from the hips down, behind the torso, odd.
  const std::size_t index = Index(joint);
  const bool left = (index < Index(Joint::kTorso)) == (index % 2 == 0);
  return static_cast<Joint>(left ? index + 1 : index - 1);
}

std::size_t Skeleton::present() const {
  return static_cast<std::size_t>(
      std::count_if(joints.begin(), joints.end(), [](const auto& one) { return one.present(); }));
}

Skeleton SwappedSides(const Skeleton& skeleton) {
  Skeleton swapped = skeleton;
  for (std::size_t i = 0; i < kJoints; ++i)
    swapped.joints[i] = skeleton[Mirrored(static_cast<Joint>(i))];
  return swapped;
}

Skeleton MirrorImage(const Skeleton& skeleton) {
  Skeleton image = SwappedSides(skeleton);
  for (JointReading& joint : image.joints) joint.p_K_m.x() *= -1;
  if (image.toes_K_m) image.toes_K_m->x() *= -1;
  return image;
}

}  // namespace footing::skeleton
