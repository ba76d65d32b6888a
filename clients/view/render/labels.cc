#include "clients/view/render/labels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace footing::render {
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
