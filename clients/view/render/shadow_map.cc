#include "clients/view/render/shadow_map.h"

#include <array>

#include "clients/view/render/shader_text.h"

namespace footing::render {
namespace {

constexpr int kShadowPixels = 512;

}  // namespace

ShadowMap::ShadowMap() {
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kShadowPixels, kShadowPixels, 0, GL_RED, GL_UNSIGNED_BYTE,
               nullptr);
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  GLint before = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.name(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
}

void ShadowMap::Draw(const Program& program, PartShapes& shapes, const scene::PartList& figures,
                     const Eigen::Vector3f& centre_m) {
  GLint before = 0;
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, kShadowPixels, kShadowPixels);
  glDisable(GL_DEPTH_TEST);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  program.Use();
  program.Set("u_centre", centre_m);
  program.Set("u_span", kMarkSpanM);
  shapes.Draw(program, figures, true);
  // The mark's edge is soft: it is read from the smaller copies.
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glGenerateMipmap(GL_TEXTURE_2D);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
  glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
}

void ShadowMap::Bind() const {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture_.name());
}

}  // namespace footing::render
