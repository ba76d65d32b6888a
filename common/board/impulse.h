#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "common/board/geometry.h"

/// The one way from a board's samples to an even rate: by their impulses.
///
/// Samples come irregularly, in ticks of their own, and whoever uses them has steps of a third
/// clock. A load that is held until the next sample counts for too long or too short a time, and
/// a velocity keeps that error. A mean over a window around an instant (SWARII) loses no impulse
/// either, but comes half a window and a sample late. Impulses are added up by the samples' own
/// times and are right whenever they are looked at; a step gets the mean load of its own time.
namespace footing::board {

/// What a board's cells have felt until its newest sample.
struct BoardImpulse {
  bool valid = false;
  double sampled_s = 0;  ///< Of the newest sample, on the sensor daemon's clock.
  Corners impulse_ns{};  ///< N s, since any time.
};

/// Adds samples up (trapezoids). Longer gaps, and samples out of order, add nothing.
class ImpulseMeter {
 public:
  static constexpr double kMostGapS = 0.2;

  /// A sample without a time (0) makes it invalid.
  void Add(double sampled_s, const Corners& load_n);
  const BoardImpulse& impulse() const { return impulse_; }

 private:
  BoardImpulse impulse_;
  Corners load_n_{};
};

/// Plays the impulses of two boards in steps of its own time, a little later than they come, as
/// mean loads whose sum over time is that of the samples. A plain value of fixed size.
class LoadPlayer {
 public:
  static constexpr std::size_t kBoards = 2;
  /// Delay behind the newest sample of both: the time between two ticks, and half as much.
  static constexpr double kDelayS = 0.015;

  void Take(std::size_t board, const BoardImpulse& impulse);
  /// The mean loads of each board's cells over the next step, N. None where there is too little to
  /// play; then it starts again.
  std::optional<std::array<Corners, kBoards>> Advance(double step_s);
  /// Starts again with the next step.
  void Restart() { playing_ = false; }

 private:
  struct Point {
    double sampled_s = 0;
    Corners impulse_ns{};
  };
  /// The newest points of one board.
  struct Track {
    static constexpr std::size_t kPoints = 8;
    std::array<Point, kPoints> points{};
    std::size_t count = 0;
    Corners played_ns{};

    const Point& Newest(std::size_t back) const { return points[(count - 1 - back) % kPoints]; }
    std::size_t size() const { return count < kPoints ? count : kPoints; }
    /// In proportion between two points, and as it went on last after the newest.
    Corners At(double time_s) const;
  };

  std::array<Track, kBoards> tracks_;
  bool playing_ = false;
  double time_s_ = 0;
};

}  // namespace footing::board
