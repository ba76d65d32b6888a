#include "clients/skeleton/tracking/synthetic_clip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "clients/skeleton/tracking/joint_set.h"
#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::skeleton {
namespace {

constexpr std::size_t kMostFrames = 1'000'000;

/// Kinect v2's joints in the order of its JointType.
constexpr std::array<std::string_view, 25> kKinectNames = {
    "SpineBase",     "SpineMid",    "Neck",      "Head",          "ShoulderLeft",
    "ElbowLeft",     "WristLeft",   "HandLeft",  "ShoulderRight", "ElbowRight",
    "WristRight",    "HandRight",   "HipLeft",   "KneeLeft",      "AnkleLeft",
    "FootLeft",      "HipRight",    "KneeRight", "AnkleRight",    "FootRight",
    "SpineShoulder", "HandTipLeft", "ThumbLeft", "HandTipRight",  "ThumbRight"};
constexpr std::size_t kCells = 1 + 4 * kKinectNames.size();

Result<Skeleton> ToSkeleton(const std::vector<std::string_view>& cells) {
  JointSet joints;
  for (std::size_t i = 0; i < kKinectNames.size(); ++i) {
    JointReading reading;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto number = text::ToNumber(cells[1 + 4 * i + axis]);
      if (!number)
        return InvalidData("cell " + std::to_string(2 + 4 * i + axis) + " is not a number");
      reading.p_K_m[static_cast<Eigen::Index>(axis)] = *number;
    }
    const std::string_view state = cells[4 + 4 * i];
    if (state != "0" && state != "1" && state != "2")
      return InvalidData("cell " + std::to_string(5 + 4 * i) + " is not a state 0, 1 or 2");
    reading.confidence = state == "2" ? 1 : state == "1" ? 0.5 : 0.1;
    static_cast<void>(joints.Add(kKinectNames[i], reading));
  }
  return joints.Finish();
}

}  // namespace

Result<std::vector<ClipFrame>> ReadKinectClip(std::string_view text, const std::string& path) {
  std::vector<ClipFrame> frames;
  double first = 0;
  text::Lines lines(text, path);
  while (const auto line = lines.NextFull()) {
    const auto cells = text::Cells(*line);
    const auto wrong = [&](const std::string& why) { return lines.Fault(why); };
    if (cells.size() < kCells) return wrong("has fewer than " + std::to_string(kCells) + " cells");
    const auto time = text::ToNumber(cells[0]);
    if (!time) return wrong("the time is not a number");
    if (frames.empty()) first = *time;
    auto skeleton = ToSkeleton(cells);
    if (!skeleton) return wrong(skeleton.error().message);
    const auto time_ns = static_cast<std::int64_t>((*time - first) * 100);
    if (!frames.empty() && time_ns < frames.back().time_ns) return wrong("the time goes back");
    if (frames.size() == kMostFrames) return wrong("the recording is too long");
    skeleton->user = 1;
    skeleton->sequence = static_cast<std::int64_t>(frames.size());
    frames.push_back({time_ns, *skeleton});
  }
  if (frames.empty()) return InvalidData(path + ": has no frames");
  return frames;
}

