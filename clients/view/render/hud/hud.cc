#include "clients/view/render/hud/hud.h"

#include "clients/view/render/hud/board_panel.h"
#include "clients/view/render/hud/body_panel.h"
#include "clients/view/render/hud/character_panel.h"
#include "clients/view/render/hud/device_panel.h"
#include "clients/view/render/hud/labels.h"
#include "clients/view/render/hud/layout_panel.h"
#include "clients/view/render/hud/overlay.h"
#include "clients/view/render/hud/strip_panel.h"
#include "clients/view/render/hud/t_pose_panel.h"

namespace footing::render {
namespace {

constexpr float kEdge = 18;
constexpr float kColumnWidth = 300;
constexpr float kBoardWidth = 292;
constexpr float kBoardHeight = 236;

}  // namespace

void DrawHud(const Paint& p, const scene::Picture& picture, const scene::Model& model,
             const scene::WorldFrame& frame, std::int64_t now_ns, const HudOptions& options,
             ImVec2 size) {
  // A stand-in's data is never shown unstamped, in subject mode either.
  if (scene::IsSimulated(model)) DrawSimulated(p, size);
  DrawReplay(p, model, now_ns, size);
  if (options.hidden) return;
  const float s = p.scale, edge = kEdge * s;
  if (scene::IsWaiting(model)) {
    DrawWaiting(p, model, size);
  } else {
    float y = edge;
    const bool person = !frame.characters.empty() && frame.characters.front().body;
    if (person) {
      DrawLabels(p, picture, size);
      y = DrawBodyPanel(p, {edge, edge}, frame.characters.front(), picture) + 8 * s;
      DrawTPosePanel(p, model, frame.characters.front(), size);
    } else if (!frame.characters.empty()) {
      y = DrawCharacterPanel(p, {edge, edge}, model, frame.characters.front(), options.phases,
                             now_ns) +
          8 * s;
    }
    if (!person) {
      DrawStripPanel(p, {{edge, y}, {edge + kColumnWidth * s, size.y - edge}}, model.strips,
                     now_ns);
    }
    DrawDevicePanel(p, {size.x - edge, edge}, model, now_ns);
    const Box boards{{size.x - edge - kBoardWidth * s, size.y - edge - kBoardHeight * s},
                     {size.x - edge, size.y - edge}};
    if (person) {
      DrawLayoutPanel(p, boards, model, frame.characters.front(), now_ns);
    } else {
      DrawBoardPanel(p, boards, model, now_ns);
    }
    DrawWaitingLines(p, model, {edge + (kColumnWidth + 12) * s, size.y - edge});
    DrawNote(p, model, now_ns, size);
  }
  if (options.frozen) {
    p.Label({size.x / 2 - 30 * s, 128 * s}, colour::kText, IM_COL32(20, 20, 20, 255), "frozen");
  }
  if (options.keys) DrawKeys(p, size);
}

}  // namespace footing::render
