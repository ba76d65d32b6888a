#pragma once

#include "clients/view/scene/bird_motion.h"
#include "clients/view/scene/part.h"

namespace footing::scene {

/// Feathers and skin of one bird.
struct Plumage {
  Colour back, belly, wing, tail, crest, skin, beak;
};

/// One plumage a character, so that two players can distinguish their birds.
Plumage PlumageOf(std::uint32_t character);

/// The bird over a biped's pose; its toes bend on the floor of that height. Adds nothing when the
/// pose has not the links it needs.
void AddBird(const BirdSkeleton& skeleton, const CharacterPose& pose, const BirdMotion& motion,
             double floor_m, PartList& parts);

/// Neck, head, eyes, beak and crest. X_WB's columns 0 to 2 are the body's axes, column 3 its place.
void AddHead(const Eigen::Matrix4f& X_WB, const BirdMotion& motion, const Plumage& plumage,
             PartList& parts);

}  // namespace footing::scene
