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
    {"pelvis_tilt",            11,   39},
    {"pelvis_list",             5,    8},
    {"pelvis_rotation",        10,   24},
    {"hip_flexion",            17,   39},
    {"hip_adduction",           6,   23},
    {"hip_rotation",           13,   22},
    {"knee_angle",             18,   25},
    {"ankle_angle",            10,   19},
    {"lumbar_extension",       16,   40},
    {"lumbar_bending",          5,    8},
    {"lumbar_rotation",         5,    10},
    {"arm_flex",               39,   20},
    {"arm_add",                11,   14},
    {"arm_rot",                67,   79},
    {"elbow_flex",             14,   35},
};
constexpr AngleDeviation kLinks[] = {
    // link               upright  bent, degrees
    {"pelvis",                 14,   40},
    {"chest",                  14,   21},
    {"head",                   19,   33},
    {"upper_arm",              39,   88},
    {"forearm",                39,   87},
    {"hand",                   45,   74},
    {"thigh",                  18,   35},
    {"shank",                  18,   32},
    {"foot",                   20,   28},
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
