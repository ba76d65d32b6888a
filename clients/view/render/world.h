#pragma once

#include <array>
#include <cstdint>

#include "clients/view/render/handles.h"
#include "clients/view/render/program.h"
#include "clients/view/scene/stage.h"
#include "common/result/result.h"

namespace footing::render {

/// Draws the world of a picture: figures, track, ground, sky. Needs its OpenGL context current in
/// every call.
class World {
 public:
  static Result<World> Create();

  /// Draws into the bound framebuffer. `track_version` tells when the track is a new one.
  void Draw(const scene::Picture& picture, const stream::Track& track, std::uint64_t track_version,
            int width, int height);
  /// Draws only ids (scene::PartId in the red channel) on black: for tests.
  void DrawIds(const scene::Picture& picture, int width, int height);

 private:
  struct Programs {
    Program part, part_id, shadow, ground, ribbon, mark, sky;
  };
  /// A unit shape and the instances of it that a picture has.
  struct Shape {
    VertexArray array;
    Buffer vertices, indices, instances;
    GLsizei index_count = 0;
    bool rod = false;
  };
  struct Loaded {
    VertexArray array;
    Buffer vertices, indices;
    GLsizei index_count = 0;
    std::uint64_t version = 0;
  };

  explicit World(Programs programs);
  void LoadSky();
  void LoadTrack(const stream::Track& track, std::uint64_t version);
  /// `coarse` draws big balls with few triangles, too.
  void DrawParts(const Program& program, const scene::PartList& parts, bool coarse);
  void DrawShadow(const scene::Picture& picture, const Eigen::Vector3f& centre);
  void DrawMarks(const scene::Picture& picture, const Eigen::Vector3f& eye,
                 const Eigen::Matrix4f& clip_from_world);
  void DrawSurfaces(const scene::Picture& picture, const Eigen::Matrix4f& clip_from_world);
  /// One sees through them, but never into them; `opacity` 0 to 1.
  void DrawGhosts(const scene::PartList& parts, float opacity);
  /// They show through what is before them, faintly.
  void DrawSigns(const scene::PartList& parts);
  void DrawClear(const scene::PartList& parts);
  void DrawSky(const Eigen::Vector3f& eye, const Eigen::Matrix4f& clip_from_world);

  Programs programs_;
  Shape ball_, bead_, rod_, box_;
  Loaded ribbon_, sky_;
  VertexArray nothing_;  // For shapes that the vertex shader makes up.
  Framebuffer shadow_;
  Texture shadow_map_;
};

}  // namespace footing::render
