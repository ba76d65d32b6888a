#pragma once

#include "common/board/heel_rise.h"
#include "common/board/stance.h"
#include "common/board/step_cadence.h"

namespace footing::study::ranges {

/// What a person on two boards does at one instant, with the recognisers of the interface boards.
struct BoardMotion {
  bool stands = false;  ///< Somebody stands on the boards.
  bool steps = false;   ///< In place, for longer than a cycle, and this step is not late.
  double foot_hz = 0;   ///< While stepping, of one foot in the last two steps.
  bool leans_known = false;
  double lean_right = 0;  ///< Share of the load, -1 to 1; stepping the mean of two steps.
  bool rose = false;      ///< A heel rise's push is over.
  double rise_share = 0;  ///< Load above the weight in that push, as its share.
};

/// Follows a person on two boards. A plain value.
class BoardMeter {
 public:
  BoardMeter();

  /// Times must not decrease.
  BoardMotion Advance(double time_s, const board::Stance& stance);

 private:
  board::Weight weight_;
  board::StepCadence steps_;
  board::HeelRise rise_;
  bool begun_ = false;
  double time_s_ = 0;
  double stands_until_s_ = 0;  ///< When the feet began to take turns, or now.
  double rose_s_ = -1;         ///< When a rise was recognised whose push goes on; negative: none.
  double push_ = 0;            ///< Of that rise, so far.
};

}  // namespace footing::study::ranges
