#include "clients/view/render/program.h"

#include <array>

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

}  // namespace footing::render
