#include "daemon/offline/eval/fusion/fused_score.h"

#include "common/body/skeleton_points.h"

namespace footing::eval {
namespace {

using stream::BodyJoint;

bool IsBetween(std::size_t index, BodyJoint first, BodyJoint last) {
  return index >= body::IndexOf(first) && index <= body::IndexOf(last);
}

}  // namespace

void FusedScore::Add(const JointPlaces& truth, const JointPlaces& places,
                     const std::array<bool, stream::kBodyJoints>& hidden, bool squats) {
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
  return {{"hip_cm", hips_.mean()},           {"hip_p95_cm", hips_.Quantile(0.95)},
          {"knee_cm", knees_.mean()},         {"knee_p95_cm", knees_.Quantile(0.95)},
          {"hidden_cm", hidden_.mean()},      {"hidden_arms_cm", arms_.mean()},
          {"hidden_legs_cm", legs_.mean()},   {"seen_cm", seen_.mean()},
          {"seen_arms_cm", seen_arms_.mean()}};
}

}  // namespace footing::eval
