#pragma once

#include <vector>

#include "common/stream/character.h"
#include "daemon/offline/analysis/gait_style.h"
#include "daemon/offline/tune/dimension.h"

/// Costs and gains of a search of the style (docs/gait.md, "Style").
namespace footing::tune {

/// Costs of the measures of `footing-eval style`, beside the published curves. Each term is x^2 /
/// (1 + x^2) with x the deviation over what is tolerated: never 1, so that a fall stays worse than
/// all of them, and never flat, so that a search always sees where it gets better.
struct StyleCost {
  double cadence = 0;    ///< Deviation from Alexander's curve; 15 %.
  double bob = 0;        ///< Walking: from Orendurff's, lowest in double support; 10 mm.
  double roll = 0;       ///< Walking: from Saunders', amplitude and phase; 2 degrees.
  double yaw = 0;        ///< As roll.
  double slide = 0;      ///< Furthest of a foot in a stance; 5 mm.
  double jerk = 0;       ///< COM, rms; 500 m/s^3.
  double transport = 0;  ///< Cost of transport; 0.5.

  double total() const { return cadence + bob + roll + yaw + slide + jerk + transport; }
};

/// Adds a part of a cost to another one.
void AddShare(const StyleCost& cost, double share, StyleCost& sum);

/// Nothing of a gait that did not make a whole step. `steady`: at one speed, else the curves say
/// nothing and only slide, jerk and transport are charged.
StyleCost StyleCostOf(stream::Gait gait, const style::GaitStyle& style, double weight_n,
                      bool steady);

/// Whether there is a style that can be searched: of walking and running.
bool HasStyle(stream::Gait gait);

/// Gains of the style with a term that scores them. The pitch within a step, the look ahead to the
/// foothold and where the style fades have none, and stay as set by hand.
std::vector<Dimension> StyleDimensionsOf(stream::Gait gait);

}  // namespace footing::tune
