#pragma once

#include <cstdint>

#include "common/board/plate.h"
#include "common/base/units.h"

namespace footing::tare {

struct DisplacementConfig {
  /// A board in the air hangs on its feet: its plate's some 3 kg leave the sensors; with one edge
  /// up it is about half of that. Under -1 kg for this long it is in somebody's hands.
  double lifted_n = -KilogramsToNewtons(1);
  double lifted_s = 0.5;
  /// Empty and at rest, a corner that is off by more than this while the total is not: the board
  /// stands on another floor than at its tare.
  double corner_n = 6;
  double empty_n = 6;
  double quiet_n = 1.5;  ///< Change of a corner from sample to sample at rest.
  double rests_s = 2;
};

/// Whether a tared board was moved. A plain value; it stays true until it is restarted.
///
/// What can be sensed is force across the plate alone. Lifting the board, or one edge of it, shows
/// while it is up; a board that was put down on another floor shows by its corners. Sliding or
/// turning it on the same floor, empty or under a person, changes no vertical force and cannot be
/// distinguished from standing; neither can anything while the board is off. The layout's check
/// (stand left, right, lean forward) is what finds those.
class Displacement {
 public:
  explicit Displacement(const DisplacementConfig& config = {}) : config_(config) {}

  /// Takes the next sample, tared. True once the board was moved.
  bool Advance(std::int64_t sampled_ns, const board::CornerForces& tared);
  bool moved() const { return moved_; }

 private:
  DisplacementConfig config_;
  bool started_ = false;
  bool moved_ = false;
  std::int64_t grounded_ns_ = 0;  ///< When it last stood on the floor.
  std::int64_t level_ns_ = 0;     ///< When it last was loaded, moving, or as at its tare.
  std::int64_t last_ns_ = 0;
  board::CornerForces last_;
};

}  // namespace footing::tare