namespace {

constexpr double kRateHz = 30;
constexpr double kStandS = 3;
constexpr double kPartS = 3;  // Duration of waving, raising and squatting each.
constexpr double kAwayM = 2.4, kCameraHeightM = 1;
constexpr double kUpperArmM = 0.29, kForearmM = 0.31, kThighM = 0.42, kShankM = 0.42;
constexpr double kAnkleM = 0.08, kHalfHipM = 0.09, kHalfShoulderM = 0.18;

/// 0 before and after, 1 in the middle of the part with this number; smooth.
double Part(int part, double time_s) {
  const double share = (time_s - kStandS - part * kPartS) / kPartS;
  if (share <= 0 || share >= 1) return 0;
  return 0.5 - 0.5 * std::cos(2 * kPi * share);
}

/// A point that is `ahead_m` before the person, `left_m` to its left and `up_m` above the floor.
Eigen::Vector3d InCamera(double ahead_m, double left_m, double up_m) {
  return {-left_m, up_m - kCameraHeightM, kAwayM - ahead_m};
}

Skeleton At(double time_s) {
  const double wave = Part(0, time_s), raise = Part(1, time_s), squat = Part(2, time_s);
  Skeleton skeleton;
  skeleton.user = 1;
  const auto set = [&](Joint joint, const Eigen::Vector3d& p_K_m, double confidence = 1) {
    skeleton[joint] = {p_K_m, confidence};
  };
  // Equal angles of thigh and shank against the vertical; the hips go back as the knees go forward.
  const double bend_rad = 0.1 + 0.9 * squat;
  const double hip_up_m = kAnkleM + (kThighM + kShankM) * std::cos(bend_rad);
  const double knee_up_m = kAnkleM + kShankM * std::cos(bend_rad);
  const double knee_ahead_m = kShankM * std::sin(bend_rad);
  const double lean_m = 0.2 * squat;
  set(Joint::kTorso, InCamera(0.4 * lean_m, 0, hip_up_m + 0.22));
  set(Joint::kNeck, InCamera(lean_m, 0, hip_up_m + 0.5));
  set(Joint::kHead, InCamera(1.3 * lean_m, 0, hip_up_m + 0.7));
  for (const bool left : {true, false}) {
    const double side = left ? 1 : -1;
    const auto joint = [left](Joint one) { return left ? one : Mirrored(one); };
    const double shoulder_up_m = hip_up_m + 0.46;
    const double shoulder_left_m = kHalfShoulderM * side;
    // Upper arm from hanging to level, forearm from hanging to upright; hands a little in front.
    const double waved = left ? 0 : wave;
    const double upper_rad = 0.15 + 1.35 * std::max(waved, raise);
    const double swing_rad = waved * 0.5 * std::sin(2 * kPi * 1.5 * time_s);
    const double fore_rad = upper_rad + 1.5 * std::max(waved, raise) + swing_rad;
    const double elbow_left_m = shoulder_left_m + side * kUpperArmM * std::sin(upper_rad);
    const double elbow_up_m = shoulder_up_m - kUpperArmM * std::cos(upper_rad);
    const double ahead_rad = 0.4;
    const double level_m = kForearmM * std::cos(ahead_rad);
    set(joint(Joint::kLeftShoulder), InCamera(lean_m, shoulder_left_m, shoulder_up_m));
    set(joint(Joint::kLeftElbow), InCamera(lean_m, elbow_left_m, elbow_up_m));
    set(joint(Joint::kLeftHand), InCamera(lean_m + kForearmM * std::sin(ahead_rad),
                                          elbow_left_m + side * level_m * std::sin(fore_rad),
                                          elbow_up_m - level_m * std::cos(fore_rad)));
    set(joint(Joint::kLeftHip), InCamera(0, kHalfHipM * side, hip_up_m));
    set(joint(Joint::kLeftKnee), InCamera(knee_ahead_m, 0.1 * side, knee_up_m));
    set(joint(Joint::kLeftFoot), InCamera(0, 0.1 * side, kAnkleM), squat > 0.8 ? 0.5 : 1);
  }
  return skeleton;
}

}  // namespace

std::vector<ClipFrame> SyntheticClip() {
  std::vector<ClipFrame> clip;
  const auto frames = static_cast<std::size_t>((kStandS + 3 * kPartS) * kRateHz);
  for (std::size_t i = 0; i < frames; ++i) {
    const double time_s = static_cast<double>(i) / kRateHz;
    clip.push_back({static_cast<std::int64_t>(std::llround(time_s * 1e9)), At(time_s)});
  }
  return clip;
}

}  // namespace footing::skeleton
