#include "clients/view/render/mesh_buffers.h"

#include <cstddef>

namespace footing::render {
namespace {

template <typename T>
void Fill(GLenum target, const Buffer& buffer, const std::vector<T>& items, GLenum usage) {
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(items.size() * sizeof(T)), items.data(), usage);
}

void Attribute(GLuint location, GLint size, std::size_t stride, std::size_t offset) {
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, size, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                        reinterpret_cast<const void*>(offset));
}

}  // namespace

void StaticMesh::Upload(const scene::RibbonMesh& mesh) {
  static_assert(sizeof(scene::RibbonVertex) == 40);
  index_count_ = static_cast<GLsizei>(mesh.indices.size());
  glBindVertexArray(array_.name());
  Fill(GL_ARRAY_BUFFER, vertices_, mesh.vertices, GL_STATIC_DRAW);
  Attribute(0, 3, sizeof(scene::RibbonVertex), 0);
  Attribute(1, 3, sizeof(scene::RibbonVertex), 12);
  Attribute(2, 4, sizeof(scene::RibbonVertex), 24);
  Fill(GL_ELEMENT_ARRAY_BUFFER, indices_, mesh.indices, GL_STATIC_DRAW);
}

void StaticMesh::Upload(const scene::SkyMesh& mesh) {
  static_assert(sizeof(scene::SkyVertex) == 24);
  index_count_ = static_cast<GLsizei>(mesh.indices.size());
  glBindVertexArray(array_.name());
  Fill(GL_ARRAY_BUFFER, vertices_, mesh.vertices, GL_STATIC_DRAW);
  Attribute(0, 3, sizeof(scene::SkyVertex), 0);
  Attribute(1, 3, sizeof(scene::SkyVertex), 12);
  Fill(GL_ELEMENT_ARRAY_BUFFER, indices_, mesh.indices, GL_STATIC_DRAW);
}

void StaticMesh::Draw() const {
  glBindVertexArray(array_.name());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

InstancedShape::InstancedShape(const scene::Mesh& mesh, Kind kind)
    : index_count_(static_cast<GLsizei>(mesh.indices.size())), kind_(kind) {
  static_assert(sizeof(scene::MeshVertex) == 24 && sizeof(scene::Part) == 96);
  glBindVertexArray(array_.name());
  Fill(GL_ARRAY_BUFFER, vertices_, mesh.vertices, GL_STATIC_DRAW);
  Attribute(0, 3, sizeof(scene::MeshVertex), 0);
  Attribute(1, 3, sizeof(scene::MeshVertex), 12);
  Fill(GL_ELEMENT_ARRAY_BUFFER, indices_, mesh.indices, GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  for (GLuint i = 0; i < 6; ++i) {
    Attribute(2 + i, 4, sizeof(scene::Part), 16 * i);
    glVertexAttribDivisor(2 + i, 1);
  }
}

void InstancedShape::Draw(const Program& program, const std::vector<scene::Part>& instances) {
  if (instances.empty()) return;
  glBindVertexArray(array_.name());
  Fill(GL_ARRAY_BUFFER, instances_, instances, GL_STREAM_DRAW);
  program.Set("u_kind", static_cast<int>(kind_));
  glDrawElementsInstanced(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr,
                          static_cast<GLsizei>(instances.size()));
}

PartShapes::PartShapes()
    : ball_(scene::UnitBall(32, 18), InstancedShape::Kind::kSolid),
      coarse_ball_(scene::UnitBall(12, 6), InstancedShape::Kind::kSolid),
      rod_(scene::UnitRod(16), InstancedShape::Kind::kRod),
      limb_(scene::UnitLimb(16, 4), InstancedShape::Kind::kLimb),
      box_(scene::UnitBox(), InstancedShape::Kind::kSolid) {}

void PartShapes::Draw(const Program& program, const scene::PartList& parts, bool coarse) {
  (coarse ? coarse_ball_ : ball_).Draw(program, parts.balls);
  rod_.Draw(program, parts.rods);
  limb_.Draw(program, parts.limbs);
  box_.Draw(program, parts.boxes);
}

}  // namespace footing::render
