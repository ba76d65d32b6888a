#pragma once

#include <string>
#include <vector>

#include "common/frames/frame.h"
#include "common/base/result.h"

namespace footing::frames {

/// The .pgm, .ppm and .yuyv files of a folder in the order of their names; an error when there is
/// none.
Result<std::vector<std::string>> FramesOf(const std::string& folder);

/// One frame. A .yuyv file has no header: its size must be that of width and height.
Result<Frame> ReadFrame(const std::string& path, int width, int height);

}  // namespace footing::frames
