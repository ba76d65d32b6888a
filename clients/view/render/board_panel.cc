#include "clients/view/render/board_panel.h"

#include <algorithm>

#include "clients/view/scene/boards.h"
#include "clients/view/scene/words.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

/// One plate seen from above, front up, with the trace of the last 10 s fading away.
void DrawPlate(const Paint& p, const Box& space, const stream::BoardGeometry& geometry,
               const scene::BoardTrace& board, std::int64_t now_ns) {
  const float s = p.scale;
  const auto wide_m = static_cast<float>(geometry.plate_x_m),
             deep_m = static_cast<float>(geometry.plate_y_m);
  const float pixels_per_m = std::min(space.width() / wide_m, space.height() / deep_m);
  const ImVec2 centre((space.low.x + space.high.x) / 2, (space.low.y + space.high.y) / 2);
  const ImVec2 half(wide_m / 2 * pixels_per_m, deep_m / 2 * pixels_per_m);
  const auto at = [&](float x_m, float y_m) {
    return ImVec2(centre.x + x_m * pixels_per_m, centre.y - y_m * pixels_per_m);
  };
  p.list->AddRectFilled({centre.x - half.x, centre.y - half.y},
                        {centre.x + half.x, centre.y + half.y}, IM_COL32(255, 255, 255, 22), 9 * s);
  p.list->AddRect({centre.x - half.x, centre.y - half.y}, {centre.x + half.x, centre.y + half.y},
                  colour::kGroove, 9 * s, 0, 1.5f * s);
  p.list->AddLine({centre.x, centre.y - half.y}, {centre.x, centre.y + half.y}, colour::kGroove);
  p.list->AddLine({centre.x - half.x, centre.y}, {centre.x + half.x, centre.y}, colour::kGroove);
  for (std::size_t i = 1; i < board.points.size(); ++i) {
    const auto& a = board.points[i - 1];
    const auto& b = board.points[i];
    if (!b.joined) continue;
    const double age =
        static_cast<double>(now_ns - b.time_ns) / static_cast<double>(scene::kStripNs);
    const auto opacity = static_cast<float>(std::clamp(1 - age, 0.05, 1.0));
    p.list->AddLine(at(a.x_m, a.y_m), at(b.x_m, b.y_m), Faded(colour::kAccent, opacity), 1.6f * s);
  }
  if (board.newest.cop_valid) {
    p.Dot(at(static_cast<float>(board.newest.cop_x_m), static_cast<float>(board.newest.cop_y_m)), 5,
          colour::kText);
  }
}

void DrawSplit(const Paint& p, const Box& box, const scene::Stance& stance) {
  const float s = p.scale;
  const auto share = static_cast<float>(stance.left_share);
  const float middle = box.low.x + share * box.width();
  const Box bar{{box.low.x, box.low.y + 18 * s}, {box.high.x, box.low.y + 26 * s}};
  p.list->AddRectFilled(bar.low, {middle - s, bar.high.y}, colour::kAccent, 4 * s,
                        ImDrawFlags_RoundCornersLeft);
  p.list->AddRectFilled({middle + s, bar.low.y}, bar.high, colour::kSecond, 4 * s,
                        ImDrawFlags_RoundCornersRight);
  p.list->AddLine({(box.low.x + box.high.x) / 2, bar.low.y - 3 * s},
                  {(box.low.x + box.high.x) / 2, bar.high.y + 3 * s}, colour::kText);
  p.Write(p.fonts.small, box.low, colour::kAccent,
          "left " + scene::Fixed(100 * stance.left_share, 0) + " %");
  p.WriteRight(p.fonts.small, {box.high.x, box.low.y}, colour::kSecond,
               "right " + scene::Fixed(100 - 100 * stance.left_share, 0) + " %");
}

}  // namespace

void DrawBoardPanel(const Paint& p, const Box& box, const scene::Model& model,
                    std::int64_t now_ns) {
  if (model.boards.empty()) return;
  const float s = p.scale;
  const Box in = p.Panel(box);
  const scene::Stance stance = scene::StanceOf(model);
  p.Write(p.fonts.strong, in.low, colour::kText, "balance");
  p.WriteRight(
      p.fonts.strong, {in.high.x, in.low.y}, stance.valid ? colour::kText : colour::kFaint,
      stance.valid ? scene::Fixed(NewtonsToKilograms(stance.total_n), 1) + " kg" : "nobody on it");
  const float top = in.low.y + 24 * s, bottom = in.high.y - 32 * s;
  const auto count = static_cast<float>(model.boards.size());
  const float width = in.width() / count;
  float x = in.low.x;
  for (const auto& [key, board] : model.boards) {
    DrawPlate(p, {{x + 2 * s, top}, {x + width - 2 * s, bottom}}, scene::GeometryOf(model, key),
              board, now_ns);
    x += width;
  }
  if (stance.valid) DrawSplit(p, {{in.low.x, bottom + 6 * s}, in.high}, stance);
}

}  // namespace footing::render
