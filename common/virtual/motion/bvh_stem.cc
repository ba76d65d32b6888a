#include "common/virtual/motion/bvh_stem.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace footing::motion {
namespace {

using body::Axis;
using body::Joint;

/// The joints from `top` on, with `top` as the root.
body::Skeleton From(const body::Skeleton& skeleton, int top) {
  std::vector<Joint> joints(skeleton.joints.begin() + top, skeleton.joints.end());
  for (Joint& joint : joints) joint.parent -= top;
  Joint& root = joints.front();
  root.parent = -1;
  root.offset_m.setZero();
  if (root.rotations.size() < 3) {
    root.rotations.clear();
    for (const Axis axis : {Axis::kZ, Axis::kX, Axis::kY}) {
      root.rotations.push_back({axis, -body::kUnlimited, body::kUnlimited});
    }
  }
  return body::MakeSkeleton(std::move(joints));
}

}  // namespace

int StemLength(const body::Skeleton& skeleton) {
  std::vector<int> children(skeleton.joints.size(), 0);
  for (const Joint& joint : skeleton.joints) {
    if (joint.parent >= 0) ++children[static_cast<std::size_t>(joint.parent)];
  }
  const auto branch =
      std::find_if(children.begin(), children.end(), [](int count) { return count != 1; });
  return branch == children.end() || *branch == 0 ? 0 : static_cast<int>(branch - children.begin());
}

Motion OnMovingJoint(Motion motion, const Eigen::MatrixXd& stem_m, double still_m) {
  int top = static_cast<int>(stem_m.rows() / 3);
  while (top > 0) {
    const auto places = stem_m.middleRows<3>(3 * (top - 1));
    if (((places.colwise() - places.col(0)).array().abs() > still_m).any()) break;
    motion.skeleton.joints[static_cast<std::size_t>(top)].offset_m = places.col(0);
    --top;
  }
  if (top == 0) return motion;
  const body::Skeleton& from = motion.skeleton;
  Motion out{From(from, top), motion.rate_hz, motion.start_s, {}};
  out.q.resize(out.skeleton.dof, motion.frames());
  const Joint& root = out.skeleton.joint(0);
  const auto behind_root = static_cast<Eigen::Index>(3 + root.rotations.size());
  const Eigen::Index rest = out.skeleton.dof - behind_root;
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const Eigen::VectorXd q = motion.q.col(frame);
    Eigen::Vector3d place_m = q.head<3>();
    Eigen::Matrix3d turn = JointRotation(from.joint(0), q);
    for (int i = 1; i <= top; ++i) {
      place_m += turn * stem_m.col(frame).segment<3>(3 * (i - 1));
      turn *= JointRotation(from.joint(i), q);
    }
    Eigen::VectorXd to = Eigen::VectorXd::Zero(out.skeleton.dof);
    if (frame > 0) to = out.q.col(frame - 1);  // The nearest angles.
    to.head<3>() = place_m;
    SetJointRotation(root, turn, to);
    to.tail(rest) = q.tail(rest);
    out.q.col(frame) = to;
  }
  return out;
}

}  // namespace footing::motion
