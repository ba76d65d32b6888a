#include "clients/view/render/hud_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace footing::render {
namespace {

// In units.
constexpr float kReferenceWidth = 1280, kReferenceHeight = 720;
constexpr float kLeastScale = 0.8f;  // Letters 10 pixels high.
constexpr float kRoomyWidth = 1000;
constexpr float kWindowEdge = 18, kNarrowEdge = 10;
constexpr float kPanelGap = 8;
constexpr float kLeastColumn = 260, kMostColumn = 300;
constexpr float kColumnShare = 0.33f;
constexpr float kLeastMiddle = 120;
constexpr float kStampWidth = 240, kStampHeight = 28;

/// Stacks panels from the top into a column; one that does not fit is left out. What is left over
/// goes to the first panels first. `last_at_bottom`: the last one stands at the column's end.
template <std::size_t N>
std::array<std::optional<Box>, N> Stack(const std::array<PanelHeight, N>& needs, const Box& column,
                                        bool last_at_bottom) {
  std::array<float, N> heights{};
  float left = column.height();
  for (std::size_t i = 0; i < needs.size(); ++i) {
    const float gap = left < column.height() ? kPanelGap : 0;
    if (needs[i].full <= 0 || needs[i].least + gap > left) continue;
    heights[i] = needs[i].least;
    left -= needs[i].least + gap;
  }
  for (std::size_t i = 0; i < needs.size(); ++i) {
    if (heights[i] <= 0) continue;
    const float more = std::min(left, needs[i].full - needs[i].least);
    heights[i] += more;
    left -= more;
  }
  std::array<std::optional<Box>, N> boxes;
  float y = column.low.y;
  for (std::size_t i = 0; i < needs.size(); ++i) {
    if (heights[i] <= 0) continue;
    if (last_at_bottom && i + 1 == needs.size()) y = column.high.y - heights[i];
    boxes[i] = Box{{column.low.x, y}, {column.high.x, y + heights[i]}};
    y += heights[i] + kPanelGap;
  }
  return boxes;
}

Box Scaled(const Box& box, float scale) {
  return {{box.low.x * scale, box.low.y * scale}, {box.high.x * scale, box.high.y * scale}};
}

std::optional<Box> Scaled(const std::optional<Box>& box, float scale) {
  if (!box) return std::nullopt;
  return Scaled(*box, scale);
}

}  // namespace

float HudScale(ImVec2 size, float display_scale) {
  const float fitting = std::min(size.x / kReferenceWidth, size.y / kReferenceHeight);
  return std::max(fitting, kLeastScale * display_scale);
}

