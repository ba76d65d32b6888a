#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/virtual/camera/scene.h"

/// How other trackers measure a luminous sphere, written from their published descriptions with
/// OpenCV; nothing here is shared with common/camera.
namespace footing::sphere_peers {

/// Common knowledge of both: the camera and the sphere.
struct Setup {
  virtual_camera::Lens lens;  ///< Without distortion.
  Eigen::Vector3d colour_dn{170, 40, 150};
  double radius_m = 0.0225;
};

/// PSMoveService: the largest contour of the sphere's hue, its convex hull, and the cone of rays
/// through the hull's points by linear least squares.
std::optional<Eigen::Vector3d> HullCone(const virtual_camera::Mosaic& mosaic, const Setup& setup);

/// psmoveapi: the smallest circle around the largest contour. Its distance is that of a pinhole;
/// psmoveapi's curve of distance over radius holds for another camera.
std::optional<Eigen::Vector3d> EnclosingCircle(const virtual_camera::Mosaic& mosaic,
                                               const Setup& setup);

}  // namespace footing::sphere_peers
