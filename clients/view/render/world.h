#pragma once

#include <cstdint>

#include "clients/view/render/handles.h"
#include "clients/view/render/mesh_buffers.h"
#include "clients/view/render/program.h"
#include "clients/view/render/shadow_map.h"
#include "clients/view/scene/course.h"
#include "clients/view/scene/stage.h"
#include "common/base/result.h"

namespace footing::render {

/// Draws the world of a picture: figures, track, ground, sky. Needs its OpenGL context current in
/// every call.
class World {
 public:
  static Result<World> Create();

  /// Draws into the bound framebuffer, into the rectangle of that size whose lower left corner is
  /// given. A new `track_version` says that the track has changed.
  void Draw(const scene::Picture& picture, const stream::Track& track, std::uint64_t track_version,
            int width, int height, int left = 0, int bottom = 0);
  /// Draws only ids (scene::PartId in the red channel) on black: for tests.
  void DrawIds(const scene::Picture& picture, int width, int height);

 private:
  struct Programs {
    Program part, part_id, shadow, ground, ribbon, mark, sky;
  };
  explicit World(Programs programs);
  void DrawMarks(const scene::Picture& picture, const Eigen::Vector3f& eye,
                 const Eigen::Matrix4f& clip_from_world);
  bool Fades() const { return fade_.to_m > fade_.from_m; }
  void DrawTrack(const scene::Picture& picture, const Eigen::Matrix4f& clip_from_world);
  void DrawGround(const scene::Picture& picture, const Eigen::Matrix4f& clip_from_world);
  /// One sees through them, but never into them; `opacity` 0 to 1.
  void DrawGhosts(const scene::PartList& parts, float opacity);
  /// They show through what is before them, faintly.
  void DrawSigns(const scene::PartList& parts);
  void DrawClear(const scene::PartList& parts);
  void DrawSky(const Eigen::Vector3f& eye, const Eigen::Matrix4f& clip_from_world);

  Programs programs_;
  PartShapes shapes_;
  StaticMesh track_, sky_;
  scene::Fade fade_;
  std::uint64_t track_version_ = 0;
  VertexArray nothing_;  // For shapes that the vertex shader generates.
  ShadowMap shadow_map_;
};

}  // namespace footing::render
