#include "common/body/skeleton_points.h"

namespace footing::body {
namespace {

using stream::BodyJoint;

Kinematics InTPose(const Body& body) {
  Kinematics at(body.skeleton);
  ComputeKinematics(body.skeleton, TPose(body.skeleton, body.landmarks), at);
  return at;
}

/// A place of the T-pose, fixed to the nearest joint on the way from `from` to the root.
Point Fixed(const Body& body, const Kinematics& at, int from, const Eigen::Vector3d& p_W_m) {
  const auto distance_m = [&](int joint) {
    return (p_W_m - at.p_WJ[static_cast<std::size_t>(joint)]).norm();
  };
  int nearest = from;
  for (int joint = from; joint >= 0; joint = body.skeleton.joint(joint).parent) {
    if (distance_m(joint) < distance_m(nearest)) nearest = joint;
  }
  const auto index = static_cast<std::size_t>(nearest);
  return {nearest, at.R_WJ[index].transpose() * (p_W_m - at.p_WJ[index])};
}

}  // namespace

std::array<Point, stream::kBodyJoints> SkeletonPoints(const Body& body) {
  const Kinematics at = InTPose(body);
  const auto place = [&](Landmark landmark) {
    return at.p_WJ[static_cast<std::size_t>(body.landmarks[landmark])];
  };
  std::array<Point, stream::kBodyJoints> points;
  const auto set = [&](BodyJoint joint, Landmark landmark) {
    points[IndexOf(joint)].joint = body.landmarks[landmark];
  };
  const struct {
    BodyJoint left, right;
    Landmark landmark;
  } pairs[] = {{BodyJoint::kLeftShoulder, BodyJoint::kRightShoulder, Landmark::kLeftShoulder},
               {BodyJoint::kLeftElbow, BodyJoint::kRightElbow, Landmark::kLeftElbow},
               {BodyJoint::kLeftHip, BodyJoint::kRightHip, Landmark::kLeftHip},
               {BodyJoint::kLeftKnee, BodyJoint::kRightKnee, Landmark::kLeftKnee},
               {BodyJoint::kLeftFoot, BodyJoint::kRightFoot, Landmark::kLeftAnkle}};
  for (const auto& pair : pairs) {
    set(pair.left, pair.landmark);
    set(pair.right, Mirrored(pair.landmark));
  }
  set(BodyJoint::kNeck, Landmark::kNeck);
  const bool has_head = body.landmarks[Landmark::kHead] >= 0;
  const Landmark skull = has_head ? Landmark::kHead : Landmark::kNeck;
  set(BodyJoint::kHead, skull);
  if (body.landmarks[Landmark::kVertex] >= 0) {
    points[IndexOf(BodyJoint::kHead)] =
        Fixed(body, at, body.landmarks[skull], 0.5 * (place(skull) + place(Landmark::kVertex)));
  }
  const Eigen::Vector3d torso_m =
      0.25 * (place(Landmark::kLeftShoulder) + place(Landmark::kRightShoulder) +
              place(Landmark::kLeftHip) + place(Landmark::kRightHip));
  points[IndexOf(BodyJoint::kTorso)] = Fixed(body, at, body.landmarks[Landmark::kNeck], torso_m);
  return points;
}

Point AboveHead(const Body& body, double above_m) {
  Point point = SkeletonPoints(body)[IndexOf(BodyJoint::kHead)];
  const Kinematics at = InTPose(body);
  point.p_J_m +=
      at.R_WJ[static_cast<std::size_t>(point.joint)].transpose() * Eigen::Vector3d(0, 0, above_m);
  return point;
}

}  // namespace footing::body
