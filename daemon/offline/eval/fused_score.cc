#include "daemon/offline/eval/fused_score.h"

#include <cmath>

#include "common/body/skeleton_points.h"
#include "common/base/units.h"
#include "daemon/offline/eval/leg_split.h"

namespace footing::eval {
namespace {

using stream::BodyJoint;

bool IsBetween(std::size_t index, BodyJoint first, BodyJoint last) {
  return index >= body::IndexOf(first) && index <= body::IndexOf(last);
}

/// Left or right, by the left joint.
std::size_t OfSide(BodyJoint left, std::size_t side) { return body::IndexOf(left) + side; }

LegPlaces LegOf(const JointPlaces& places, std::size_t side) {
  return {places[OfSide(BodyJoint::kLeftHip, side)], places[OfSide(BodyJoint::kLeftKnee, side)],
          places[OfSide(BodyJoint::kLeftFoot, side)]};
}

}  // namespace

void FusedScore::AddKnee(const JointPlaces& truth, const JointPlaces& places, std::size_t side) {
  const LegPlaces is = LegOf(places, side), was = LegOf(truth, side);
  const KneeError knee = SplitKneeError(was, is);
  hip_heights_.Add(100 * std::abs(is.hip.z() - was.hip.z()));
  feet_.Add(100 * (is.ankle - was.ankle).norm());
  turns_.Add(RadiansToDegrees(std::abs(knee.turn_rad)));
  unturned_.Add(100 * knee.unturned_m);
}

void FusedScore::Add(const JointPlaces& truth, const JointPlaces& places,
                     const std::array<bool, stream::kBodyJoints>& hidden, bool squats) {
  for (std::size_t side = 0; squats && side < 2; ++side) AddKnee(truth, places, side);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double off_cm = 100 * (places[i] - truth[i]).norm();
    if (squats && IsBetween(i, BodyJoint::kLeftHip, BodyJoint::kRightHip)) hips_.Add(off_cm);
    if (squats && IsBetween(i, BodyJoint::kLeftKnee, BodyJoint::kRightKnee)) knees_.Add(off_cm);
    if (!hidden[i]) {
      seen_.Add(off_cm);
      if (IsBetween(i, BodyJoint::kLeftShoulder, BodyJoint::kRightElbow)) seen_arms_.Add(off_cm);
      continue;
    }
    hidden_.Add(off_cm);
    if (IsBetween(i, BodyJoint::kLeftShoulder, BodyJoint::kRightElbow)) arms_.Add(off_cm);
    if (IsBetween(i, BodyJoint::kLeftHip, BodyJoint::kRightKnee)) legs_.Add(off_cm);
  }
}

nlohmann::ordered_json FusedScore::Json() const {
  return {{"hip_cm", hips_.mean()},
          {"hip_p95_cm", hips_.Quantile(0.95)},
          {"knee_cm", knees_.mean()},
          {"knee_p95_cm", knees_.Quantile(0.95)},
          {"knee_turn_deg", turns_.mean()},
          {"knee_unturned_cm", unturned_.mean()},
          {"hip_height_cm", hip_heights_.mean()},
          {"foot_cm", feet_.mean()},
          {"hidden_cm", hidden_.mean()},
          {"hidden_arms_cm", arms_.mean()},
          {"hidden_legs_cm", legs_.mean()},
          {"seen_cm", seen_.mean()},
          {"seen_arms_cm", seen_arms_.mean()}};
}

}  // namespace footing::eval
