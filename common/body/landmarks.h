#pragma once

#include <array>
#include <string_view>

#include "common/base/result.h"
#include "common/body/skeleton.h"

namespace footing::body {

/// The joint centres and end points that every skeleton of a person has, under whatever name.
enum class Landmark {
  kHips,    ///< The root of the trunk, between the hips or above.
  kChest,   ///< The uppermost joint of the trunk below the neck.
  kNeck,    ///< Base of the neck (C7 to T1).
  kHead,    ///< Base of the skull.
  kVertex,  ///< Top of the head.
  kLeftClavicle,
  kLeftShoulder,
  kLeftElbow,
  kLeftWrist,
  kLeftHandEnd,  ///< Knuckles or finger tips: only its direction is used.
  kLeftHip,
  kLeftKnee,
  kLeftAnkle,
  kLeftToe,     ///< Ball of the foot.
  kLeftToeEnd,  ///< Tip of the toes.
  kRightClavicle,
  kRightShoulder,
  kRightElbow,
  kRightWrist,
  kRightHandEnd,
  kRightHip,
  kRightKnee,
  kRightAnkle,
  kRightToe,
  kRightToeEnd,
};
inline constexpr int kLandmarkCount = 25;

/// "left_knee", ...
std::string_view LandmarkName(Landmark landmark);

/// Joint of each landmark in one skeleton; -1 where the skeleton has none.
struct Landmarks {
  std::array<int, kLandmarkCount> joint;

  int operator[](Landmark landmark) const { return joint[static_cast<std::size_t>(landmark)]; }
};

/// Finds the landmarks by the joints' names: CMU's ASF, Biovision and MotionBuilder style BVH (with
/// any prefix up to ':' or "Character1_"), iClone, SMPL, game engines; the side stands in front
/// ("LeftFoot", "l_foot") or behind ("Foot_L", "foot.R"). Case does not matter. Hips, knees,
/// ankles, shoulders, elbows, wrists and neck are necessary: without one of them the error names it
/// and the joints that are there. So are limbs whose joints hang on each other in their order.
Result<Landmarks> FindLandmarks(const Skeleton& skeleton);

/// The same landmark of the other side; those of the middle are their own.
Landmark Mirrored(Landmark landmark);
/// `left` itself for side 0, its mirror image for side 1.
inline Landmark OfSide(Landmark left, int side) { return side == 0 ? left : Mirrored(left); }

}  // namespace footing::body
