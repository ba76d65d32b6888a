#include "clients/view/scene/mesh.h"

#include <cmath>

#include "common/base/units.h"

namespace footing::scene {
namespace {

Eigen::Vector3f OnCircle(int slice, int slices, float radius, float z) {
  const float angle = static_cast<float>(2 * kPi) * static_cast<float>(slice) / slices;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Joins two rings of slices + 1 vertices each into triangles.
void JoinRings(int lower, int upper, int slices, std::vector<std::uint32_t>& indices) {
  for (int i = 0; i < slices; ++i) {
    const auto a = static_cast<std::uint32_t>(lower + i), b = a + 1;
    const auto c = static_cast<std::uint32_t>(upper + i), d = c + 1;
    indices.insert(indices.end(), {a, b, d, a, d, c});
  }
}

}  // namespace

Mesh UnitBall(int slices, int stacks) {
  Mesh mesh;
  for (int stack = 0; stack <= stacks; ++stack) {
    const float angle = static_cast<float>(kPi) * static_cast<float>(stack) / stacks;
    for (int slice = 0; slice <= slices; ++slice) {
      const Eigen::Vector3f p = OnCircle(slice, slices, std::sin(angle), -std::cos(angle));
      mesh.vertices.push_back({p, p});
    }
    if (stack > 0)
      JoinRings((stack - 1) * (slices + 1), stack * (slices + 1), slices, mesh.indices);
  }
  return mesh;
}

Mesh UnitBox() {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-0.5f, 0.5f}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      Eigen::Vector3f normal = Eigen::Vector3f::Zero();
      normal[axis] = 2 * side;
      for (int corner = 0; corner < 4; ++corner) {
        Eigen::Vector3f p = 0.5f * normal;
        p[(axis + 1) % 3] = (corner & 1) != 0 ? side : -side;
        p[(axis + 2) % 3] = (corner & 2) != 0 ? 0.5f : -0.5f;
        mesh.vertices.push_back({p, normal});
      }
      mesh.indices.insert(mesh.indices.end(),
                          {first, first + 1, first + 3, first, first + 3, first + 2});
    }
  }
  return mesh;
}

Mesh UnitRod(int slices) {
  Mesh mesh;
  for (const float z : {0.0f, 1.0f}) {
    for (int slice = 0; slice <= slices; ++slice) {
      mesh.vertices.push_back({OnCircle(slice, slices, 1, z), OnCircle(slice, slices, 1, 0)});
    }
  }
  JoinRings(0, slices + 1, slices, mesh.indices);
  const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
  const Eigen::Vector3f down(0, 0, -1);
  mesh.vertices.push_back({Eigen::Vector3f::Zero(), down});
  for (int slice = 0; slice <= slices; ++slice) {
    mesh.vertices.push_back({OnCircle(slice, slices, 1, 0), down});
  }
  for (int slice = 0; slice < slices; ++slice) {
    const auto rim = centre + 1 + static_cast<std::uint32_t>(slice);
    mesh.indices.insert(mesh.indices.end(), {centre, rim + 1, rim});
  }
  return mesh;
}

Mesh UnitLimb(int slices, int stacks) {
  Mesh mesh;
  for (int ring = 0; ring <= 2 * stacks + 1; ++ring) {
    const bool second = ring > stacks;
    const int stack = second ? ring - 1 : ring;  // The equator is there twice, once for each end.
    const float angle = static_cast<float>(kPi) * static_cast<float>(stack) / (2 * stacks);
    for (int slice = 0; slice <= slices; ++slice) {
      const Eigen::Vector3f n = OnCircle(slice, slices, std::sin(angle), -std::cos(angle));
      mesh.vertices.push_back({{n.x(), n.y(), second ? 1.0f : 0.0f}, n});
    }
    if (ring > 0) JoinRings((ring - 1) * (slices + 1), ring * (slices + 1), slices, mesh.indices);
  }
  return mesh;
}

}  // namespace footing::scene
