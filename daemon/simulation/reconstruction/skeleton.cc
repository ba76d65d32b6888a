#include "daemon/simulation/reconstruction/skeleton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "common/body/points.h"

namespace footing::reconstruction {
namespace {

constexpr int kLeastJoints = 4;  // Of a skeleton that shows more than a limb.
// Deviations from the pose of a moment ago, whitened by the joint's own covariance: of a joint that
// is right 3.5 are exceeded once in 140 looks (chi squared of three), 10 never.
constexpr double kDoubtedFrom = 3.5, kDroppedFrom = 10;
constexpr double kMostDroppedShare = 1.0 / 3;
// An offset of a Kinect changes over 5 s (virtual_sensors::KinectErrors), and a pose that also
// follows the joints shows a part of it only, so it is learned in less.
constexpr double kOffsetLearnedS = 1;
constexpr double kMostOffsetM = 0.3;  // Further off is a camera that was never placed.

pose::PointTarget TargetOf(const body::Point& point, const JointInput& joint) {
  return {point.joint, point.p_J_m, joint.p_W_m,
          joint.sd_m,  -1,          pose::WhiteningOf(joint.sd_m, joint.covariance_m2)};
}

void Widen(double factor, JointInput& joint) {
  joint.sd_m *= factor;
  joint.covariance_m2 *= factor * factor;
}

}  // namespace

bool IsSkeleton(const JointInputs& joints) {
  return std::count_if(joints.begin(), joints.end(),
                       [](const JointInput& joint) { return joint.valid; }) >= kLeastJoints;
}

void AddJointTargets(const JointPoints& points, const JointInputs& joints,
                     pose::PoseTargets& targets) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].valid) targets.Add(TargetOf(points[i], joints[i]));
  }
}

void GateJoints(const JointPoints& points, const body::Kinematics& at, JointInputs& joints) {
  std::array<double, stream::kBodyJoints> off{};
  int seen = 0, dropped = 0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].valid) continue;
    const pose::PointTarget target = TargetOf(points[i], joints[i]);
    off[i] = Whitened(target, target.p_W_m - PlaceOf(target, at)).norm();
    joints[i].valid = std::isfinite(off[i]);
    if (!joints[i].valid) continue;
    ++seen;
    if (off[i] > kDroppedFrom) ++dropped;
  }
  const bool drops = dropped <= kMostDroppedShare * seen;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].valid || off[i] <= kDoubtedFrom) continue;
    joints[i].valid = off[i] <= kDroppedFrom || !drops;
    Widen(off[i] / kDoubtedFrom, joints[i]);
  }
}

Inputs SkeletonOffset::Without(const Inputs& inputs) const {
  Inputs corrected = inputs;
  for (JointInput& joint : corrected.joints) joint.p_W_m -= offset_m_;
  for (HandInput& hand : corrected.hands) {
    if (hand.of_skeleton) hand.p_W_m -= offset_m_;
  }
  return corrected;
}

void SkeletonOffset::Learn(const JointPoints& points, const JointInputs& joints,
                           const body::Kinematics& at, double step_s) {
  if (!IsSkeleton(joints)) return;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), weights = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].valid) continue;
    const Eigen::Vector3d weight = joints[i].sd_m.cwiseAbs2().cwiseInverse();
    const Eigen::Vector3d off_m = joints[i].p_W_m - body::Place(points[i], at);
    sum += weight.cwiseProduct(off_m);
    weights += weight;
  }
  if (!(weights.minCoeff() > 0)) return;
  const double share = std::min(1.0, step_s / kOffsetLearnedS);
  const Eigen::Vector3d next_m = offset_m_ + share * sum.cwiseQuotient(weights);
  if (next_m.allFinite()) offset_m_ = next_m.cwiseMax(-kMostOffsetM).cwiseMin(kMostOffsetM);
}

}  // namespace footing::reconstruction
