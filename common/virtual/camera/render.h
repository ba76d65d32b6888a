#pragma once

#include <vector>

#include "common/virtual/camera/canvas.h"
#include "common/virtual/camera/scene.h"
#include "common/virtual/devices/random.h"

namespace footing::virtual_camera {

/// The frame that the sensor reads of a scene, ray by ray: balls are supersampled 64-fold (25-fold
/// from 15 px of radius on), each row at its own time and a moving ball nine times during the
/// exposure; then the point spread, halo, mosaic, shot and read noise, rounding and clipping at
/// 255. A ball nearer than 0.1 m, or beyond the image, is not drawn.
Mosaic Render(const Scene& scene, noise::Random& random);

/// Frames of a scene at rest, one after the other: traced once, each read with noise of its own.
std::vector<Mosaic> RenderStill(const Scene& scene, int frames, noise::Random& random);

/// What the sensor makes of the light on it: mosaic, shot and read noise, rounding and clipping.
Mosaic ReadOut(const Scene& scene, const Canvas& canvas, noise::Random& random);

}  // namespace footing::virtual_camera
