#pragma once

#include "common/virtual/camera/scene.h"
#include "common/virtual/devices/random.h"

namespace footing::virtual_camera {

/// A point at this depth (z of C) whose image is in the central `share` of the picture, evenly.
Eigen::Vector3d PlaceInView(const Lens& lens, double depth_m, double share, noise::Random& random);

/// `count` rectangles and ellipses of saturated colours, half of them dim, none as bright as a
/// ball at a good exposure (at most 120 DN), and a white lamp that clips. Shapes that touch one of
/// the scene's balls in the picture and share its colour (less than 25 degrees of hue apart) get
/// another hue: such a ball has no edge there.
void AddClutter(Scene& scene, int count, noise::Random& random);

/// A line that hides this share of the area of a ball's disc, from a random side.
Occluder Hide(const Scene& scene, const Ball& ball, double share, noise::Random& random);

}  // namespace footing::virtual_camera
