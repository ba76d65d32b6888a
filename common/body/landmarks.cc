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

// "@" stands for the side, tried in every spelling below; a side at the end of a name, as in
// "Foot_L", is put first ("l_foot"). The name before ":" or of a MotionBuilder character is dropped
// before a comparison; end points are "NAME_end".
constexpr Names kMiddle[] = {
    {Landmark::kHips, "hips", Need::kNecessary, "hips hip pelvis cc_base_hip root"},
    {Landmark::kChest, "chest", Need::kOptional,
     "thorax upperchest chest4 spine3 chest3 spine2 chest2 spine1 spine_03 chest cc_base_spine02 "
     "spine"},
    {Landmark::kNeck, "neck", Need::kNecessary,
     "lowerneck neck neck1 neck_01 cc_base_necktwist01 neckbase"},
    {Landmark::kHead, "head", Need::kOptional, "upperneck head cc_base_head"},
    {Landmark::kVertex, "vertex", Need::kOptional,
     "vertex headtop headtop_end head_end cc_base_head_end cc_base_facialbone"},
};
constexpr Names kSides[] = {
    {Landmark::kLeftClavicle, "clavicle", Need::kOptional,
     "@clavicle @collar cc_base_@_clavicle @shoulder"},
    {Landmark::kLeftShoulder, "shoulder", Need::kNecessary,
     "@humerus @arm @uparm @upperarm @upper_arm @shldr cc_base_@_upperarm @shoulder"},
    {Landmark::kLeftElbow, "elbow", Need::kNecessary,
     "@radius @forearm @lowarm @elbow @lowerarm @lower_arm cc_base_@_forearm"},
    {Landmark::kLeftWrist, "wrist", Need::kNecessary, "@wrist @hand cc_base_@_hand"},
    {Landmark::kLeftHandEnd, "hand_end", Need::kOptional,
     "@fingers_end @hand_end @fingers @handindex1 @handmiddle1 @fingerbase @wrist_end "
     "cc_base_@_mid1"},
    {Landmark::kLeftHip, "hip", Need::kNecessary,
     "@femur @upleg @thigh @hip @upperleg @upper_leg cc_base_@_thigh"},
    {Landmark::kLeftKnee, "knee", Need::kNecessary,
     "@tibia @leg @lowleg @shin @knee @lowerleg @lower_leg @calf cc_base_@_calf"},
    {Landmark::kLeftAnkle, "ankle", Need::kNecessary, "@ankle @foot cc_base_@_foot"},
    {Landmark::kLeftToe, "toe", Need::kOptional,
     "@toes @toebase @toe @ball @foot cc_base_@_toebase"},
    {Landmark::kLeftToeEnd, "toe_end", Need::kOptional,
     "@toes_end @toebase_end @toe_end @foot_end cc_base_@_midtoe1"},
};
constexpr int kRightLessLeft =
    static_cast<int>(Landmark::kRightClavicle) - static_cast<int>(Landmark::kLeftClavicle);

/// CMU's "wrist" turns the forearm from two thirds of it on; the hand begins at its "hand".
constexpr std::string_view kWristOfCmu = "@hand";

/// The side to the front: "foot_l_end" becomes "l_foot_end".
std::string SideFirst(const std::string& name) {
  constexpr std::string_view kEnd = "_end";
  const bool end = name.ends_with(kEnd);
  const std::string stem = end ? name.substr(0, name.size() - kEnd.size()) : name;
  for (const std::string_view side : {"left", "right", "l", "r"}) {
    for (const char separator : {'_', '.', '-', ' '}) {
      const std::string suffix = separator + std::string(side);
      if (stem.size() <= suffix.size() || !stem.ends_with(suffix)) continue;
      return std::string(side) + "_" + stem.substr(0, stem.size() - suffix.size()) +
             (end ? std::string(kEnd) : "");
    }
  }
  return name;
}

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
  constexpr std::string_view kMixamo = "mixamorig";  // Some exporters drop or replace its colon.
  if (plain.starts_with(kMixamo)) plain.erase(0, kMixamo.size() + plain.starts_with("mixamorig_"));
  return SideFirst(plain);
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

/// The first joint that has one of the names, on that side however it is spelt, or -1.
int FindOnSide(const std::vector<std::string>& joints, std::string_view names, bool right) {
  constexpr std::string_view kSpellings[2][4] = {{"left", "l", "left_", "l_"},
                                                 {"right", "r", "right_", "r_"}};
  for (const std::string_view side : kSpellings[right]) {
    if (const int joint = Find(joints, names, side); joint >= 0) return joint;
  }
  return -1;
}

/// An error where a limb's joints do not hang on each other in their order.
Result<void> CheckOrder(const Skeleton& skeleton, const Landmarks& landmarks) {
  constexpr std::pair<Landmark, Landmark> kLimbs[] = {
      {Landmark::kLeftHip, Landmark::kLeftKnee},
      {Landmark::kLeftKnee, Landmark::kLeftAnkle},
      {Landmark::kLeftShoulder, Landmark::kLeftElbow},
      {Landmark::kLeftElbow, Landmark::kLeftWrist}};
  for (const auto& [upper, lower] : kLimbs) {
    for (const int side : {0, 1}) {
      const Landmark from = OfSide(upper, side), to = OfSide(lower, side);
      int joint = skeleton.joint(landmarks[to]).parent;
      while (joint >= 0 && joint != landmarks[from]) joint = skeleton.joint(joint).parent;
      if (joint >= 0) continue;
      return InvalidData("joint " + skeleton.joint(landmarks[to]).name + ", taken for " +
                         std::string(LandmarkName(to)) + ", does not hang on joint " +
                         skeleton.joint(landmarks[from]).name + ", taken for " +
                         std::string(LandmarkName(from)) + ": rename one of them");
    }
  }
  return {};
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
      int joint = FindOnSide(joints, names.joints, right != 0);
      const bool cmu_arm =
          names.landmark == Landmark::kLeftWrist && FindOnSide(joints, "@radius", right != 0) >= 0;
      if (cmu_arm) joint = FindOnSide(joints, kWristOfCmu, right != 0);
      // "Foot" is the ankle, or what hangs on it.
      const Landmark ankle = OfSide(Landmark::kLeftAnkle, right);
      if (names.landmark == Landmark::kLeftToe && joint == found[ankle]) joint = -1;
      const auto done = set(landmark, names.need, joint);
      if (!done) return done.error();
    }
  }
  if (const auto ordered = CheckOrder(skeleton, found); !ordered) return ordered.error();
  return found;
}

Landmark Mirrored(Landmark landmark) {
  const int index = static_cast<int>(landmark);
  if (landmark < Landmark::kLeftClavicle) return landmark;
  return static_cast<Landmark>(landmark < Landmark::kRightClavicle ? index + kRightLessLeft
                                                                   : index - kRightLessLeft);
}

}  // namespace footing::body
