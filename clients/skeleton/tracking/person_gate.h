#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "clients/skeleton/tracking/joint_set.h"

namespace footing::skeleton {

/// A bone between two joints.
struct Bone {
  Joint near;
  Joint far;  ///< The one farther from the trunk.
  bool limb;  ///< An upper arm, forearm, thigh or shank.
};
inline constexpr std::size_t kBones = 14;
inline constexpr std::array<Bone, kBones> kBoneList = {{
    {Joint::kNeck, Joint::kHead, false},
    {Joint::kNeck, Joint::kTorso, false},
    {Joint::kNeck, Joint::kLeftShoulder, false},
    {Joint::kNeck, Joint::kRightShoulder, false},
    {Joint::kLeftShoulder, Joint::kLeftElbow, true},
    {Joint::kRightShoulder, Joint::kRightElbow, true},
    {Joint::kLeftElbow, Joint::kLeftHand, true},
    {Joint::kRightElbow, Joint::kRightHand, true},
    {Joint::kTorso, Joint::kLeftHip, false},
    {Joint::kTorso, Joint::kRightHip, false},
    {Joint::kLeftHip, Joint::kLeftKnee, true},
    {Joint::kRightHip, Joint::kRightKnee, true},
    {Joint::kLeftKnee, Joint::kLeftFoot, true},
    {Joint::kRightKnee, Joint::kRightFoot, true},
}};

/// Each bone's median length over the last frames in which both ends were tracked.
class BoneLengths {
 public:
  static constexpr std::size_t kWindow = 151;  ///< 5 s at 30 Hz.
  static constexpr std::size_t kLeast = 15;    ///< Lengths before there is a median.

  void Add(std::size_t bone, double length_m);
  /// None before kLeast lengths.
  std::optional<double> Median(std::size_t bone) const;
  /// The mean of the limbs' medians; none before one has it.
  std::optional<double> Limb() const;

 private:
  struct History {
    std::array<float, kWindow> lengths_m{};
    std::size_t count = 0;  // Ever.
    double median_m = 0;
  };
  std::array<History, kBones> histories_;
};

/// Fault common to all joints of one person's skeleton.
enum class Fault : std::uint8_t {
  kNone,
  kMillimetres,  ///< The bones are a thousand times too long.
  kCentimetres,
  kNormalised,  ///< They are as short as in normalised image coordinates.
  kShort,       ///< They are half as long as a person's, and the head is above.
  kScale,       ///< They are too long or too short, and no unit explains it.
  kUpsideDown,  ///< The head is below the hips.
  kSwapped,     ///< Knees and hands are behind the body, where the camera is: sides are swapped.
  kTurned,      ///< They are behind it and away from the camera, which sees the back as a front.
};

/// One line for a person: what is seen and what to do. Empty for kNone.
std::string Advice(Fault fault);

/// Why a joint of a frame does not count.
enum class Verdict : std::uint8_t { kTaken, kAbsent, kBone, kSpeed, kFault };

/// A frame after the gate; joints that do not count are absent.
struct Gated {
  Skeleton skeleton;
  std::array<Verdict, kJoints> verdicts{};
  Fault fault = Fault::kNone;
  std::size_t inferred = 0;  ///< Joints taken with a confidence below kTrackedFrom.
};

/// Plausibility filter for one person's skeletons. Joints are dropped when a bone is more than a
/// quarter off the person's own running median (2.5 to 8 % of Kinect frames have such a bone), or
/// when they moved faster than 6 m/s, unless they stay there. Whole skeletons are dropped while
/// their scale or their up is wrong, or while left and right do not fit knees and hands. A plain
/// value.
class PersonGate {
 public:
  static constexpr double kBoneTolerance = 0.25;
  static constexpr double kFastestMps = 6;
  static constexpr double kNoiseM = 0.06;       ///< Between two frames: 3 sd of 15 mm twice.
  static constexpr int kMostRejected = 5;       ///< After that many a joint has moved indeed.
  static constexpr double kTrackedFrom = 0.75;  ///< Confidence; below it a joint is inferred.
  static constexpr double kUsedFrom = 0.25;     ///< Below it a joint is not tracked.

  /// `time_ns`: of the exposure.
  Gated Advance(const Skeleton& skeleton, std::int64_t time_ns);

 private:
  struct Last {
    Eigen::Vector3d p_K_m = Eigen::Vector3d::Zero();
    std::int64_t time_ns = 0;
    int rejected = 0;
    bool known = false;
  };

  Fault FaultOf(const Skeleton& skeleton);
  void DropBones(Gated& gated) const;
  void DropFast(Gated& gated, std::int64_t time_ns);

  BoneLengths lengths_;
  std::array<Last, kJoints> last_;
  double up_ = 1;       // Running mean of the trunk's upward part, -1 to 1.
  double front_m_ = 0;  // Running mean of how far knees and hands lie in front.
  double away_ = 0;     // Running mean of the part of "ahead" that points away from the camera.
  double weight_ = 0;   // Weight of these means, frames.
};

}  // namespace footing::skeleton
