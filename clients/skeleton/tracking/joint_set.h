#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include <Eigen/Core>

/// A person's skeleton as a camera sees it, in the 15 joints of OpenNI.
namespace footing::skeleton {

/// The joints that NiTE fills, in its order. A hand is the middle of the fist, a foot the ankle.
enum class Joint : std::uint8_t {
  kHead,
  kNeck,
  kLeftShoulder,
  kRightShoulder,
  kLeftElbow,
  kRightElbow,
  kLeftHand,
  kRightHand,
  kTorso,
  kLeftHip,
  kRightHip,
  kLeftKnee,
  kRightKnee,
  kLeftFoot,
  kRightFoot,
};
inline constexpr std::size_t kJoints = 15;

/// Index of a joint in arrays of all joints.
constexpr std::size_t Index(Joint joint) { return static_cast<std::size_t>(joint); }

/// Names of the joints in OSCeleton: "head", "l_shoulder", ...
inline constexpr std::array<std::string_view, kJoints> kJointNames = {
    "head",  "neck",  "l_shoulder", "r_shoulder", "l_elbow", "r_elbow", "l_hand", "r_hand",
    "torso", "l_hip", "r_hip",      "l_knee",     "r_knee",  "l_foot",  "r_foot"};

/// The joint on the other side of the body; itself for those in the middle.
Joint Mirrored(Joint joint);

/// Position of a joint in the camera's frame K: x to the camera's left, y up, z away from it, right
/// handed, metres. A person who faces the camera has the left hand at negative x.
struct JointReading {
  Eigen::Vector3d p_K_m = Eigen::Vector3d::Zero();
  double confidence = 0;  ///< 0 to 1; 0: the joint is absent. 1 tracked, 0.5 inferred, as NiTE.

  bool present() const { return confidence > 0; }
};

/// One exposure of one person.
struct Skeleton {
  std::int32_t user = 0;
  std::array<JointReading, kJoints> joints;
  std::optional<std::int64_t> sequence;
  std::optional<std::int64_t> sent_ns;  ///< The sender's own time of the exposure.
  bool unix_time = false;               ///< sent_ns counts from 1970, not from the sender's start.
  /// Sum of both vectors from ankle to toes, K, where the sender has toes.
  std::optional<Eigen::Vector3d> toes_K_m;

  JointReading& operator[](Joint joint) { return joints[Index(joint)]; }
  const JointReading& operator[](Joint joint) const { return joints[Index(joint)]; }
  std::size_t present() const;
};

/// Left called right, and right left.
Skeleton SwappedSides(const Skeleton& skeleton);
/// The skeleton in a mirror: x negated, left and right swapped.
Skeleton MirrorImage(const Skeleton& skeleton);

/// Computes an absent neck (between the shoulders) and torso (between shoulders and hips).
void FillTrunk(Skeleton& skeleton);

/// The 15 joints out of any set of named ones: OSCeleton ("l_hand"), Kinect ("HandLeft"), Azure
/// Kinect ("HAND_LEFT"), MediaPipe ("left_wrist"), OpenNI ("LEFT_HAND"). Case, '_', '-' and spaces
/// do not matter. Of two names for one joint the better one counts whatever their order: an ankle
/// before the tip of a foot, a hand before a wrist. Joints that no name gives are taken from their
/// neighbours: a neck between the shoulders, a torso between shoulders and hips, a head between the
/// ears.
class JointSet {
 public:
  /// Outcome of Add for a name.
  enum class Taken : std::uint8_t {
    kUnknown,  ///< No name of a joint.
    kBeside,   ///< Names a joint outside the 15, or one that a better name has given.
    kAdded,
    kRepeated,  ///< The same name was added before: nothing is changed.
  };

  Taken Add(std::string_view name, const JointReading& reading);
  /// Skeleton with the joints that follow from their neighbours.
  Skeleton Finish() const;
  /// How many of the 15 have been given by their best name.
  std::size_t best() const;
  /// How many names have given something.
  std::size_t size() const { return added_; }
  bool empty() const { return added_ == 0; }

 private:
  struct Given {
    JointReading reading;
    int rank = kNone;
  };
  static constexpr int kNone = 100;

  std::array<Given, kJoints> joints_;
  std::array<JointReading, 3> face_;     // Left ear, right ear, nose.
  std::array<std::uint64_t, 2> seen_{};  // A bit for each row of the table of names: left, right.
  std::size_t added_ = 0;
};

}  // namespace footing::skeleton
