#pragma once

#include <utility>

#include "clients/view/render/gl.h"

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

}  // namespace footing::render
