#pragma once

#include <vector>

#include "clients/skeleton/tracking/kinect_clip.h"

namespace footing::skeleton {

/// A synthetic person of 1.75 m who faces the camera, 2.4 m away and 1 m high: stands for 3 s, then
/// waves with the right hand, raises both arms and squats; 12 s at 30 Hz, ends as it begins. All
/// joints are tracked but the feet, which a squat of this depth hides: they are inferred then.
std::vector<ClipFrame> SyntheticClip();

}  // namespace footing::skeleton
