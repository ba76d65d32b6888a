#pragma once

#include "clients/view/render/hud_layout.h"
#include "common/stream/user_interface.h"

namespace footing::render {

/// Nothing without an interface.
PanelHeight InterfacePanelHeight(const stream::InterfaceState& state);

/// What the user interface believes that the person does: three gauges of the motion, its pace and
/// its turn, with what each part of them commands, and below them the command.
void DrawInterfacePanel(const Paint& paint, const Box& box, const stream::InterfaceState& state);

}  // namespace footing::render
