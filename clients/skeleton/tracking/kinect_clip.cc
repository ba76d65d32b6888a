#include "clients/skeleton/tracking/kinect_clip.h"

#include <array>

#include "clients/skeleton/tracking/joint_set.h"
#include "common/base/csv.h"
#include "common/base/lines.h"
#include "common/base/number.h"

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

}  // namespace footing::skeleton
