#pragma once

#include "common/stream/sensor.h"

namespace footing::mapping {

/// What the wrist interface needs of one controller (gait paper, section 6).
struct HandFeatures {
  bool present = false;
  bool moving = false;
  bool frequency_valid = false;
  double frequency_hz = 0;
  bool amplitude_valid = false;
  double amplitude_mps2 = 0;  ///< Half peak to peak of the raw samples over one cycle.
  bool inclination_valid = false;
  double roll_rad = 0;  ///< Left side higher is positive.
};

/// The features of a left and a right hand at one instant, of fixed size: copying allocates
/// nothing, so it can pass to the simulation thread.
struct WristFeatures {
  HandFeatures left;
  HandFeatures right;
  bool phase_valid = false;
  double phase_rad = 0;    ///< Right minus left, in (-pi, pi].
  bool simulated = false;  ///< A stand-in is among the devices.
};

/// Picks the devices with the roles left_hand and right_hand and the pair they form. A hand that
/// the rig lacks is not present; values that are not finite count as not valid.
WristFeatures ToWristFeatures(const stream::RigFeatures& rig);

}  // namespace footing::mapping
