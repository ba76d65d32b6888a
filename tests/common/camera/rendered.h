#pragma once

#include "common/camera/image.h"
#include "common/virtual/camera/scene.h"

namespace footing::sphere {

/// A rendered frame as the finder takes it.
inline Image View(const virtual_camera::Mosaic& mosaic) {
  return {PixelFormat::kSgrbg8, mosaic.width, mosaic.height, mosaic.bytes};
}

}  // namespace footing::sphere
