#pragma once

#include <optional>

#include "clients/view/render/paint.h"
#include "clients/view/scene/stage.h"

namespace footing::render {

/// Pixels per unit of the panels: 1 in a picture of 1280 x 720, 2 in one of 2560 x 1440. Never so
/// little that the letters cannot be read: `display_scale` is the display's own factor, 1 on a
/// common monitor.
float HudScale(ImVec2 size, float display_scale);

/// Heights that a panel asks for, in units; both 0 when it has nothing to show.
struct PanelHeight {
  float least = 0;
  float full = 0;
};

/// The panels of both columns, from the top.
struct HudNeeds {
  PanelHeight character, strips;           ///< Left.
  PanelHeight devices, interface, boards;  ///< Right.
  PanelHeight camera = {};                 ///< Left, at the bottom: it has its least in any case.
};

/// Places of all panels, pixels. No two boxes overlap. A panel without a box is left out: the
/// picture is too small for it.
struct HudBoxes {
  std::optional<Box> character, strips, devices, interface, boards, camera;
  Box stamp;   ///< One row; what must always be seen.
  Box middle;  ///< Between the columns, under the stamp: messages to the person.
};

/// Lays out the panels in a picture of `size`; `scale` is HudScale.
HudBoxes LayOut(ImVec2 size, float scale, const HudNeeds& needs);

/// The picture's labels beside their points, none over another; one that would stand under a panel
/// is left out.
void DrawLabels(const Paint& paint, const scene::Picture& picture, const HudBoxes& boxes,
                ImVec2 size);

}  // namespace footing::render
