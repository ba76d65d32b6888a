#pragma once

#include <array>
#include <cstddef>

#include "daemon/simulation/momentum/contact_loads.h"

namespace footing::simulation {

inline constexpr std::size_t kBoardCells = 4;

/// What a board's cells have felt until its newest sample. Samples come irregularly, in ticks, and
/// the engine has steps of its own: a load that is held until the next one comes counts for too
/// long or too short a time, which a velocity keeps. An impulse is right whenever it is looked at.
struct BoardImpulse {
  bool valid = false;
  double sampled_s = 0;  ///< Of the newest sample, on the sensor daemon's clock.
  std::array<double, kBoardCells> impulse_ns{};  ///< N s, since any time.
};

/// Adds samples up (trapezoids). Longer gaps, and samples out of order, add nothing.
class ImpulseMeter {
 public:
  static constexpr double kMostGapS = 0.2;

  /// A sample without a time (0) makes it invalid.
  void Add(double sampled_s, const std::array<double, kBoardCells>& load_n);
  const BoardImpulse& impulse() const { return impulse_; }

 private:
  BoardImpulse impulse_;
  std::array<double, kBoardCells> load_n_{};
};

/// Plays the impulses of two boards in steps of its own time, a little later than they come, as
/// mean loads whose sum over time is that of the samples. A plain value of fixed size.
class LoadPlayer {
 public:
  /// So long after the newest sample of both: the time between two ticks, and half as much.
  static constexpr double kDelayS = 0.015;

  void Take(std::size_t foot, const BoardImpulse& impulse);
  /// The next step: writes the cells' mean loads over it. False, and nothing written, where there
  /// is too little to play; then it begins anew.
  bool Advance(double step_s, std::array<momentum::FootLoads, momentum::kFeet>& feet);

 private:
  using Cells = std::array<double, kBoardCells>;
  struct Point {
    double sampled_s = 0;
    Cells impulse_ns{};
  };
  /// The newest points of one board.
  struct Track {
    static constexpr std::size_t kPoints = 8;
    std::array<Point, kPoints> points{};
    std::size_t count = 0;
    Cells told_ns{};

    const Point& Newest(std::size_t back) const { return points[(count - 1 - back) % kPoints]; }
    std::size_t size() const { return count < kPoints ? count : kPoints; }
    /// In proportion between two points, and as it went on last after the newest.
    Cells At(double time_s) const;
  };

  std::array<Track, momentum::kFeet> tracks_;
  bool playing_ = false;
  double time_s_ = 0;
};

}  // namespace footing::simulation
