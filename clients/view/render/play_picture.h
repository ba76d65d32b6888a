#pragma once

#include <string>
#include <vector>

#include "clients/view/render/hud.h"
#include "clients/view/render/timeline_bar.h"
#include "clients/view/render/screen.h"

namespace footing::render {

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

/// Where the timeline of DrawPlayback lies in a picture of that size.
TimelineBoxes TimelineBoxesOf(const Screen& screen, int width, int height, std::size_t lanes);

}  // namespace footing::render
