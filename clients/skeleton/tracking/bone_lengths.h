#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "clients/skeleton/tracking/joints.h"

namespace footing::skeleton {

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

}  // namespace footing::skeleton