HudBoxes LayOut(ImVec2 size, float scale, const HudNeeds& needs) {
  const ImVec2 units(size.x / scale, size.y / scale);
  const float edge = units.x < kRoomyWidth ? kNarrowEdge : kWindowEdge;
  const float inner = units.x - 2 * edge;
  const float column = std::clamp(kColumnShare * inner, kLeastColumn, kMostColumn);
  const bool one = inner >= column;
  const bool two = inner >= 2 * (column + kPanelGap) + kLeastMiddle;
  const float between = inner - 2 * (column + kPanelGap);
  // Where the stamp does not fit between the columns it has a row of its own.
  const bool own_row = !two || between < kStampWidth;
  const float top = own_row ? edge + kStampHeight + kPanelGap : edge;
  const float bottom = std::max(top, units.y - edge);

  HudBoxes boxes;
  const float left_end = edge + column, right_start = units.x - edge - column;
  if (one) {
    Box left{{edge, top}, {left_end, bottom}};
    const bool camera = needs.camera.full > 0 && needs.camera.least <= left.height();
    if (camera) left.high.y -= needs.camera.least + kPanelGap;
    const auto stacked = Stack<2>({needs.character, needs.strips}, left, false);
    if (camera) {
      const Box& last = stacked[1] ? *stacked[1] : stacked[0].value_or(Box{left.low, left.low});
      const float above = stacked[0] || stacked[1] ? last.high.y + kPanelGap : top;
      boxes.camera = Scaled(
          Box{{edge, std::max(above, bottom - needs.camera.full)}, {left_end, bottom}}, scale);
    }
    boxes.character = Scaled(stacked[0], scale);
    boxes.strips = Scaled(stacked[1], scale);
  }
  if (two) {
    const auto stacked = Stack<3>({needs.devices, needs.interface, needs.boards},
                                  {{right_start, top}, {units.x - edge, bottom}}, true);
    boxes.devices = Scaled(stacked[0], scale);
    boxes.interface = Scaled(stacked[1], scale);
    boxes.boards = Scaled(stacked[2], scale);
  }
  const bool left_free = !boxes.character && !boxes.strips && !boxes.camera;
  const bool right_free = !boxes.devices && !boxes.interface && !boxes.boards;
  const float from = left_free ? edge : left_end + kPanelGap;
  const float to = std::max(from, right_free ? units.x - edge : right_start - kPanelGap);
  boxes.stamp = own_row ? Scaled({{edge, edge}, {units.x - edge, edge + kStampHeight}}, scale)
                        : Scaled({{from, edge}, {to, edge + kStampHeight}}, scale);
  boxes.middle = Scaled({{from, edge + kStampHeight + kPanelGap}, {to, bottom}}, scale);
  return boxes;
}

namespace {

std::optional<ImVec2> OnScreen(const scene::Camera& camera, const Eigen::Vector3f& at_m,
                               ImVec2 size) {
  const double aspect = static_cast<double>(size.x) / std::max(1.0f, size.y);
  const Eigen::Vector4f clip = camera.Projection(aspect) * camera.View() * at_m.homogeneous();
  if (clip.w() <= 0.05f) return std::nullopt;
  return ImVec2((0.5f + 0.5f * clip.x() / clip.w()) * size.x,
                (0.5f - 0.5f * clip.y() / clip.w()) * size.y);
}

ImU32 Ink(const scene::Colour& colour) {
  const auto byte = [](float linear) {
    return static_cast<int>(255 * std::pow(std::clamp(linear, 0.0f, 1.0f), 1 / 2.2f));
  };
  return IM_COL32(byte(colour.x()), byte(colour.y()), byte(colour.z()), 255);
}

bool Overlap(const Box& a, const Box& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

}  // namespace

void DrawLabels(const Paint& p, const scene::Picture& picture, const HudBoxes& boxes, ImVec2 size) {
  const float s = p.scale, height = 20 * s;
  std::vector<Box> panels, taken;
  for (const auto& panel : {boxes.character, boxes.strips, boxes.devices, boxes.interface,
                            boxes.boards, boxes.camera}) {
    if (panel) panels.push_back(*panel);
  }
  for (const scene::Label& label : picture.labels) {
    const auto at = OnScreen(picture.camera, label.at_m, size);
    if (!at) continue;
    const float width = p.WidthOf(p.fonts.small, label.text) + 12 * s;
    Box box{{at->x + 8 * s, at->y - height / 2}, {at->x + 8 * s + width, at->y + height / 2}};
    const auto meets = [&box](const Box& other) { return Overlap(box, other); };
    for (int tries = 0; tries < 8 && std::any_of(taken.begin(), taken.end(), meets); ++tries) {
      box.low.y -= height + 2 * s;
      box.high.y -= height + 2 * s;
    }
    if (std::any_of(panels.begin(), panels.end(), meets)) continue;
    taken.push_back(box);
    p.list->AddRectFilled(box.low, box.high, IM_COL32(14, 20, 27, 200), 6 * s);
    p.Write(p.fonts.small, {box.low.x + 6 * s, box.low.y + 2.5f * s}, Ink(label.colour),
            label.text);
  }
}

}  // namespace footing::render
