#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "clients/skeleton/tracking/dialects.h"
#include "clients/skeleton/tracking/osc.h"

namespace footing::skeleton {

/// What one VMC message did.
struct VmcStep {
  enum class Taken : std::uint8_t {
    kTaken,    ///< Used, or nothing that is needed.
    kTypes,    ///< A bone with other types than ,sfffffff.
    kName,     ///< No bone of Unity's humanoid.
    kNumbers,  ///< A bone with numbers that are not finite, or a rotation that is none.
  };
  Taken taken = Taken::kTaken;
  std::string_view bone = {};  ///< As sent, with kName and kNumbers.
  std::optional<Skeleton> skeleton = {};
};

/// The bones of a VMC sender (protocol.vmc.info), each where its parent has it, and the joints that
/// follow from them. Bones are those of Unity's humanoid; one that is not sent is left out of the
/// chain. A plain value.
class VmcPose {
 public:
  explicit VmcPose(const DialectOptions& options) : options_(options) {}

  /// One message below /VMC/Ext/: Root/Pos and Bone/Pos (name, x, y, z, qx, qy, qz, qw in the
  /// parent's frame, in Unity's axes) change the pose; T, the sender's time, ends a frame, as the
  /// next Hips do where a sender has no T. The joints when a frame has ended, with hips, upper arms
  /// and upper legs known. A bone whose numbers make no sense is absent until it comes again, and
  /// so are the joints that hang on it; neck and torso are computed where they are absent.
  VmcStep Take(std::string_view address, std::span<const osc::Argument> arguments,
               std::string_view types);
  /// Why the last frames made no skeleton; empty while they do, and before it is certain.
  std::string NoSkeleton() const;

 private:
  static constexpr std::size_t kBones = 22;
  using Pose = Eigen::Isometry3d;
  struct BoneState {
    std::optional<Pose> pose;
    bool wrong = false;  // Its last numbers made no sense.
  };

  VmcStep TakeBone(std::span<const osc::Argument> arguments, std::string_view types);
  std::optional<Skeleton> End();
  void Arrived(std::string_view bone);
  bool Known(std::size_t bone) const;
  Skeleton Joints() const;

  DialectOptions options_;
  Pose root_ = Pose::Identity();
  std::array<BoneState, kBones> bones_;
  bool hips_came_ = false;            // Since the last frame.
  std::size_t since_end_ = 0;         // Bones.
  std::size_t incomplete_ = 0;        // Frames without a skeleton.
  std::vector<std::string> arrived_;  // The first few names of bones.
  std::string wrong_types_;
};

}  // namespace footing::skeleton
