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
  /// `rod`: the vertex shader stretches it between the part's two ends.
  InstancedShape(const scene::Mesh& mesh, bool rod);
  void Draw(const Program& program, const std::vector<scene::Part>& instances);

 private:
  VertexArray array_;
  Buffer vertices_, indices_, instances_;
  GLsizei index_count_ = 0;
  bool rod_;
};

/// The four shapes that figures are built of.
class PartShapes {
 public:
  PartShapes();
  /// `coarse` draws big balls with few triangles, too.
  void Draw(const Program& program, const scene::PartList& parts, bool coarse);

 private:
  InstancedShape ball_, bead_, rod_, box_;
};

}  // namespace footing::render
