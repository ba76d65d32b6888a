#include "clients/view/render/play_picture.h"

#include <cmath>

#include "clients/view/render/overlay.h"
#include "clients/view/scene/live_keys.h"
#include "clients/view/scene/play_keys.h"

namespace footing::render {
namespace {

/// Moves everything that was drawn since the list had `from` corners.
void MoveDrawn(ImDrawList& list, int from, ImVec2 by) {
  for (int i = from; i < list.VtxBuffer.Size; ++i) {
    list.VtxBuffer[i].pos.x += by.x;
    list.VtxBuffer[i].pos.y += by.y;
  }
}

/// The keys of playback, with those of what is played.
std::vector<scene::KeyLine> PlayKeyLines(const std::vector<PlayedView>& views) {
  std::vector<scene::KeyLine> lines{{"?", "show or hide this list"},
                                    {"H", "hide or show the panels"},
                                    {"F11", "full screen, or a window again"}};
  const bool person =
      !views.empty() && scene::EngineOf(views.front().content.model) == scene::Engine::kPerson;
  if (person) {
    lines.push_back({"O", "the true pose beside the body, or over it"});
  } else {
    lines.push_back({"F", "force arrows at the feet"});
  }
  for (const auto& [key, what] : timeline::kPlayKeyHelp) lines.push_back({key, what});
  lines.push_back({"Esc, Q", "quit"});
  return lines;
}

}  // namespace

TimelineBoxes TimelineBoxesOf(const Screen& screen, int width, int height, std::size_t lanes) {
  const ImVec2 size(static_cast<float>(width), static_cast<float>(height));
  return LayOutTimeline(size, screen.ScaleOf(size), lanes);
}

void DrawPlayback(Screen& screen, const std::vector<PlayedView>& views, const HudOptions& options,
                  const TimelineContent* line, int width, int height) {
  const auto count = static_cast<int>(views.size());
  int bar_height = 0;
  if (line != nullptr) {
    const Box bar = TimelineBoxesOf(screen, width, height, line->lanes.size()).bar;
    bar_height = static_cast<int>(std::ceil(bar.height()));
  }
  const int high = std::max(1, height - bar_height);
  const auto left_of = [&](int i) { return i * width / count; };
  for (int i = 0; i < count; ++i) {
    const auto& content = views[static_cast<std::size_t>(i)].content;
    screen.world(static_cast<std::size_t>(i))
        .Draw(content.picture, content.model.track, content.model.track_version,
              left_of(i + 1) - left_of(i), high, left_of(i), bar_height);
  }
  const Paint paint = screen.BeginPanels(width, height);
  for (int i = 0; i < count; ++i) {
    const PlayedView& view = views[static_cast<std::size_t>(i)];
    const ImVec2 size(static_cast<float>(left_of(i + 1) - left_of(i)), static_cast<float>(high));
    const int before = paint.list->VtxBuffer.Size;
    HudOptions shown = options;
    shown.title = view.title;
    shown.over = view.note;
    shown.keys = false;
    DrawHud(paint, view.content, shown, size);
    MoveDrawn(*paint.list, before, {static_cast<float>(left_of(i)), 0});
    if (i == 0) continue;
    const auto x = static_cast<float>(left_of(i));
    paint.list->AddRectFilled({x - paint.scale, 0}, {x + paint.scale, static_cast<float>(high)},
                              IM_COL32(16, 22, 30, 255));
  }
  if (line != nullptr) {
    DrawTimeline(paint, TimelineBoxesOf(screen, width, height, line->lanes.size()), *line);
  }
  if (options.keys) {
    DrawKeys(paint, {static_cast<float>(width), static_cast<float>(high)}, PlayKeyLines(views));
  }
  screen.EndPanels();
}

}  // namespace footing::render
