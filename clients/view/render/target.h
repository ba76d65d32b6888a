#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "clients/view/render/gl.h"
#include "clients/view/scene/part.h"
#include "clients/view/scene/ribbon.h"
#include "common/base/result.h"

namespace footing::render {

/// Owns one OpenGL name. Needs its context current when it is made and when it dies.
template <void (*Generate)(GLsizei, GLuint*), void (*Delete)(GLsizei, const GLuint*)>
class Handle {
 public:
  Handle() { Generate(1, &name_); }
  ~Handle() {
    if (name_ != 0) Delete(1, &name_);
  }
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
};

using Buffer = Handle<glGenBuffers, glDeleteBuffers>;
using VertexArray = Handle<glGenVertexArrays, glDeleteVertexArrays>;
using Framebuffer = Handle<glGenFramebuffers, glDeleteFramebuffers>;
using Renderbuffer = Handle<glGenRenderbuffers, glDeleteRenderbuffers>;
using Texture = Handle<glGenTextures, glDeleteTextures>;

/// A vertex and a fragment shader, linked.
class Program {
 public:
  /// Fails with the driver's own words.
  static Result<Program> Create(const std::string& name, const std::string& vertex_text,
                                const std::string& fragment_text);
  Program(Program&& other) noexcept : program_(std::exchange(other.program_, 0)) {}
  Program& operator=(Program&& other) noexcept {
    std::swap(program_, other.program_);
    return *this;
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  void Use() const { glUseProgram(program_); }
  /// Sets a uniform of the program in use; a name that the driver optimised away is ignored.
  void Set(const char* uniform, float value) const;
  void Set(const char* uniform, int value) const;
  void Set(const char* uniform, const Eigen::Vector2f& value) const;
  void Set(const char* uniform, const Eigen::Vector3f& value) const;
  void Set(const char* uniform, const Eigen::Matrix4f& value) const;
  void Set(const char* uniform, const std::vector<Eigen::Vector4f>& values) const;

 private:
  explicit Program(GLuint program) : program_(program) {}
  GLint At(const char* uniform) const { return glGetUniformLocation(program_, uniform); }

  GLuint program_ = 0;
};

// Meshes in the graphics driver's buffers. All need their OpenGL context current.

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

/// The shadow of the figures on the ground, seen from above around one point. Needs its OpenGL
/// context current in every call.
class ShadowMap {
 public:
  ShadowMap();
  /// Draws the figures' outline around `centre_m`. This and the next bind the framebuffer of before
  /// again.
  void Draw(const Program& program, PartShapes& shapes, const scene::PartList& figures,
            const Eigen::Vector3f& centre_m);
  /// Softens it, and darkens it by `blobs` (x, y, radius, darkness): what is left is the square
  /// root of the light.
  void Soften(const Program& program, const std::vector<Eigen::Vector4f>& blobs,
              const Eigen::Vector3f& centre_m);
  /// Binds the softened shadow as the texture of unit 0.
  void Bind() const;

 private:
  /// A picture that is drawn into, then read.
  struct Layer {
    explicit Layer(int pixels, bool with_copies);
    Framebuffer framebuffer;
    Texture texture;
  };
  Layer sharp_, soft_;
};

/// Pixels, red green blue, top row first.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Writes a PNG; the error names the file.
Result<void> WritePng(const Image& image, const std::string& path);
/// Writes a JPEG where the name ends in .jpg or .jpeg, else a PNG.
Result<void> WritePicture(const Image& image, const std::string& path);

/// A picture's memory: colour and depth, and a second one to resolve into when smoothed by
/// multisampling.
class Target {
 public:
  /// `samples` 0 is without multisampling. Without a number it is as smooth as the driver allows,
  /// at most kSamples.
  static Result<Target> Create(int width, int height, std::optional<int> samples);
  static constexpr int kSamples = 4;

  void Bind() const { glBindFramebuffer(GL_FRAMEBUFFER, drawn_.name()); }
  /// The pixels drawn so far.
  Image Read() const;

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }

 private:
  Target(int width, int height, int samples);

  int width_, height_, samples_;
  Framebuffer drawn_, resolved_;
  Renderbuffer colour_, depth_, resolved_colour_;
};

}  // namespace footing::render
