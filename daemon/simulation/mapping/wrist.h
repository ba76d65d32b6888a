#pragma once

#include "daemon/simulation/biped/command.h"
#include "daemon/simulation/mapping/wrist_features.h"
#include "daemon/simulation/mapping/wrist_mapping.h"

namespace footing::mapping {

/// The wrist interface of the gait paper, section 7: two controllers swung from the wrists.
///
/// | motion                        | command                                                   |
/// |-------------------------------|-----------------------------------------------------------|
/// | a hand rests or is missing    | stepping in place                                         |
/// | in phase                      | jump; height by amplitude, speed by frequency             |
/// | out of phase, below 2 Hz      | walk, speed by frequency                                  |
/// | out of phase, above 2 Hz      | run, speed by frequency                                   |
/// | inclined beyond the dead band | besides, 5 degrees a step towards the lower side          |
///
/// Left side higher (positive roll) leans to the right, so it turns right, which is negative.
/// Every border has hysteresis. While features of moving hands are not valid the last command
/// goes on, for at most hold_s. A plain value.
class WristInterface {
 public:
  explicit WristInterface(const WristMapping& mapping) : mapping_(mapping) {}

  /// The command for new features at `time_s`; times must not decrease.
  biped::GaitCommand Advance(double time_s, const WristFeatures& features);
  /// Without new features: as if the hands rested.
  biped::GaitCommand Rest();

 private:
  stream::Gait GaitOf(double phase_rad, double frequency_hz) const;
  double TurnOf(const WristFeatures& features) const;

  WristMapping mapping_;
  biped::GaitCommand command_;
  double valid_time_s_ = 0;
};

}  // namespace footing::mapping
