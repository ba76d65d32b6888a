#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/virtual/motion/edit.h"

namespace footing::motion {
namespace {

using body::Joint;
using body::Landmark;

/// `name` with its first `from` replaced, where it has one.
std::optional<std::string> Replaced(const std::string& name, std::string_view from,
                                    std::string_view to) {
  const auto at = name.find(from);
  if (at == std::string::npos) return std::nullopt;
  std::string replaced = name;
  return replaced.replace(at, from.size(), to);
}

/// The joint of the other side by its name, or the joint itself.
int Partner(const body::Skeleton& skeleton, int index) {
  constexpr std::pair<std::string_view, std::string_view> kSides[] = {
      {"Left", "Right"}, {"left", "right"}, {"LEFT", "RIGHT"}, {"_L_", "_R_"},
      {"_l_", "_r_"},    {".L", ".R"},      {".l", ".r"},
  };
  const std::string& name = skeleton.joint(index).name;
  const auto there = [&](const std::optional<std::string>& other) {
    return other ? body::FindJoint(skeleton, *other) : -1;
  };
  for (const auto& [left, right] : kSides) {
    for (const auto& other : {Replaced(name, left, right), Replaced(name, right, left)}) {
      if (const int found = there(other); found >= 0) return found;
    }
  }
  for (const auto& [a, b] : {std::pair{'l', 'r'}, {'r', 'l'}, {'L', 'R'}, {'R', 'L'}}) {
    if (name.empty() || name[0] != a) continue;
    if (const int found = there(b + name.substr(1)); found >= 0) return found;
  }
  return index;
}

Eigen::Matrix3d Mirror() { return Eigen::Vector3d(1, -1, 1).asDiagonal(); }

}  // namespace

Motion Mirrored(const Motion& motion) {
  const Eigen::Matrix3d S = Mirror();
  std::vector<int> partner;
  std::vector<Joint> joints = motion.skeleton.joints;
  for (int i = 0; i < motion.skeleton.size(); ++i) {
    partner.push_back(Partner(motion.skeleton, i));
    joints[static_cast<std::size_t>(i)].offset_m =
        S * motion.skeleton.joint(partner.back()).offset_m;
  }
  Motion out{body::MakeSkeleton(std::move(joints)), motion.rate_hz, motion.start_s, motion.q};
  Eigen::VectorXd q = Eigen::VectorXd::Zero(motion.skeleton.dof);
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const Eigen::VectorXd from = motion.q.col(frame);
    q.head<3>() = S * from.head<3>();
    for (int i = 0; i < motion.skeleton.size(); ++i) {
      const Joint& other = motion.skeleton.joint(partner[static_cast<std::size_t>(i)]);
      SetJointRotation(out.skeleton.joint(i), S * JointRotation(other, from) * S, q);
    }
    out.q.col(frame) = q;
  }
  return out;
}

Result<Motion> WithLandmarksOnly(const Motion& motion) {
  const auto landmarks = body::FindLandmarks(motion.skeleton);
  if (!landmarks) return landmarks.error();
  const body::Skeleton& from = motion.skeleton;
  std::vector<bool> keep(from.joints.size(), false);
  for (int i = 0; i < body::kLandmarkCount; ++i) {
    const auto landmark = static_cast<Landmark>(i);
    if (landmark == Landmark::kLeftHandEnd || landmark == Landmark::kRightHandEnd) continue;
    for (int joint = (*landmarks)[landmark]; joint >= 0; joint = from.joint(joint).parent) {
      keep[static_cast<std::size_t>(joint)] = true;
    }
  }
  // Where each kept joint goes, and which of the dropped ones ends a wrist.
  std::vector<Joint> joints;
  std::vector<int> place(from.joints.size(), -1), sources;
  const auto add = [&](int index) {
    Joint joint = from.joint(index);
    joint.parent = index == 0 ? -1 : place[static_cast<std::size_t>(joint.parent)];
    place[static_cast<std::size_t>(index)] = static_cast<int>(joints.size());
    sources.push_back(index);
    joints.push_back(std::move(joint));
  };
  for (int i = 0; i < from.size(); ++i) {
    if (!keep[static_cast<std::size_t>(i)]) continue;
    add(i);
    for (const auto& [wrist, end] : {std::pair{Landmark::kLeftWrist, Landmark::kLeftHandEnd},
                                     {Landmark::kRightWrist, Landmark::kRightHandEnd}}) {
      if (i != (*landmarks)[wrist]) continue;
      int child = (*landmarks)[end];
      while (child >= 0 && from.joint(child).parent != i) child = from.joint(child).parent;
      for (int k = i + 1; child < 0 && k < from.size(); ++k) {
        if (from.joint(k).parent == i) child = k;
      }
      if (child < 0) continue;
      Joint tip;
      tip.name = from.joint(i).name + "_end";
      tip.parent = place[static_cast<std::size_t>(i)];
      tip.offset_m = from.joint(child).offset_m;
      joints.push_back(std::move(tip));
      sources.push_back(-1);
    }
  }
  Motion out{body::MakeSkeleton(std::move(joints)), motion.rate_hz, motion.start_s, {}};
  out.q.resize(out.skeleton.dof, motion.frames());
  out.q.topRows<3>() = motion.q.topRows<3>();
  for (int i = 0; i < out.skeleton.size(); ++i) {
    const Joint& joint = out.skeleton.joint(i);
    const auto rows = static_cast<Eigen::Index>(joint.rotations.size());
    if (rows == 0) continue;
    out.q.middleRows(joint.first_dof, rows) =
        motion.q.middleRows(from.joint(sources[static_cast<std::size_t>(i)]).first_dof, rows);
  }
  return out;
}

}  // namespace footing::motion
