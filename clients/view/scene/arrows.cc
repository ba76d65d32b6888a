#include "clients/view/scene/arrows.h"

#include <algorithm>

namespace footing::scene {
namespace {

constexpr double kSmallestN = 5;
constexpr float kLongestM = 3;
constexpr float kHeadM = 0.12f;

}  // namespace

void AddForceArrows(const CharacterPose& pose, PartList& parts) {
  const Colour colour = Rgb(0xff4d6d);
  for (const stream::Contact& contact : pose.contacts) {
    if (!contact.touching || contact.normal_force_n < kSmallestN) continue;
    const float length =
        std::min(static_cast<float>(contact.normal_force_n / kForcePerMetreN), kLongestM);
    const Eigen::Vector3f foot = contact.position_m.cast<float>();
    const Eigen::Vector3f neck = foot + Eigen::Vector3f(0, 0, length);
    parts.AddRod(foot, neck, 0.016f, 0.016f, colour);
    parts.AddRod(neck, neck + Eigen::Vector3f(0, 0, kHeadM), 0.045f, 0.001f, colour);
  }
}

}  // namespace footing::scene
