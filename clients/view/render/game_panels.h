#pragma once

#include "clients/view/render/hud_layout.h"
#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"
#include "common/stream/game.h"
#include "common/stream/user_interface.h"

namespace footing::render {

/// At the top of `space`, which it shortens: what happens in the terrain game, the time left, both
/// players with their parts and points, and what the builder holds. Draws as much of it as fits.
/// `game` is one to show (scene::ShowsGame).
void DrawGamePanel(const Paint& paint, const stream::GameState& game, Box& space);

/// At the top of `space`, which it shortens: the task, which the person at the controls must see
/// before the mark, and unless `task_alone` the trial's state, time, way to the finish line and
/// failed attempts. Draws nothing for a character without a trial to show.
void DrawTrialPanel(const Paint& paint, const scene::Model& model, const scene::CharacterPose& pose,
                    bool task_alone, Box& space);

/// Nothing without an interface.
PanelHeight InterfacePanelHeight(const stream::InterfaceState& state);

/// Estimate of the user interface: three gauges of the person's motion, its pace and its turn, with
/// the command of each of their parts, and below them the present command.
void DrawInterfacePanel(const Paint& paint, const Box& box, const stream::InterfaceState& state);

// The gauges of the interface panel. Each shows one quantity of the person's motion and, in the
// colours of the gaits, what its parts command. A caption stands in the lowest row of its box.

/// Right minus left limb: 0 at the top, where both move together and jump.
void DrawPhaseGauge(const Paint& paint, const Box& box, const stream::InterfaceState& state);
/// Walking below the border, running above it.
void DrawFrequencyGauge(const Paint& paint, const Box& box, const stream::InterfaceState& state);
/// An arm from the side: hanging it walks, bent it runs.
void DrawForearmGauge(const Paint& paint, const Box& box, const stream::InterfaceState& state);
/// The regions of the gait paper's figure 11.
void DrawStickGauge(const Paint& paint, const Box& box, const stream::InterfaceState& state);
void DrawButtonGauge(const Paint& paint, const Box& box, const stream::InterfaceState& state);
/// The load on both feet.
void DrawLoadGauge(const Paint& paint, const Box& box, const stream::InterfaceState& state);
/// Turn to either side, beyond the dead band.
void DrawTurnGauge(const Paint& paint, const Box& box, const stream::InterfaceState& state);

}  // namespace footing::render
