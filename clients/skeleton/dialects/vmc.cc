#include "clients/skeleton/dialects/vmc.h"

#include <array>
#include <cmath>
#include <iterator>

namespace footing::skeleton {
namespace {

/// Parents before their children; -1: the root.
struct Bone {
  std::string_view name;
  int parent;
  std::optional<Joint> joint;
};

constexpr Bone kChain[] = {
    {"Hips", -1, std::nullopt},
    {"Spine", 0, std::nullopt},
    {"Chest", 1, Joint::kTorso},
    {"UpperChest", 2, std::nullopt},
    {"Neck", 3, Joint::kNeck},
    {"Head", 4, Joint::kHead},
    {"LeftShoulder", 3, std::nullopt},
    {"LeftUpperArm", 6, Joint::kLeftShoulder},
    {"LeftLowerArm", 7, Joint::kLeftElbow},
    {"LeftHand", 8, Joint::kLeftHand},
    {"RightShoulder", 3, std::nullopt},
    {"RightUpperArm", 10, Joint::kRightShoulder},
    {"RightLowerArm", 11, Joint::kRightElbow},
    {"RightHand", 12, Joint::kRightHand},
    {"LeftUpperLeg", 0, Joint::kLeftHip},
    {"LeftLowerLeg", 14, Joint::kLeftKnee},
    {"LeftFoot", 15, Joint::kLeftFoot},
    {"RightUpperLeg", 0, Joint::kRightHip},
    {"RightLowerLeg", 17, Joint::kRightKnee},
    {"RightFoot", 18, Joint::kRightFoot},
};

/// Seven numbers behind a name: place and quaternion.
std::optional<Eigen::Isometry3d> ToPose(std::span<const osc::Argument> arguments) {
  std::array<double, 7> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    v[i] = std::get<float>(arguments[i + 1]);
    if (!(std::abs(v[i]) < 1e4)) return std::nullopt;
  }
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (std::abs(q.norm() - 1) > 0.1) return std::nullopt;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() << v[0], v[1], v[2];
  return pose;
}

}  // namespace

std::optional<Skeleton> VmcPose::Take(std::string_view address,
                                      std::span<const osc::Argument> arguments,
                                      std::string_view types) {
  bool ended = address == "/VMC/Ext/T";
  std::optional<Skeleton> skeleton;
  if (address == "/VMC/Ext/Bone/Pos" && types == "sfffffff") {
    const auto bone = std::get<std::string_view>(arguments[0]);
    const auto pose = ToPose(arguments);
    ended = bone == kChain[0].name && hips_came_;
    if (ended && complete()) skeleton = Joints();
    if (pose) Set(bone, *pose);
    if (bone == kChain[0].name) hips_came_ = true;
    return skeleton;
  }
  if (address == "/VMC/Ext/Root/Pos" && types.starts_with("sfffffff")) {
    if (const auto pose = ToPose(arguments)) root_ = *pose;
  }
  if (ended && hips_came_ && complete()) skeleton = Joints();
  if (ended) hips_came_ = false;
  return skeleton;
}

void VmcPose::Set(std::string_view bone, const Eigen::Isometry3d& pose) {
  for (std::size_t i = 0; i < std::size(kChain); ++i)
    if (kChain[i].name == bone) bones_[i] = pose;
}

bool VmcPose::complete() const {
  for (const std::size_t needed : {0u, 4u, 7u, 9u, 11u, 13u, 16u, 19u})
    if (!bones_[needed]) return false;
  return true;
}

Skeleton VmcPose::Joints() const {
  Skeleton skeleton;
  std::array<Pose, std::size(kChain)> poses;
  for (std::size_t i = 0; i < std::size(kChain); ++i) {
    const Pose& parent =
        kChain[i].parent < 0 ? root_ : poses[static_cast<std::size_t>(kChain[i].parent)];
    poses[i] = bones_[i] ? parent * *bones_[i] : parent;
    if (!bones_[i] || !kChain[i].joint) continue;
    skeleton[*kChain[i].joint] = {ToCamera(Dialect::kVmc, options_, poses[i].translation()), 1};
  }
  return skeleton;
}

}  // namespace footing::skeleton
