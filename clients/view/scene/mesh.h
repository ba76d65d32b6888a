#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace footing::scene {

struct MeshVertex {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
};

/// Triangles, counter-clockwise from outside.
struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// Sphere of radius 1. `slices` around z, `stacks` from pole to pole; both at least 3.
Mesh UnitBall(int slices, int stacks);

/// Cube of side 1 about the origin.
Mesh UnitBox();

/// Radius 1 about z from z = 0 to 1, open at the ends that its neighbours hide; the bottom is
/// closed. The renderer tapers its top.
Mesh UnitRod(int slices);

/// A rod with round ends: two half spheres of radius 1 about z, joined by a side. The z of a vertex
/// is 0 at the first end and 1 at the second one; its normal says where on the half sphere it lies.
/// The renderer gives the ends their radii and the rod its length. `stacks` is of one half sphere.
Mesh UnitLimb(int slices, int stacks);

}  // namespace footing::scene
