#pragma once

#include <cstdint>
#include <optional>

#include "common/stream/user_interface.h"

/// Synthetic users: what they see, what they want, and how their bodies do it. Frames: world W
/// (x forward, y left, z up), sensor S of a Wiimote (x left, y front, z down). SI units.
namespace footing::users {

/// What makes a user an individual.
struct Style {
  double reaction_s = 0.3;     ///< From the picture to a decision; 0.2 to 0.4.
  double favourite_mps = 2.6;  ///< Speed of running; 2.2 to 3.
  double amplitude = 1;        ///< Of every motion, as a share of an ordinary one; 0.85 to 1.2.
  double asymmetry = 0;        ///< Left larger, right smaller by this share; -0.1 to 0.1.
  double tempo = 1;            ///< Frequencies as a share of ordinary ones; 0.94 to 1.06.
  double tempo_drift = 0.03;   ///< Standard deviation of its slow change, as a share.
  double phase_error_rad = 0;  ///< By which alternate limbs are off half a cycle; -0.25 to 0.25.
  double timing_s = 0.1;       ///< Standard deviation of the moment of a jump; 0.05 to 0.15.
  double left_grip_rad = 0;    ///< Rotation of the remote about its front, left side up.
  double right_grip_rad = 0;   ///< The same of the right one.
  double mass_kg = 70;         ///< 50 to 95.
  double height_m = 1.72;      ///< 1.55 to 1.95.
};

/// How a user moves, where it is not as drawn.
struct StyleWish {
  std::optional<double> tempo, amplitude, asymmetry;
};

/// Evenly within the ranges above; the remotes as they should be held.
Style DrawStyle(std::uint64_t seed);
/// The same person with the remotes as people hold and wear them: each by its own up to
/// MostGrip(interface) off.
Style DrawStyle(std::uint64_t seed, stream::UserInterface interface);

/// How far a remote is rotated, rad. In the hands of swinging arms, where nobody looks at it, by 45
/// degrees (the gait paper names different grips as a difficulty of that interface). Wrists hold it
/// buttons up in sight, and shins wear it with a mounting: a few degrees. No stick and no board can
/// be rotated.
double MostGrip(stream::UserInterface interface);

}  // namespace footing::users
