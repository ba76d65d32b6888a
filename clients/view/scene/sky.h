#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "clients/view/scene/part.h"

namespace footing::scene {

/// Linear light where the ground meets the sky, also of the fog, and straight up.
inline const Colour kHorizonLight(0.74f, 0.84f, 0.90f);
inline const Colour kZenithLight(0.09f, 0.30f, 0.66f);

struct SkyVertex {
  Eigen::Vector3f direction;  ///< From the eye, of any length.
  Colour colour;
};

/// The sky as a dome of colours with two rows of far hills before it. To be drawn in order.
struct SkyMesh {
  std::vector<SkyVertex> vertices;
  std::vector<std::uint32_t> indices;
};
SkyMesh BuildSky();

}  // namespace footing::scene
