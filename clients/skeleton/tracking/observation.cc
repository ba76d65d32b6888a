#include "clients/skeleton/tracking/observation.h"

#include <algorithm>

namespace footing::skeleton {
namespace {

stream::BodyJoint BodyJointOf(Joint joint) {
  using stream::BodyJoint;
  constexpr BodyJoint kOf[kJoints] = {
      BodyJoint::kHead,          BodyJoint::kNeck,        BodyJoint::kLeftShoulder,
      BodyJoint::kRightShoulder, BodyJoint::kLeftElbow,   BodyJoint::kRightElbow,
      BodyJoint::kUnspecified,   BodyJoint::kUnspecified, BodyJoint::kTorso,
      BodyJoint::kLeftHip,       BodyJoint::kRightHip,    BodyJoint::kLeftKnee,
      BodyJoint::kRightKnee,     BodyJoint::kLeftFoot,    BodyJoint::kRightFoot};
  return kOf[Index(joint)];
}

}  // namespace

Observation Observe(const Skeleton& skeleton, const Eigen::Isometry3d& X_WK) {
  Observation observation;
  observation.user = skeleton.user;
  observation.sequence = skeleton.sequence;
  observation.X_WK = X_WK;
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

stream::HandFrame ToHandFrame(const Observation& observation, std::int64_t now_ns) {
  stream::HandFrame frame;
  frame.tracker = "skeleton";
  frame.sent_ns = now_ns;
  frame.age_ns =
      std::clamp<std::int64_t>(now_ns - observation.exposed_ns, 0, stream::kOldestPointNs);
  frame.tracker_pose = stream::TrackerPose{observation.X_WK.translation(),
                                           Eigen::Quaterniond(observation.X_WK.rotation())};
  for (std::size_t i = 0; i < kJoints; ++i) {
    stream::TrackedPoint point;
    const auto name = static_cast<Joint>(i);
    if (name == Joint::kLeftHand) point.role = stream::DeviceRole::kLeftHand;
    if (name == Joint::kRightHand) point.role = stream::DeviceRole::kRightHand;
    if (point.role == stream::DeviceRole::kUnspecified) point.joint = BodyJointOf(name);
    const JointObservation& joint = observation.joints[i];
    if (joint.present && joint.p_W_m.norm() <= stream::kFarthestPointM) {
      point.position_m = joint.p_W_m;
      // Whoever uses the point divides its covariance by its confidence.
      const Eigen::Matrix3d covariance = joint.confidence * joint.covariance_W_m2;
      point.sd_m = covariance.diagonal().cwiseSqrt();
      point.covariance_m2 = {covariance(0, 1), covariance(0, 2), covariance(1, 2)};
      point.confidence = joint.confidence;
      point.occluded = joint.inferred;
    }
    frame.points.push_back(point);
  }
  return frame;
}

}  // namespace footing::skeleton
