#pragma once

#include "common/stream/track.h"
#include "common/body/piece.h"

/// The terrain editor (gait paper, section 8.2 and figure 13): "create a slope by inclining the
/// Wiimote vertically, a curve by inclining the Wiimote sideways, and a step by pushing button A
/// and inclining the Wiimote vertically"; the terrain is 4 m wide, slopes are within 5 degrees,
/// curves within 15 degrees, steps within 10 cm. How the inclination is scaled to these limits, and
/// how long a segment is, the paper does not say.
namespace footing::game {

/// What the builder does with the device of the role editor.
struct Hand {
  bool known = false;    ///< False: nothing has come from it for a while; the ground stays level.
  double roll_rad = 0;   ///< Left side higher is positive: inclined to the right.
  double pitch_rad = 0;  ///< Front higher is positive.
  bool a = false;        ///< Button A is held: a step in place of a slope.
  bool b = false;        ///< Button B is held: a pit, where pits are allowed.
};

using track::Piece;

/// Inclinations within this are level, rad: nobody holds a hand quite still.
inline constexpr double kDeadZoneRad = 0.105;  // 6 degrees.
/// At this inclination and beyond a property is at its limit, rad; between, it grows evenly.
inline constexpr double kFullRad = 0.785;  // 45 degrees: the wrist goes no further at ease.

/// The piece that the hand asks for at the track's end: within the paper's limits, and one that an
/// extendable track takes. Curves do not turn the track by more than 90 degrees from its start's
/// direction, so that it never runs into itself; after a pit come neither a pit nor a curve. Its
/// length is the way of about 1 s at `speed_mps`, within 2 and 4 m. `track` is not empty.
Piece Held(const Hand& hand, const stream::Track& track, double speed_mps, bool pits);

}  // namespace footing::game
