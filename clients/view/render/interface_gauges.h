#pragma once

#include "clients/view/render/paint.h"
#include "common/stream/user_interface.h"

/// The gauges of the interface panel. Each shows one quantity of the person's motion and, in the
/// colours of the gaits, what its parts command. A caption stands in the lowest row of its box.
namespace footing::render {

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
/// To which side it turns, beyond the dead band.
void DrawTurnGauge(const Paint& paint, const Box& box, const stream::InterfaceState& state);

}  // namespace footing::render
