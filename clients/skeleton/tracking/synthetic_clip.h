#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "clients/skeleton/tracking/joint_set.h"
#include "common/base/result.h"

namespace footing::skeleton {

/// One frame of a clip.
struct ClipFrame {
  std::int64_t time_ns = 0;  ///< Since the first frame.
  Skeleton skeleton;
};

/// A Kinect v2 recording as KinectReader of the LabanotationSuite writes it: a line a frame,
/// `t_100ns,(x,y,z,state)*25`, metres in Kinect's frame, which is K; state 0 not tracked, 1
/// inferred, 2 tracked become the confidences 0.1, 0.5 and 1. InvalidData names the line: a cell
/// that is not a number, too few cells, a time that goes back, no frames, too many.
Result<std::vector<ClipFrame>> ReadKinectClip(std::string_view text, const std::string& path);

/// A synthetic person of 1.75 m who faces the camera, 2.4 m away and 1 m high: stands for 3 s, then
/// waves with the right hand, raises both arms and squats; 12 s at 30 Hz, ends as it begins. All
/// joints are tracked but the feet, which a squat of this depth hides: they are inferred then.
std::vector<ClipFrame> SyntheticClip();

}  // namespace footing::skeleton
