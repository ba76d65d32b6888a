#include "clients/view/render/target.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace footing::render {
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
