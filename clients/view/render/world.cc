#include "clients/view/render/world.h"

#include <algorithm>

#include "clients/view/render/shader_text.h"
#include "clients/view/scene/ribbon.h"
#include "clients/view/scene/sky.h"

namespace footing::render {
namespace {

constexpr float kStudioLamp = 0.55f;
constexpr float kGhostOpacity = 0.55f;
constexpr float kClearOpacity = 0.38f;
constexpr float kHiddenOpacity = 0.55f;
// The shadow of a bird falls this far beside it: its middle is 0.9 m high.
const Eigen::Vector3f kToShadowM(0.45f, -0.60f, 0);

Eigen::Matrix4f ClipFromWorld(const scene::Picture& picture, int width, int height) {
  const double aspect = static_cast<double>(width) / std::max(height, 1);
  return picture.camera.Projection(aspect) * picture.camera.View();
}

}  // namespace

Result<World> World::Create() {
  const std::string parts = PartVertexText();
  auto part = Program::Create("part", parts, PartFragmentText());
  if (!part) return part.error();
  auto part_id = Program::Create("part id", parts, PartIdFragmentText());
  if (!part_id) return part_id.error();
  auto shadow = Program::Create("shadow", ShadowVertexText(), ShadowFragmentText());
  if (!shadow) return shadow.error();
  auto ground = Program::Create("ground", GroundVertexText(), SurfaceFragmentText(false));
  if (!ground) return ground.error();
  auto ribbon = Program::Create("ribbon", RibbonVertexText(), SurfaceFragmentText(true));
  if (!ribbon) return ribbon.error();
  auto mark = Program::Create("mark", MarkVertexText(), MarkFragmentText());
  if (!mark) return mark.error();
  auto sky = Program::Create("sky", SkyVertexText(), SkyFragmentText());
  if (!sky) return sky.error();
  return World({std::move(*part), std::move(*part_id), std::move(*shadow), std::move(*ground),
                std::move(*ribbon), std::move(*mark), std::move(*sky)});
}

World::World(Programs programs) : programs_(std::move(programs)) { sky_.Upload(scene::BuildSky()); }

void World::DrawSky(const Eigen::Vector3f& eye, const Eigen::Matrix4f& clip_from_world) {
  programs_.sky.Use();
  programs_.sky.Set("u_eye", eye);
  programs_.sky.Set("u_clip_from_world", clip_from_world);
  sky_.Draw();
}

void World::DrawGhosts(const scene::PartList& parts, float opacity) {
  programs_.part.Set("u_opacity", opacity);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  shapes_.Draw(programs_.part, parts, false);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  shapes_.Draw(programs_.part, parts, false);
  glDisable(GL_BLEND);
  programs_.part.Set("u_opacity", 1.0f);
}

void World::DrawClear(const scene::PartList& parts) {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  programs_.part.Set("u_opacity", kClearOpacity);
  programs_.part.Set("u_plain", 1.0f);
  shapes_.Draw(programs_.part, parts, false);
  programs_.part.Set("u_plain", 0.0f);
  programs_.part.Set("u_opacity", 1.0f);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void World::DrawSigns(const scene::PartList& parts) {
  programs_.part.Set("u_plain", 0.6f);
  shapes_.Draw(programs_.part, parts, true);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  programs_.part.Set("u_opacity", kHiddenOpacity);
  shapes_.Draw(programs_.part, parts, true);
  programs_.part.Set("u_opacity", 1.0f);
  programs_.part.Set("u_plain", 0.0f);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_BLEND);
}

// Over the finished ground, where the birds are: a software renderer pays for every pixel.
void World::DrawMarks(const scene::Picture& picture, const Eigen::Vector3f& eye,
                      const Eigen::Matrix4f& clip_from_world) {
  std::vector<Eigen::Vector4f> blobs, rings;
  for (const scene::Blob& blob : picture.blobs) {
    if (blobs.size() < kMaxBlobs) {
      blobs.emplace_back(blob.position_m.x(), blob.position_m.y(), blob.radius_m, blob.darkness);
    }
  }
  for (const Eigen::Vector3f& p : picture.footholds) {
    if (rings.size() < kMaxFootholds) rings.emplace_back(p.x(), p.y(), p.z(), 0);
  }
  for (const scene::Spot& spot : picture.spots) {
    const Eigen::Vector3f beside(kToShadowM.x(), kToShadowM.y(),
                                 kToShadowM.head<2>().dot(spot.slope));
    const Eigen::Vector3f centre = spot.centre_m + beside;
    shadow_map_.Draw(programs_.shadow, shapes_, picture.figures, centre);
    const Program& program = programs_.mark;
    program.Use();
    program.Set("u_clip_from_world", clip_from_world);
    program.Set("u_eye", eye);
    program.Set("u_centre", centre);
    program.Set("u_slope", Eigen::Vector3f(spot.slope.x(), spot.slope.y(), 0));
    program.Set("u_span", kMarkSpanM);
    program.Set("u_shadow", 0);
    program.Set("u_blobs", blobs);
    program.Set("u_blob_count", static_cast<int>(blobs.size()));
    program.Set("u_rings", rings);
    program.Set("u_ring_count", static_cast<int>(rings.size()));
    shadow_map_.Bind();
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
  }
}

void World::DrawTrack(const scene::Picture& picture, const Eigen::Matrix4f& clip_from_world) {
  if (track_.empty()) return;
  const Program& program = programs_.ribbon;
  program.Use();
  program.Set("u_clip_from_world", clip_from_world);
  program.Set("u_eye", Eigen::Vector3f(picture.camera.eye_m.cast<float>()));
  program.Set("u_fade", Eigen::Vector2f(fade_.from_m, fade_.to_m));
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  if (Fades()) glEnable(GL_BLEND);
  track_.Draw();
  glDisable(GL_BLEND);
}

void World::DrawGround(const scene::Picture& picture, const Eigen::Matrix4f& clip_from_world) {
  const Program& program = programs_.ground;
  program.Use();
  program.Set("u_clip_from_world", clip_from_world);
  program.Set("u_eye", Eigen::Vector3f(picture.camera.eye_m.cast<float>()));
  program.Set("u_ground", picture.ground_m);
  program.Set("u_studio", picture.studio ? 1 : 0);
  glBindVertexArray(nothing_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void World::Draw(const scene::Picture& picture, const stream::Track& track,
                 std::uint64_t track_version, int width, int height, int left, int bottom) {
  if (track_version != track_version_) {
    track_version_ = track_version;
    track_.Upload(scene::BuildRibbon(track));
    fade_ = scene::FadeOf(track);
  }
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glViewport(left, bottom, width, height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glClear(GL_DEPTH_BUFFER_BIT);

  // Front to back: birds, track, ground, and the sky where nothing else is.
  const Eigen::Matrix4f clip_from_world = ClipFromWorld(picture, width, height);
  const Eigen::Vector3f eye = picture.camera.eye_m.cast<float>();
  programs_.part.Use();
  programs_.part.Set("u_clip_from_world", clip_from_world);
  programs_.part.Set("u_eye", eye);
  programs_.part.Set("u_floor", picture.floor_m);
  programs_.part.Set("u_opacity", 1.0f);
  programs_.part.Set("u_plain", 0.0f);
  programs_.part.Set("u_lamp", picture.studio ? kStudioLamp : 0.0f);
  shapes_.Draw(programs_.part, picture.figures, false);
  shapes_.Draw(programs_.part, picture.forces, true);
  // A track that fades shows the ground behind it.
  if (!Fades()) DrawTrack(picture, clip_from_world);
  DrawGround(picture, clip_from_world);
  if (Fades()) DrawTrack(picture, clip_from_world);
  DrawSky(eye, clip_from_world);
  DrawMarks(picture, eye, clip_from_world);
  programs_.part.Use();
  DrawClear(picture.clear);
  DrawGhosts(picture.ghosts, kGhostOpacity);
  DrawSigns(picture.signs);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(0);
}

void World::DrawIds(const scene::Picture& picture, int width, int height) {
  glViewport(0, 0, width, height);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  programs_.part_id.Use();
  programs_.part_id.Set("u_clip_from_world", ClipFromWorld(picture, width, height));
  programs_.part_id.Set("u_id", static_cast<int>(scene::PartId::kBird));
  shapes_.Draw(programs_.part_id, picture.figures, true);
  programs_.part_id.Set("u_id", static_cast<int>(scene::PartId::kForce));
  shapes_.Draw(programs_.part_id, picture.forces, true);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace footing::render
