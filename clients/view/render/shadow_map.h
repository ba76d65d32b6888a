#pragma once

#include <Eigen/Core>

#include "clients/view/render/handles.h"
#include "clients/view/render/mesh_buffers.h"
#include "clients/view/render/program.h"

namespace footing::render {

/// The shadow of the figures on the ground, seen from above around one point. Needs its OpenGL
/// context current in every call.
class ShadowMap {
 public:
  ShadowMap();
  /// Draws the figures' outline around `centre_m` and binds the framebuffer of before again.
  void Draw(const Program& program, PartShapes& shapes, const scene::PartList& figures,
            const Eigen::Vector3f& centre_m);
  /// As the texture of unit 0.
  void Bind() const;

 private:
  Framebuffer framebuffer_;
  Texture texture_;
};

}  // namespace footing::render
