#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "clients/view/render/hud.h"
#include "clients/view/render/hud_layout.h"
#include "clients/view/render/preview_texture.h"
#include "clients/view/render/world.h"

namespace footing::render {

/// World and panels in one picture. Needs its OpenGL context current in every call; one a process.
class Screen {
 public:
  static Result<std::unique_ptr<Screen>> Create();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Draws into the bound framebuffer, the panels as large as the picture asks for (HudScale).
  void Draw(const HudContent& content, const HudOptions& options, int width, int height);
  /// The display's own factor: 1 on a common monitor, 2 on one with twice the pixels an inch.
  void set_display_scale(float display_scale) { display_scale_ = display_scale; }
  /// The panels' size over the usual one.
  void set_ui_scale(float ui_scale) { ui_scale_ = ui_scale; }
  World& world(std::size_t index = 0) { return worlds_[index]; }
  /// A further one, for a picture of its own track.
  Result<void> AddWorld();

  /// Panels of another making, over what is in the framebuffer: drawn between these two.
  Paint BeginPanels(int width, int height);
  void EndPanels();
  float ScaleOf(ImVec2 size) const { return ui_scale_ * HudScale(size, display_scale_); }

 private:
  explicit Screen(World world);
  void LoadFontsAt(float scale);

  std::vector<World> worlds_;
  float display_scale_ = 1;
  float ui_scale_ = 1;
  float scale_ = 0;  ///< Of the fonts; 0 before the first picture.
  Fonts fonts_;
  PreviewTexture preview_;
};

}  // namespace footing::render
