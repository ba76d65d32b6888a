#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "clients/skeleton/dialects/dialects.h"
#include "clients/skeleton/osc/osc.h"

namespace footing::skeleton {

/// The bones of a VMC sender (protocol.vmc.info), each where its parent has it, and the joints that
/// follow from them. Bones are those of Unity's humanoid; one that is not sent is left out of the
/// chain. A plain value.
class VmcPose {
 public:
  explicit VmcPose(const DialectOptions& options) : options_(options) {}

  /// One message below /VMC/Ext/: Root/Pos and Bone/Pos (name, x, y, z, qx, qy, qz, qw in the
  /// parent's frame, in Unity's axes) change the pose; T, the sender's time, ends a frame, as the
  /// next Hips do where a sender has no T. The joints when a frame has ended and all of arms, legs
  /// and head are known. Numbers that are not finite and rotations that are none change nothing.
  std::optional<Skeleton> Take(std::string_view address, std::span<const osc::Argument> arguments,
                               std::string_view types);

 private:
  void Set(std::string_view bone, const Eigen::Isometry3d& pose);
  bool complete() const;
  Skeleton Joints() const;

  static constexpr std::size_t kBones = 20;
  using Pose = Eigen::Isometry3d;

  DialectOptions options_;
  Pose root_ = Pose::Identity();
  std::array<std::optional<Pose>, kBones> bones_;
  bool hips_came_ = false;  // Since the last frame.
};

}  // namespace footing::skeleton
