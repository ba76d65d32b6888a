#pragma once

#include <cstdint>
#include <memory>

#include "clients/view/render/hud/hud.h"
#include "clients/view/render/world.h"

namespace footing::render {

/// World and panels in one picture. Needs its OpenGL context current in every call; one a process.
class Screen {
 public:
  /// `scale` 1 suits a picture 720 pixels high.
  static Result<std::unique_ptr<Screen>> Create(float scale);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Draws into the bound framebuffer.
  void Draw(const scene::Picture& picture, const scene::Model& model,
            const scene::WorldFrame& frame, std::int64_t now_ns, const HudOptions& options,
            int width, int height);
  World& world() { return world_; }

 private:
  Screen(World world, float scale);

  World world_;
  float scale_;
  Fonts fonts_;
};

}  // namespace footing::render
