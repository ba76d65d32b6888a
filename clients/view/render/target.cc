#include "clients/view/render/target.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <utility>

#include <stb_image_write.h>

#include "clients/view/render/world.h"
#include "common/base/text.h"

namespace footing::render {
namespace {

/// The driver's log of a shader or a program.
template <typename GetLog>
std::string DriverLog(GLuint name, GetLog get_log) {
  std::array<char, 2048> text{};
  GLsizei length = 0;
  get_log(name, static_cast<GLsizei>(text.size()), &length, text.data());
  return {text.data(), static_cast<std::size_t>(length)};
}

Result<GLuint> Compile(const std::string& name, GLenum stage, const std::string& text) {
  const GLuint shader = glCreateShader(stage);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  const std::string words = DriverLog(shader, glGetShaderInfoLog);
  glDeleteShader(shader);
  return Failure("the graphics driver cannot compile the shader '" + name + "': " + words);
}

}  // namespace

Result<Program> Program::Create(const std::string& name, const std::string& vertex_text,
                                const std::string& fragment_text) {
  const auto vertex = Compile(name + ".vertex", GL_VERTEX_SHADER, vertex_text);
  if (!vertex) return vertex.error();
  const auto fragment = Compile(name + ".fragment", GL_FRAGMENT_SHADER, fragment_text);
  if (!fragment) return fragment.error();
  Program program(glCreateProgram());
  for (const GLuint shader : {*vertex, *fragment}) {
    glAttachShader(program.program_, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program.program_);
  GLint linked = GL_FALSE;
  glGetProgramiv(program.program_, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  return Failure("the graphics driver cannot link the shader '" + name +
                 "': " + DriverLog(program.program_, glGetProgramInfoLog));
}

Program::~Program() {
  if (program_ != 0) glDeleteProgram(program_);
}

void Program::Set(const char* uniform, float value) const { glUniform1f(At(uniform), value); }
void Program::Set(const char* uniform, int value) const { glUniform1i(At(uniform), value); }
void Program::Set(const char* uniform, const Eigen::Vector2f& value) const {
  glUniform2fv(At(uniform), 1, value.data());
}
void Program::Set(const char* uniform, const Eigen::Vector3f& value) const {
  glUniform3fv(At(uniform), 1, value.data());
}
void Program::Set(const char* uniform, const Eigen::Matrix4f& value) const {
  glUniformMatrix4fv(At(uniform), 1, GL_FALSE, value.data());
}
void Program::Set(const char* uniform, const std::vector<Eigen::Vector4f>& values) const {
  if (values.empty()) return;
  glUniform4fv(At(uniform), static_cast<GLsizei>(values.size()), values.front().data());
}

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
    : ball_(scene::UnitBall(24, 14), InstancedShape::Kind::kSolid),
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

namespace {

// The shadow's edge is soft: more pixels would show nothing more.
constexpr int kSharpPixels = 256, kSoftPixels = 128;

/// Draws into a framebuffer of that many pixels each way while it lives.
class DrawingInto {
 public:
  DrawingInto(const Framebuffer& framebuffer, int pixels) {
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before_);
    glGetIntegerv(GL_VIEWPORT, viewport_.data());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, pixels, pixels);
    glDisable(GL_DEPTH_TEST);
  }
  ~DrawingInto() {
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before_));
    glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  }
  DrawingInto(const DrawingInto&) = delete;
  DrawingInto& operator=(const DrawingInto&) = delete;

 private:
  GLint before_ = 0;
  std::array<GLint, 4> viewport_{};
};

}  // namespace

ShadowMap::Layer::Layer(int pixels, bool with_copies) {
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, pixels, pixels, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
  if (with_copies) glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                  with_copies ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  const DrawingInto into(framebuffer, pixels);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.name(), 0);
}

ShadowMap::ShadowMap() : sharp_(kSharpPixels, true), soft_(kSoftPixels, false) {}

