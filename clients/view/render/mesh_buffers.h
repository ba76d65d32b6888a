#pragma once

#include <cstdint>

#include "clients/view/render/handles.h"
#include "clients/view/render/program.h"
#include "clients/view/scene/mesh.h"
#include "clients/view/scene/part.h"
#include "clients/view/scene/ribbon.h"
#include "clients/view/scene/sky.h"

/// Meshes in the graphics driver's buffers. All need their OpenGL context current.
namespace footing::render {

/// A mesh that is drawn as it was uploaded.
class StaticMesh {
 public:
  void Upload(const scene::RibbonMesh& mesh);
  void Upload(const scene::SkyMesh& mesh);
  bool empty() const { return index_count_ == 0; }
  void Draw() const;

 private:
  VertexArray array_;
  Buffer vertices_, indices_;
  GLsizei index_count_ = 0;
};

/// A unit shape, drawn once for each part of a list.
class InstancedShape {
 public:
  /// How the vertex shader places a vertex of the shape: as it is, or with the taper of the part.
  enum class Kind { kSolid = 0, kRod = 1, kLimb = 2 };
  InstancedShape(const scene::Mesh& mesh, Kind kind);
  void Draw(const Program& program, const std::vector<scene::Part>& instances);

 private:
  VertexArray array_;
  Buffer vertices_, indices_, instances_;
  GLsizei index_count_ = 0;
  Kind kind_;
};

/// The shapes that figures are built of.
class PartShapes {
 public:
  PartShapes();
  /// `coarse` draws big balls with few triangles, too.
  void Draw(const Program& program, const scene::PartList& parts, bool coarse);

 private:
  InstancedShape ball_, coarse_ball_, rod_, limb_, box_;
};

}  // namespace footing::render
