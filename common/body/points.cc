#include "common/body/points.h"

namespace footing::body {
namespace {

constexpr double kFistShare = 0.6;

int Of(const Body& body, int side, Landmark left) {
  return body.landmarks[side == 0 ? left : Mirrored(left)];
}

/// Offset of `below` from its ancestor `joint`, with the joints between them at rest.
Eigen::Vector3d OffsetFrom(const Skeleton& skeleton, int joint, int below) {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  for (int at = below; at >= 0 && at != joint; at = skeleton.joint(at).parent) {
    offset += skeleton.joint(at).offset_m;
  }
  return offset;
}

/// The end point that hangs on a joint; -1 where there is none.
int EndOf(const Skeleton& skeleton, int joint) {
  for (int i = joint + 1; i < skeleton.size(); ++i) {
    if (skeleton.joint(i).parent == joint && IsEnd(skeleton, i)) return i;
  }
  return -1;
}

}  // namespace

Point Fist(const Body& body, int side) {
  Point fist;
  fist.joint = Of(body, side, Landmark::kLeftWrist);
  int end = Of(body, side, Landmark::kLeftHandEnd);
  if (end < 0) end = EndOf(body.skeleton, fist.joint);
  if (end >= 0) fist.p_J_m = kFistShare * OffsetFrom(body.skeleton, fist.joint, end);
  return fist;
}

Point Ankle(const Body& body, int side) {
  return {Of(body, side, Landmark::kLeftAnkle), {0, 0, 0}};
}

Point Toe(const Body& body, int side) {
  for (const Landmark landmark : {Landmark::kLeftToe, Landmark::kLeftToeEnd}) {
    const int joint = Of(body, side, landmark);
    if (joint >= 0) return {joint, {0, 0, 0}};
  }
  return Ankle(body, side);
}

Point ToeEnd(const Body& body, int side) {
  const int joint = Of(body, side, Landmark::kLeftToeEnd);
  return joint >= 0 ? Point{joint, {0, 0, 0}} : Toe(body, side);
}

}  // namespace footing::body
