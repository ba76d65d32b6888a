#include "common/body/angle_deviation.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "common/body/landmarks.h"
#include "common/body/skeleton.h"

namespace footing::body {
namespace {

// clang-format off
constexpr AngleDeviation kCoordinates[] = {
    // coordinate         upright  bent, degrees
    {"pelvis_tilt",             9,   27},
    {"pelvis_list",             5,    8},
    {"pelvis_rotation",        19,   28},
    {"hip_flexion",            18,   28},
    {"hip_adduction",           6,   24},
    {"hip_rotation",           13,   23},
    {"knee_angle",             14,   27},
    {"ankle_angle",            10,   18},
    {"lumbar_extension",       12,   26},
    {"lumbar_bending",          7,    9},
    {"lumbar_rotation",         6,    11},
    {"arm_flex",               48,   27},
    {"arm_add",                11,   14},
    {"arm_rot",                64,   80},
    {"elbow_flex",             14,   34},
};
constexpr AngleDeviation kLinks[] = {
    // link               upright  bent, degrees
    {"pelvis",                 20,   30},
    {"chest",                  18,   24},
    {"head",                   24,   36},
    {"upper_arm",              45,   87},
    {"forearm",                45,   86},
    {"hand",                   35,   57},
    {"thigh",                  21,   36},
    {"shank",                  21,   33},
    {"foot",                   23,   29},
};
// clang-format on

enum Link : std::size_t {
  kPelvis,
  kChestLink,
  kHeadLink,
  kUpperArm,
  kForearm,
  kHand,
  kThigh,
  kShank,
  kFoot
};

/// The joints at which each kind of link begins.
constexpr std::pair<Landmark, Link> kBegins[] = {{Landmark::kHips, kPelvis},
                                                 {Landmark::kChest, kChestLink},
                                                 {Landmark::kNeck, kHeadLink},
                                                 {Landmark::kHead, kHeadLink},
                                                 {Landmark::kLeftClavicle, kChestLink},
                                                 {Landmark::kLeftShoulder, kUpperArm},
                                                 {Landmark::kLeftElbow, kForearm},
                                                 {Landmark::kLeftWrist, kHand},
                                                 {Landmark::kLeftHip, kThigh},
                                                 {Landmark::kLeftKnee, kShank},
                                                 {Landmark::kLeftAnkle, kFoot}};

}  // namespace

std::string_view AngleDeviationSource() {
  return "standard deviations as measured against motion capture of people who trained no model, "
         "with hands tracked and two boards; bent: knees reported as bent by 30 degrees or more; "
         "docs/pose-live.md, Angles";
}

std::span<const AngleDeviation> CoordinateDeviations() { return kCoordinates; }

std::optional<AngleDeviation> CoordinateDeviation(std::string_view column) {
  if (column.ends_with("_l") || column.ends_with("_r")) column.remove_suffix(2);
  for (const AngleDeviation& one : kCoordinates) {
    if (one.name == column) return one;
  }
  return std::nullopt;
}

std::optional<std::size_t> StatedAngle(std::string_view column) {
  const auto found = std::find(kStatedAngles.begin(), kStatedAngles.end(), column);
  if (found == kStatedAngles.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kStatedAngles.begin());
}

std::span<const AngleDeviation> LinkDeviations() { return kLinks; }

std::vector<AngleDeviation> DeviationsOfLinks(std::span<const std::string> names,
                                              std::span<const int> parents) {
  if (names.empty() || names.size() != parents.size() || parents[0] != -1) return {};
  std::vector<Joint> joints(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0 && (parents[i] < 0 || parents[i] >= static_cast<int>(i))) return {};
    joints[i].name = names[i];
    joints[i].parent = parents[i];
  }
  const auto landmarks = FindLandmarks(MakeSkeleton(std::move(joints)));
  if (!landmarks) return {};
  std::vector<std::optional<Link>> begins(names.size());
  for (const auto& [left, link] : kBegins) {
    for (const Landmark landmark : {left, Mirrored(left)}) {
      const int joint = (*landmarks)[landmark];
      if (joint >= 0) begins[static_cast<std::size_t>(joint)] = link;
    }
  }
  std::vector<AngleDeviation> deviations(names.size(), kLinks[kPelvis]);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (begins[i]) {
      deviations[i] = kLinks[*begins[i]];
    } else if (i > 0) {
      deviations[i] = deviations[static_cast<std::size_t>(parents[i])];
    }
  }
  return deviations;
}

}  // namespace footing::body
