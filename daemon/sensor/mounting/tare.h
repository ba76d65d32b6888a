#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/base/units.h"
#include "common/board/geometry.h"

namespace footing::tare {

/// Limits that the samples of an empty board must keep.
struct TareConfig {
  /// An empty board stays within this; a person on it does not. Its own noise is 0.1 kg (recorded).
  double most_sd_n = 3;
  /// Between the means of the first and the last third.
  double most_trend_n = 3;
  double most_total_n = 98.0665;  ///< 10 kg.
  double least_rate_hz = 20;
  double longest_gap_s = 0.25;
};

/// A board's forces at one time.
struct TareSample {
  std::int64_t sampled_ns = 0;
  board::CornerForces forces;  ///< As measured, before any tare.
};

/// Result of a tare: the forces of the empty board, or why it was refused.
struct Tare {
  bool ok = false;
  std::string problem;         ///< Why it was refused.
  board::CornerForces offset;  ///< To take off every sample.
  double residual_n = 0;       ///< Standard deviation of the total over the window.
};

/// The mean of the samples, which must cover `window_s`; refused when the load moves, when it is
/// too heavy for an empty board, and when there are too few samples.
Tare SolveTare(std::span<const TareSample> samples, double window_s, const TareConfig& config = {});

/// Thresholds at which a tared board counts as moved.
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
/// Only force across the plate can be sensed. Lifting the board, or one edge of it, shows
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
