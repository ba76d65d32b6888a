#include "common/body/landmarks.h"

#include <cctype>
#include <cstddef>
#include <string>
#include <vector>

namespace footing::body {
namespace {

enum class Need { kNecessary, kOptional };

struct Names {
  Landmark landmark;
  std::string_view name;
  Need need;
  std::string_view joints;  ///< Known joint names, lower case; the first found wins.
};

// "@" stands for the side, tried in every spelling below. The name before ":" or of a
// MotionBuilder character is dropped before a comparison; end points are "NAME_end".
constexpr Names kMiddle[] = {
    {Landmark::kHips, "hips", Need::kNecessary, "root hips hip pelvis cc_base_hip"},
    {Landmark::kChest, "chest", Need::kOptional,
     "thorax spine3 chest3 spine2 chest2 spine1 chest cc_base_spine02 spine"},
    {Landmark::kNeck, "neck", Need::kNecessary,
     "lowerneck neck neck1 cc_base_necktwist01 neckbase"},
    {Landmark::kHead, "head", Need::kOptional, "upperneck head cc_base_head"},
    {Landmark::kVertex, "vertex", Need::kOptional,
     "vertex headtop headtop_end head_end cc_base_head_end cc_base_facialbone"},
};
constexpr Names kSides[] = {
    {Landmark::kLeftClavicle, "clavicle", Need::kOptional,
     "@clavicle @collar cc_base_@_clavicle @shoulder"},
    {Landmark::kLeftShoulder, "shoulder", Need::kNecessary,
     "@humerus @arm @uparm @upperarm cc_base_@_upperarm @shoulder"},
    {Landmark::kLeftElbow, "elbow", Need::kNecessary,
     "@radius @forearm @lowarm @elbow @lowerarm cc_base_@_forearm"},
    {Landmark::kLeftWrist, "wrist", Need::kNecessary, "@hand @wrist cc_base_@_hand"},
    {Landmark::kLeftHandEnd, "hand_end", Need::kOptional,
     "@fingers_end @hand_end @fingers @handindex1 @handmiddle1 @fingerbase @wrist_end "
     "cc_base_@_mid1"},
    {Landmark::kLeftHip, "hip", Need::kNecessary, "@femur @upleg @thigh @hip cc_base_@_thigh"},
    {Landmark::kLeftKnee, "knee", Need::kNecessary,
     "@tibia @leg @lowleg @shin @knee cc_base_@_calf"},
    {Landmark::kLeftAnkle, "ankle", Need::kNecessary, "@foot @ankle cc_base_@_foot"},
    {Landmark::kLeftToe, "toe", Need::kOptional, "@toes @toebase @toe cc_base_@_toebase"},
    {Landmark::kLeftToeEnd, "toe_end", Need::kOptional,
     "@toes_end @toebase_end @toe_end @foot_end cc_base_@_midtoe1"},
};
constexpr int kRightLessLeft =
    static_cast<int>(Landmark::kRightClavicle) - static_cast<int>(Landmark::kLeftClavicle);

std::string Plain(std::string_view name) {
  const auto colon = name.rfind(':');
  if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
  std::string plain;
  for (const char c : name) {
    plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (plain.rfind("character", 0) == 0) {
    const auto line = plain.find('_');
    if (line != std::string::npos) plain.erase(0, line + 1);
  }
  return plain;
}

/// The first joint that has one of the names, or -1.
int Find(const std::vector<std::string>& joints, std::string_view names, std::string_view side) {
  while (!names.empty()) {
    const auto end = names.find(' ');
    std::string name(names.substr(0, end));
    names.remove_prefix(end == std::string_view::npos ? names.size() : end + 1);
    const auto at = name.find('@');
    if (at != std::string::npos) name.replace(at, 1, side);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joints[i] == name) return static_cast<int>(i);
    }
  }
  return -1;
}

std::string JointList(const Skeleton& skeleton) {
  std::string list;
  for (int i = 0; i < skeleton.size(); ++i) {
    if (i == 40) return list + ", ...";
    list += (i == 0 ? "" : ", ") + skeleton.joint(i).name;
  }
  return list;
}

}  // namespace

std::string_view LandmarkName(Landmark landmark) {
  constexpr std::array<std::string_view, kLandmarkCount> kNames = {
      "hips",           "chest",          "neck",        "head",        "vertex",
      "left_clavicle",  "left_shoulder",  "left_elbow",  "left_wrist",  "left_hand_end",
      "left_hip",       "left_knee",      "left_ankle",  "left_toe",    "left_toe_end",
      "right_clavicle", "right_shoulder", "right_elbow", "right_wrist", "right_hand_end",
      "right_hip",      "right_knee",     "right_ankle", "right_toe",   "right_toe_end"};
  return kNames[static_cast<std::size_t>(landmark)];
}

Result<Landmarks> FindLandmarks(const Skeleton& skeleton) {
  std::vector<std::string> joints;
  for (const Joint& joint : skeleton.joints) joints.push_back(Plain(joint.name));
  Landmarks found;
  found.joint.fill(-1);
  const auto set = [&](Landmark landmark, Need need, int joint) -> Result<void> {
    found.joint[static_cast<std::size_t>(landmark)] = joint;
    if (joint >= 0 || need == Need::kOptional) return {};
    return InvalidData("the skeleton has no joint known as " + std::string(LandmarkName(landmark)) +
                       "; its joints are " + JointList(skeleton));
  };
  for (const Names& names : kMiddle) {
    const auto done = set(names.landmark, names.need, Find(joints, names.joints, ""));
    if (!done) return done.error();
  }
  for (int right = 0; right < 2; ++right) {
    for (const Names& names : kSides) {
      const auto landmark =
          static_cast<Landmark>(static_cast<int>(names.landmark) + right * kRightLessLeft);
      int joint = -1;
      for (const std::string_view side :
           right != 0 ? std::array<std::string_view, 4>{"right", "r", "right_", "r_"}
                      : std::array<std::string_view, 4>{"left", "l", "left_", "l_"}) {
        joint = Find(joints, names.joints, side);
        if (joint >= 0) break;
      }
      const auto done = set(landmark, names.need, joint);
      if (!done) return done.error();
    }
  }
  return found;
}

Landmark Mirrored(Landmark landmark) {
  const int index = static_cast<int>(landmark);
  if (landmark < Landmark::kLeftClavicle) return landmark;
  return static_cast<Landmark>(landmark < Landmark::kRightClavicle ? index + kRightLessLeft
                                                                   : index - kRightLessLeft);
}

}  // namespace footing::body
