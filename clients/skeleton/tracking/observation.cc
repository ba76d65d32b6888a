#include "clients/skeleton/tracking/observation.h"

#include <algorithm>

namespace footing::skeleton {

Observation Observe(const Skeleton& skeleton, const Eigen::Isometry3d& X_WK) {
  Observation observation;
  observation.user = skeleton.user;
  observation.sequence = skeleton.sequence;
  constexpr double kVarianceM2 = kJitterM * kJitterM + kOffsetM * kOffsetM;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const JointReading& reading = skeleton.joints[i];
    JointObservation& joint = observation.joints[i];
    joint.present = reading.present();
    if (!joint.present) continue;
    joint.inferred = reading.confidence < PersonGate::kTrackedFrom;
    joint.p_W_m = X_WK * reading.p_K_m;
    const double factor = joint.inferred ? kInferredFactor : 1;
    joint.covariance_W_m2 = factor * factor * kVarianceM2 * Eigen::Matrix3d::Identity();
    joint.confidence = reading.confidence;
  }
  return observation;
}

std::optional<stream::HandFrame> ToHandFrame(const Observation& observation, std::int64_t now_ns) {
  stream::HandFrame frame;
  frame.tracker = "skeleton";
  frame.age_ns = std::clamp<std::int64_t>(now_ns - observation.exposed_ns, 0, 1'000'000'000);
  for (const auto& [joint, role] : {std::pair(Joint::kLeftHand, stream::DeviceRole::kLeftHand),
                                    std::pair(Joint::kRightHand, stream::DeviceRole::kRightHand)}) {
    const JointObservation& hand = observation.joints[Index(joint)];
    if (!hand.present || hand.p_W_m.norm() > kFarthestM) continue;
    frame.points.push_back({.role = role,
                            .position_m = hand.p_W_m,
                            .sd_m = hand.covariance_W_m2.diagonal().cwiseSqrt(),
                            .confidence = hand.confidence});
  }
  if (frame.points.empty()) return std::nullopt;
  return frame;
}

}  // namespace footing::skeleton