void ShadowMap::Draw(const Program& program, PartShapes& shapes, const scene::PartList& figures,
                     const Eigen::Vector3f& centre_m) {
  const DrawingInto into(sharp_.framebuffer, kSharpPixels);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  program.Use();
  program.Set("u_centre", centre_m);
  program.Set("u_span", kMarkSpanM);
  shapes.Draw(program, figures, true);
  // It is softened from the smaller copies.
  glBindTexture(GL_TEXTURE_2D, sharp_.texture.name());
  glGenerateMipmap(GL_TEXTURE_2D);
}

void ShadowMap::Soften(const Program& program, const std::vector<Eigen::Vector4f>& blobs,
                       const Eigen::Vector3f& centre_m) {
  const DrawingInto into(soft_.framebuffer, kSoftPixels);
  program.Use();
  program.Set("u_centre", centre_m);
  program.Set("u_span", kMarkSpanM);
  program.Set("u_shadow", 0);
  program.Set("u_blobs", blobs);
  program.Set("u_blob_count", static_cast<int>(blobs.size()));
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, sharp_.texture.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void ShadowMap::Bind() const {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, soft_.texture.name());
}

namespace {

constexpr int kJpegQuality = 92;  // Quality out of 100: edges of letters stay clean.

Result<void> Written(int written, const std::string& path) {
  if (written != 0) return {};
  return Failure("cannot write the picture " + path + ": " + std::strerror(errno));
}

}  // namespace

Result<void> WritePng(const Image& image, const std::string& path) {
  errno = 0;
  return Written(
      stbi_write_png(path.c_str(), image.width, image.height, 3, image.rgb.data(), 3 * image.width),
      path);
}

Result<void> WritePicture(const Image& image, const std::string& path) {
  const std::string ending = text::Lower(std::filesystem::path(path).extension().string());
  if (ending != ".jpg" && ending != ".jpeg") return WritePng(image, path);
  errno = 0;
  return Written(
      stbi_write_jpg(path.c_str(), image.width, image.height, 3, image.rgb.data(), kJpegQuality),
      path);
}

namespace {

constexpr int kMaxPixels = 8192;

}  // namespace

Target::Target(int width, int height, int samples)
    : width_(width), height_(height), samples_(samples) {
  glBindRenderbuffer(GL_RENDERBUFFER, colour_.name());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width, height);
  glBindRenderbuffer(GL_RENDERBUFFER, depth_.name());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width, height);
  glBindRenderbuffer(GL_RENDERBUFFER, resolved_colour_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                            resolved_colour_.name());
  glBindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_.name());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
}

Result<Target> Target::Create(int width, int height, std::optional<int> samples) {
  if (width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels) {
    return UsageError("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                      " pixels: allowed is 1 to " + std::to_string(kMaxPixels) + " each way");
  }
  if (!samples) {
    auto smooth = Create(width, height, kSamples);
    return smooth ? std::move(smooth) : Create(width, height, 0);
  }
  Target target(width, height, *samples);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return Failure("the graphics driver gives no picture of " + std::to_string(width) + " x " +
                   std::to_string(height) + " pixels with " + std::to_string(*samples) +
                   " samples; try a smaller --msaa");
  }
  return target;
}

Image Target::Read() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_.name());
  if (samples_ > 0) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.name());
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.name());
  }
  const auto row = static_cast<std::size_t>(3 * width_);
  std::vector<std::uint8_t> upside_down(row * static_cast<std::size_t>(height_));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, upside_down.data());
  Bind();
  Image image{width_, height_, std::vector<std::uint8_t>(upside_down.size())};
  for (int y = 0; y < height_; ++y) {
    const auto from = upside_down.begin() + static_cast<std::ptrdiff_t>(row) * (height_ - 1 - y);
    std::copy_n(from, row, image.rgb.begin() + static_cast<std::ptrdiff_t>(row) * y);
  }
  return image;
}

}  // namespace footing::render
