#include "clients/view/render/game_panel.h"

#include <algorithm>
#include <string>
#include <vector>

#include "clients/view/scene/game_text.h"
#include "clients/view/scene/words.h"

namespace footing::render {
namespace {

constexpr float kWidest = 460;
constexpr float kBothSides = 28;  // Of a panel, both sides.
constexpr float kBetweenRows = 4;

ImU32 InkOf(std::size_t player) { return player == 0 ? colour::kAccent : colour::kSecond; }

float RowHeight(const Paint& p, ImFont* font) { return font->FontSize + kBetweenRows * p.scale; }

/// Name, part and points on one side of the panel.
void DrawPlayer(const Paint& p, const Box& box, const stream::GameState& game, std::size_t player) {
  const bool left = player == 0;
  const std::string points = scene::Fixed(game.players[player].points, 0);
  const std::string part = scene::PartText(game, player);
  const float edge = left ? box.low.x : box.high.x;
  const auto write = [&](ImFont* font, float y, ImU32 ink, const std::string& text) {
    const std::string fitting = p.Fitting(font, text, box.width());
    if (left) {
      p.Write(font, {edge, y}, ink, fitting);
    } else {
      p.WriteRight(font, {edge, y}, ink, fitting);
    }
  };
  write(p.fonts.heading, box.low.y, InkOf(player), points);
  write(p.fonts.small, box.low.y + RowHeight(p, p.fonts.heading), colour::kText,
        game.players[player].name + (part.empty() ? "" : " " + part));
}

void DrawTitle(const Paint& p, const Box& box, const stream::GameState& game) {
  const std::string clock = scene::GameClock(game);
  const float clock_width = clock.empty() ? 0 : p.WidthOf(p.fonts.heading, clock) + 8 * p.scale;
  p.Write(p.fonts.heading, box.low, colour::kText,
          p.Fitting(p.fonts.heading, scene::GameTitle(game), box.width() - clock_width));
  const bool soon = game.left_s < 5.5;
  p.WriteRight(p.fonts.heading, {box.high.x, box.low.y}, soon ? colour::kWarning : colour::kText,
               clock);
}

}  // namespace

void DrawGamePanel(const Paint& p, const stream::GameState& game, Box& space) {
  const float s = p.scale;
  const float width = std::min(space.width(), kWidest * s);
  const float inner = width - kBothSides * s;
  std::vector<std::string> lines;
  for (const std::string& text : {scene::RoundText(game), scene::GhostText(game), game.note}) {
    for (std::string& line : p.Wrapped(p.fonts.small, text, inner))
      lines.push_back(std::move(line));
  }
  const float title = RowHeight(p, p.fonts.heading);
  const float players = title + RowHeight(p, p.fonts.small);
  const float row = RowHeight(p, p.fonts.small);
  const float least = kBothSides * s + title + players;
  if (least > space.height()) return;
  const auto fitting = static_cast<std::size_t>((space.height() - least) / row);
  lines.resize(std::min(lines.size(), fitting));
  const float height = least + static_cast<float>(lines.size()) * row;
  const float middle = (space.low.x + space.high.x) / 2;
  const Box in =
      p.Panel({{middle - width / 2, space.low.y}, {middle + width / 2, space.low.y + height}});
  DrawTitle(p, in, game);
  const float centre = (in.low.x + in.high.x) / 2;
  float y = in.low.y + title;
  DrawPlayer(p, {{in.low.x, y}, {centre - 4 * s, in.high.y}}, game, 0);
  DrawPlayer(p, {{centre + 4 * s, y}, {in.high.x, in.high.y}}, game, 1);
  y += players;
  for (const std::string& line : lines) {
    p.Write(p.fonts.small, {in.low.x, y}, colour::kFaint, line);
    y += row;
  }
  space.low.y += height + 6 * s;
}

}  // namespace footing::render
