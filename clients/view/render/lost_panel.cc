#include "clients/view/render/lost_panel.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "clients/view/scene/lost_text.h"

namespace footing::render {
namespace {

constexpr float kWidestBanner = 900;
constexpr float kSide = 22, kTop = 14, kLineGap = 5;
constexpr ImU32 kFill = IM_COL32(150, 24, 24, 236);
constexpr std::size_t kTitleLines = 3;

struct LostLines {
  ImFont* font = nullptr;
  std::vector<std::string> lines;
};
using LostText = std::array<LostLines, 3>;

LostText TextIn(const Paint& p, const scene::LostSignal& lost, const std::array<ImFont*, 3>& fonts,
                float width) {
  return {{{fonts[0], p.Wrapped(fonts[0], lost.what, width)},
           {fonts[1], p.Wrapped(fonts[1], lost.effect, width)},
           {fonts[2], p.Wrapped(fonts[2], lost.advice, width)}}};
}

float HeightOf(const LostText& text, float scale) {
  float height = 2 * kTop * scale;
  for (const LostLines& part : text) {
    height += static_cast<float>(part.lines.size()) * (part.font->FontSize + kLineGap * scale);
  }
  return height;
}

/// In letters as large as fit into the space.
LostText FittingText(const Paint& p, const scene::LostSignal& lost, float width, float height) {
  const Fonts& f = p.fonts;
  const std::array<std::array<ImFont*, 3>, 3> sets{{{f.title, f.heading, f.strong},
                                                    {f.heading, f.strong, f.text},
                                                    {f.strong, f.small, f.small}}};
  for (const auto& fonts : sets) {
    const LostText text = TextIn(p, lost, fonts, width);
    const bool few = text[0].lines.size() <= kTitleLines;
    if (few && HeightOf(text, p.scale) <= height) return text;
  }
  return TextIn(p, lost, sets.back(), width);
}

}  // namespace

void DrawLostPanel(const Paint& p, const scene::CharacterPose& pose, Box& space) {
  const auto lost = scene::LostSignalOf(pose);
  if (!lost) return;
  const float s = p.scale;
  const float inner = std::min(space.width(), kWidestBanner * s) - 2 * kSide * s;
  const LostText text = FittingText(p, *lost, inner, space.height());
  const float height = HeightOf(text, s);
  float width = 0;
  for (const LostLines& part : text) {
    for (const std::string& line : part.lines) {
      width = std::max(width, p.WidthOf(part.font, line));
    }
  }
  const float middle = (space.low.x + space.high.x) / 2;
  const float half = width / 2 + kSide * s;
  p.list->AddRectFilled({middle - half, space.low.y}, {middle + half, space.low.y + height}, kFill,
                        14 * s);
  float y = space.low.y + kTop * s;
  for (const LostLines& part : text) {
    for (const std::string& line : part.lines) {
      p.WriteCentred(part.font, {middle, y}, colour::kText, line);
      y += part.font->FontSize + kLineGap * s;
    }
  }
  space.low.y += height + 6 * s;
}

}  // namespace footing::render
