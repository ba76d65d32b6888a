#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "clients/view/render/gl.h"
#include "common/base/result.h"

namespace footing::render {

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

}  // namespace footing::render
