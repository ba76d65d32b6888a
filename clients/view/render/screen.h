#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <imgui.h>

#include "clients/view/render/hud.h"
#include "clients/view/render/hud_layout.h"
#include "clients/view/render/target.h"
#include "clients/view/render/world.h"
#include "common/base/result.h"
#include "common/camera/preview.h"

namespace footing::render {

/// The camera's picture on the graphics card.
class PreviewTexture {
 public:
  /// Uploads it unless it is the one that is there. Null: there is none.
  ImTextureID Take(const std::shared_ptr<const preview::Picture>& picture);

 private:
  Texture texture_;
  std::shared_ptr<const preview::Picture> shown_;
};

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
  /// Pixels per unit of the panels drawn last.
  float scale() const { return scale_; }
  float ScaleOf(ImVec2 size) const { return ui_scale_ * HudScale(size, display_scale_); }

 private:
  explicit Screen(World world);
  void LoadFontsAt(float scale);

  std::vector<World> worlds_;
  float display_scale_ = 1;
  float ui_scale_ = 1;
  float scale_ = 0;  ///< Scale of the fonts; 0 before the first picture.
  Fonts fonts_;
  PreviewTexture preview_;
};

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

/// One recording as it is shown.
struct PlayedView {
  HudContent content;
  std::string title;  ///< Over the picture; empty: none.
  std::string note;   ///< "ended"; empty: none.
};

/// One recording, or two side by side, each with its own camera and panels, over one timeline.
/// `line` null: without it. For two recordings `screen` has two worlds.
void DrawPlayback(Screen& screen, const std::vector<PlayedView>& views, const HudOptions& options,
                  const TimelineContent* line, int width, int height);

/// Rectangles of DrawPlayback's worlds in a picture of that size, from the left.
std::vector<Box> PlaybackBoxesOf(const Screen& screen, int width, int height, std::size_t count,
                                 bool with_timeline);
/// Place of DrawPlayback's timeline in a picture of that size.
TimelineBoxes TimelineBoxesOf(const Screen& screen, int width, int height, std::size_t lanes);

}  // namespace footing::render
