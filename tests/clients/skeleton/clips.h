#pragma once

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "clients/skeleton/tracking/synthetic_clip.h"

namespace footing::skeleton {

/// The real Kinect v2 recordings; none without FOOTING_TEST_DATA.
inline std::vector<std::vector<ClipFrame>> RealClips() {
  std::vector<std::vector<ClipFrame>> clips;
  const char* const data = std::getenv("FOOTING_TEST_DATA");
  if (!data) return clips;
  for (const char* const name :
       {"Ges01_wavehand", "Ges02_balancinghands", "Ges04_comehere", "joints"}) {
    const std::string path = std::string(data) + "/hands/kinect2/" + name + ".csv";
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    if (text.str().empty()) continue;
    auto clip = ReadKinectClip(text.str(), path);
    if (clip) clips.push_back(std::move(clip).value());
  }
  return clips;
}

/// A person who stands 2.5 m before the camera and faces it, hands a little in front.
inline Skeleton Standing() {
  Skeleton skeleton;
  const auto set = [&](Joint joint, double x, double y, double z) {
    skeleton[joint] = {{x, y, z}, 1};
  };
  set(Joint::kHead, 0, 0.65, 2.5);
  set(Joint::kNeck, 0, 0.4, 2.5);
  set(Joint::kTorso, 0, 0.1, 2.5);
  for (const bool left : {true, false}) {
    const double side = left ? -1 : 1;
    const auto joint = [left](Joint one) { return left ? one : Mirrored(one); };
    set(joint(Joint::kLeftShoulder), 0.18 * side, 0.38, 2.5);
    set(joint(Joint::kLeftElbow), 0.25 * side, 0.1, 2.5);
    set(joint(Joint::kLeftHand), 0.25 * side, 0.05, 2.25);
    set(joint(Joint::kLeftHip), 0.09 * side, -0.1, 2.5);
    set(joint(Joint::kLeftKnee), 0.1 * side, -0.5, 2.47);
    set(joint(Joint::kLeftFoot), 0.1 * side, -0.9, 2.5);
  }
  skeleton.user = 1;
  return skeleton;
}

}  // namespace footing::skeleton
