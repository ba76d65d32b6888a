#pragma once

#include <memory>

#include "clients/view/app/options.h"
#include "clients/view/app/play_session.h"
#include "clients/view/render/hud.h"
#include "clients/view/render/screen.h"

namespace footing::view {

/// What a person has switched on while a recording plays.
struct PlayPicture {
  render::HudOptions hud;
  bool timeline = true;
  scene::Orbit orbit = {};
};

/// As the options ask: for the subject neither panels nor timeline; side by side no columns.
PlayPicture PictureFor(const Options& options, const PlaySession& session);

/// Draws all sides at the head's position into the bound framebuffer.
void DrawSession(render::Screen& screen, PlaySession& session, const PlayPicture& picture,
                 int width, int height);

/// A screen with a world for each side.
Result<std::unique_ptr<render::Screen>> ScreenFor(const Options& options,
                                                  const PlaySession& session);

/// Draws options.screenshot at options.at_s, or pictures into options.record from the head on; each
/// at its exact position, however long it takes.
Result<void> DrawPlayedPictures(const Options& options, PlaySession& session);

}  // namespace footing::view
