#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "clients/skeleton/tracking/joint_set.h"
#include "common/base/osc.h"

/// OSC dialects of programs that send skeletons (docs/skeleton.md has each in bytes). Read from the
/// sources of Sensebloom/OSCeleton, Zillode/OSCeleton-OpenNI, Zillode/OSCeleton-KinectSDK2,
/// scazan/AIam (tracking/nite2), microcosm/KinectV2-OSC and adenprince/azure-kinect-osc; the
/// Virtual Motion Capture protocol from its specification.
namespace footing::skeleton {

/// Dialect of a sender, with the addresses and type tags of its messages.
enum class Dialect : std::uint8_t {
  kSensebloom,  ///< /joint ,sifff
  kQuartz,      ///< /joint/NAME/USER ,fff
  kZillode,     ///< /joint ,siiffffd
  kKinectSdk2,  ///< /osceleton2/joint ,siiffffd, one a packet
  kFooting,     ///< /footing/skeleton and /footing/joint
  kVmc,         ///< /VMC/Ext/Bone/Pos
  kNite2,       ///< /joint ,isfffffffff
  kKinectV2,    ///< /bodies/USER/joints/NAME ,fffs, one a packet
  kAzure,       ///< /bodies/USER/joints/NUMBER ,fff or ,fffffff, one a packet
};
inline constexpr std::size_t kDialects = 9;

/// Name of a dialect on the command line, and the dialect of a name.
std::string_view NameOf(Dialect dialect);
std::optional<Dialect> DialectOf(std::string_view name);

/// Unit of a dialect's three coordinates.
enum class Units : std::uint8_t {
  kOfDialect,  ///< Normalised for kSensebloom and kQuartz, metres for kFooting, kVmc and kKinectV2,
               ///< else mm.
  kNormalised,  ///< OSCeleton's: x = (1280 - X)/2560, y = (960 - Y)/1920, z = Z/1280, in mm.
  kMillimetres,
  kCentimetres,
  kMetres,
};

/// Name of a unit on the command line, and the unit of a name.
std::string_view NameOf(Units units);
std::optional<Units> UnitsOf(std::string_view name);

/// Settings with which a sender was started; OSCeleton's -mx, -my, -mz and -ox, -oy, -oz.
struct DialectOptions {
  Units units = Units::kOfDialect;
  Eigen::Vector3d factor = Eigen::Vector3d::Ones();  ///< Not 0.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  bool flip_y = false;    ///< The sender's y points the other way than its dialect's.
  bool mirrored = false;  ///< The sender shows a mirror image: negate x, swap left and right.
  /// The sender swaps the names of left and right. With `mirrored` only x is negated.
  bool swap_sides = false;
};

/// A sender's skeleton with its sides put right, and back.
Skeleton WithSides(const DialectOptions& options, const Skeleton& skeleton);

/// A dialect's numbers to metres in K, and back.
Eigen::Vector3d ToCamera(Dialect dialect, const DialectOptions& options,
                         const Eigen::Vector3d& numbers);
Eigen::Vector3d FromCamera(Dialect dialect, const DialectOptions& options,
                           const Eigen::Vector3d& p_K_m);

/// A skeleton as the packets that a sender of the dialect would send. What the dialect cannot say
/// is lost: confidences below 0.5 (kSensebloom, kQuartz) or 0.1 (kZillode) leave a joint out,
/// kKinectSdk2 knows 1, 0.5 and 0.1, and only it, kZillode and kFooting have a time. The dialects
/// from kVmc on are not written: nothing.
std::vector<std::string> Encode(Dialect dialect, const DialectOptions& options,
                                const Skeleton& skeleton);

/// Outcome of one VMC message.
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
