#pragma once

#include <cstdint>
#include <string>

#include "clients/view/render/target.h"
#include "clients/view/scene/ribbon.h"
#include "clients/view/scene/stage.h"
#include "common/base/result.h"

/// The world of a picture by OpenGL, and its shaders. World frame W; light and colours are linear
/// until the last line.
namespace footing::render {

inline constexpr int kMaxBlobs = 16;
inline constexpr int kMaxFootholds = 4;
inline constexpr float kMarkSpanM = 3.6f;  ///< Side of the square of ground that a bird marks.

/// GLSL texts of the shaders for parts, ground, track and sky.
std::string PartVertexText();
std::string PartFragmentText();
std::string PartIdFragmentText();
/// Parts projected along the sun onto the floor: the bird's shadow.
std::string ShadowVertexText();
std::string ShadowFragmentText();
std::string GroundVertexText();
std::string RibbonVertexText();
/// Ground and track alike; `ribbon` chooses.
std::string SurfaceFragmentText(bool ribbon);
/// Shadow and soft spots, into a small picture of the square of ground.
std::string SoftVertexText();
std::string SoftFragmentText();
/// That picture and rings: a square laid over the ground, with alpha.
std::string MarkVertexText();
std::string MarkFragmentText();
std::string SkyVertexText();
std::string SkyFragmentText();

/// Shared by the texts above: version, frame uniforms, sky, fog, output.
std::string SharedText();
/// Text for fragment shaders of wide areas: a pattern of one step of eight bits, so that a slow
/// change of tone shows no bands.
std::string GrainText();

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
    Program part, part_id, shadow, ground, ribbon, soft, mark, sky;
  };
  explicit World(Programs programs);
  void DrawMarks(const scene::Picture& picture, const Eigen::Vector3f& eye,
                 const Eigen::Matrix4f& clip_from_world);
  bool Fades() const { return fade_.to_m > fade_.from_m; }
  void DrawTrack(const scene::Picture& picture, const Eigen::Matrix4f& clip_from_world);
  void DrawGround(const scene::Picture& picture, const Eigen::Matrix4f& clip_from_world);
  /// One sees through them, but never into them; `opacity` 0 to 1.
  void DrawGhosts(const scene::PartList& parts, float opacity);
  /// Draws signs, which show faintly through the parts before them.
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
