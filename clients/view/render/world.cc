#include "clients/view/render/world.h"

#include <algorithm>
#include <cstddef>

#include "clients/view/render/shader_text.h"
#include "clients/view/scene/mesh.h"
#include "clients/view/scene/ribbon.h"
#include "clients/view/scene/sky.h"

namespace footing::render {
namespace {

constexpr float kStudioLamp = 0.55f;
constexpr float kGhostOpacity = 0.55f;
constexpr float kClearOpacity = 0.38f;
constexpr float kHiddenOpacity = 0.55f;
constexpr int kShadowPixels = 512;
// The shadow of a bird falls this far beside it: its middle is 0.9 m high.
const Eigen::Vector3f kToShadowM(0.45f, -0.60f, 0);

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

World::World(Programs programs) : programs_(std::move(programs)) {
  const auto load = [](Shape& shape, const scene::Mesh& mesh, bool rod) {
    static_assert(sizeof(scene::MeshVertex) == 24 && sizeof(scene::Part) == 96);
    shape.rod = rod;
    shape.index_count = static_cast<GLsizei>(mesh.indices.size());
    glBindVertexArray(shape.array.name());
    Fill(GL_ARRAY_BUFFER, shape.vertices, mesh.vertices, GL_STATIC_DRAW);
    Attribute(0, 3, sizeof(scene::MeshVertex), 0);
    Attribute(1, 3, sizeof(scene::MeshVertex), 12);
    Fill(GL_ELEMENT_ARRAY_BUFFER, shape.indices, mesh.indices, GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, shape.instances.name());
    for (GLuint i = 0; i < 6; ++i) {
      Attribute(2 + i, 4, sizeof(scene::Part), 16 * i);
      glVertexAttribDivisor(2 + i, 1);
    }
  };
  load(ball_, scene::UnitBall(24, 14), false);
  load(bead_, scene::UnitBall(12, 6), false);
  load(rod_, scene::UnitRod(12), true);
  load(box_, scene::UnitBox(), false);
  LoadSky();

  glBindTexture(GL_TEXTURE_2D, shadow_map_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kShadowPixels, kShadowPixels, 0, GL_RED, GL_UNSIGNED_BYTE,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  GLint before = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, shadow_map_.name(),
                         0);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
}

void World::LoadSky() {
  static_assert(sizeof(scene::SkyVertex) == 24);
  const scene::SkyMesh mesh = scene::BuildSky();
  sky_.index_count = static_cast<GLsizei>(mesh.indices.size());
  glBindVertexArray(sky_.array.name());
  Fill(GL_ARRAY_BUFFER, sky_.vertices, mesh.vertices, GL_STATIC_DRAW);
  Attribute(0, 3, sizeof(scene::SkyVertex), 0);
  Attribute(1, 3, sizeof(scene::SkyVertex), 12);
  Fill(GL_ELEMENT_ARRAY_BUFFER, sky_.indices, mesh.indices, GL_STATIC_DRAW);
}

void World::DrawSky(const Eigen::Vector3f& eye, const Eigen::Matrix4f& clip_from_world) {
  programs_.sky.Use();
  programs_.sky.Set("u_eye", eye);
  programs_.sky.Set("u_clip_from_world", clip_from_world);
  glBindVertexArray(sky_.array.name());
  glDrawElements(GL_TRIANGLES, sky_.index_count, GL_UNSIGNED_INT, nullptr);
}

void World::LoadTrack(const stream::Track& track, std::uint64_t version) {
  if (version == ribbon_.version) return;
  static_assert(sizeof(scene::RibbonVertex) == 40);
  ribbon_.version = version;
  const scene::RibbonMesh mesh = scene::BuildRibbon(track);
  ribbon_.index_count = static_cast<GLsizei>(mesh.indices.size());
  glBindVertexArray(ribbon_.array.name());
  Fill(GL_ARRAY_BUFFER, ribbon_.vertices, mesh.vertices, GL_STATIC_DRAW);
  Attribute(0, 3, sizeof(scene::RibbonVertex), 0);
  Attribute(1, 3, sizeof(scene::RibbonVertex), 12);
  Attribute(2, 4, sizeof(scene::RibbonVertex), 24);
  Fill(GL_ELEMENT_ARRAY_BUFFER, ribbon_.indices, mesh.indices, GL_STATIC_DRAW);
}

void World::DrawParts(const Program& program, const scene::PartList& parts, bool coarse) {
  const auto draw = [&program](Shape& shape, const std::vector<scene::Part>& instances) {
    if (instances.empty()) return;
    glBindVertexArray(shape.array.name());
    Fill(GL_ARRAY_BUFFER, shape.instances, instances, GL_STREAM_DRAW);
    program.Set("u_is_rod", shape.rod ? 1 : 0);
    glDrawElementsInstanced(GL_TRIANGLES, shape.index_count, GL_UNSIGNED_INT, nullptr,
                            static_cast<GLsizei>(instances.size()));
  };
  draw(coarse ? bead_ : ball_, parts.balls);
  draw(bead_, parts.beads);
  draw(rod_, parts.rods);
  draw(box_, parts.boxes);
}

void World::DrawGhosts(const scene::PartList& parts, float opacity) {
  programs_.part.Set("u_opacity", opacity);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  DrawParts(programs_.part, parts, false);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  DrawParts(programs_.part, parts, false);
  glDisable(GL_BLEND);
  programs_.part.Set("u_opacity", 1.0f);
}

void World::DrawClear(const scene::PartList& parts) {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  programs_.part.Set("u_opacity", kClearOpacity);
  programs_.part.Set("u_plain", 1.0f);
  DrawParts(programs_.part, parts, false);
  programs_.part.Set("u_plain", 0.0f);
  programs_.part.Set("u_opacity", 1.0f);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void World::DrawSigns(const scene::PartList& parts) {
  programs_.part.Set("u_plain", 0.6f);
  DrawParts(programs_.part, parts, true);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  programs_.part.Set("u_opacity", kHiddenOpacity);
  DrawParts(programs_.part, parts, true);
  programs_.part.Set("u_opacity", 1.0f);
  programs_.part.Set("u_plain", 0.0f);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_BLEND);
}

void World::DrawShadow(const scene::Picture& picture, const Eigen::Vector3f& centre) {
  GLint before = 0;
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_.name());
  glViewport(0, 0, kShadowPixels, kShadowPixels);
  glDisable(GL_DEPTH_TEST);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  programs_.shadow.Use();
  programs_.shadow.Set("u_centre", centre);
  programs_.shadow.Set("u_span", kMarkSpanM);
  DrawParts(programs_.shadow, picture.figures, true);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
  glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
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
    DrawShadow(picture, centre);
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
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, shadow_map_.name());
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

void World::DrawSurfaces(const scene::Picture& picture, const Eigen::Matrix4f& clip_from_world) {
  const Eigen::Vector3f eye = picture.camera.eye_m.cast<float>();
  for (const Program* program : {&programs_.ribbon, &programs_.ground}) {
    program->Use();
    program->Set("u_clip_from_world", clip_from_world);
    program->Set("u_eye", eye);
    if (program == &programs_.ribbon) {
      if (ribbon_.index_count == 0) continue;
      glBindVertexArray(ribbon_.array.name());
      glDrawElements(GL_TRIANGLES, ribbon_.index_count, GL_UNSIGNED_INT, nullptr);
    } else {
      program->Set("u_ground", picture.ground_m);
      program->Set("u_studio", picture.studio ? 1 : 0);
      glBindVertexArray(nothing_.name());
      glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
  }
}

void World::Draw(const scene::Picture& picture, const stream::Track& track,
                 std::uint64_t track_version, int width, int height) {
  LoadTrack(track, track_version);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glViewport(0, 0, width, height);
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
  DrawParts(programs_.part, picture.figures, false);
  DrawParts(programs_.part, picture.forces, true);
  DrawSurfaces(picture, clip_from_world);
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
  DrawParts(programs_.part_id, picture.figures, true);
  programs_.part_id.Set("u_id", static_cast<int>(scene::PartId::kForce));
  DrawParts(programs_.part_id, picture.forces, true);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace footing::render
