#pragma once

#include <string>
#include <utility>

#include "common/base/result.h"

namespace footing::render {

/// An OpenGL 3.3 core context without any display (EGL, Mesa's surfaceless platform), current on
/// the thread that made it.
class OffScreen {
 public:
  static Result<OffScreen> Create();
  OffScreen(OffScreen&& other) noexcept
      : display_(std::exchange(other.display_, nullptr)),
        context_(std::exchange(other.context_, nullptr)) {}
  OffScreen& operator=(OffScreen&&) = delete;
  OffScreen(const OffScreen&) = delete;
  ~OffScreen();

 private:
  OffScreen(void* display, void* context) : display_(display), context_(context) {}

  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace footing::render
