#pragma once

#include <optional>

#include "clients/view/render/handles.h"
#include "clients/view/render/image.h"
#include "common/base/result.h"

namespace footing::render {

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
