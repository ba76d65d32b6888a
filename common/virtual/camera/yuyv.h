#pragma once

#include <cstdint>
#include <vector>

#include "common/virtual/camera/scene.h"

namespace footing::virtual_camera {

/// What a camera that does not give its mosaic sends: missing colours as the mean of their
/// neighbours, then BT.601 luma and chroma of two pixels each, Y U Y V.
std::vector<std::uint8_t> ToYuyv(const Mosaic& mosaic);

}  // namespace footing::virtual_camera
