#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "common/stream/setup.h"

/// A Balance Board as a force plate: where its sensors are, what its corner forces mean, where
/// boards lie. Everything that knows a board's dimensions takes them from here.
namespace footing::board {

/// A board as it is built (Leach et al. 2014, Sensors 14:18244). footingd's config may state other
/// distances between the sensors, and publishes those in force with the layout.
inline constexpr stream::BoardGeometry kBalanceBoard{.plate_x_m = 0.511,
                                                     .plate_y_m = 0.316,
                                                     .sensor_distance_x_m = 0.433,
                                                     .sensor_distance_y_m = 0.238};
/// Height of the plate's surface over the floor.
inline constexpr double kPlateHeightM = 0.053;

/// Total load above which somebody is in contact with a board, and below which nobody is: 7 and 5
/// kg. Above the lower one the COP is defined.
inline constexpr double kContactOnN = 68.6;
inline constexpr double kContactOffN = 49.0;

/// Range of a sensor distance and of a plate's side.
inline constexpr double kLeastLengthM = 0.1;
inline constexpr double kMostLengthM = 1;

/// Corners in the order top left, top right, bottom left, bottom right; "top" is the front edge,
/// away from the power button.
inline constexpr std::size_t kCorners = 4;
using Corners = std::array<double, kCorners>;
inline constexpr Corners kCornerRight{-1, 1, -1, 1};  ///< Signs in P.
inline constexpr Corners kCornerFront{1, 1, -1, -1};

/// Whether every length is finite and within its range.
bool IsSound(const stream::BoardGeometry& geometry);

/// The published geometry of a board, or a Balance Board's where none was published or it is not
/// sound.
stream::BoardGeometry GeometryOr(const std::optional<stream::BoardGeometry>& published);

/// A point of the plate frame P (x right, y front) in W. With yaw 0 the plate's front points
/// forward.
Eigen::Vector2d InWorld(const stream::BoardPose& pose, double right_m, double front_m);

/// The place of each corner's sensor in W.
std::array<Eigen::Vector2d, kCorners> SensorPlaces(
    const stream::BoardPose& pose, const stream::BoardGeometry& geometry = kBalanceBoard);

/// Where the sensors are, and when somebody stands on them.
struct PlateConfig {
  stream::BoardGeometry geometry = kBalanceBoard;
  double contact_on_n = kContactOnN;
  double contact_off_n = kContactOffN;
};

/// N, upwards on the sensors positive.
struct CornerForces {
  double top_left_n = 0;
  double top_right_n = 0;
  double bottom_left_n = 0;
  double bottom_right_n = 0;

  bool operator==(const CornerForces&) const = default;
};

/// Nothing is clamped: forces below zero after a tare are as true as those above.
CornerForces operator-(const CornerForces& a, const CornerForces& b);

/// Sum of the four corners' forces, N.
double Total(const CornerForces& forces);

/// Centre of pressure in the plate frame P, m.
struct PlatePoint {
  double x_m = 0;
  double y_m = 0;
};

/// COP of forces with this total, which is not 0: x = dx/2 (right - left) / total,
/// y = dy/2 (front - rear) / total, with the distances between the sensors.
PlatePoint CentreOfPressure(const CornerForces& forces, double total_n,
                            const stream::BoardGeometry& geometry);

/// In the plate frame P.
struct PlateReading {
  double total_n = 0;
  bool cop_valid = false;
  double cop_x_m = 0;  ///< 0 while it is not valid, never NaN.
  double cop_y_m = 0;
  bool contact = false;
  bool repeated = false;  ///< Bit for bit the reading before: the board samples at about 60 Hz.
};

/// One board as a force plate: corner forces to total, centre of pressure and contact. A plain
/// value.
class Plate {
 public:
  explicit Plate(const PlateConfig& config = {}) : config_(config) {}

  /// Takes the next sample. The forces must be finite.
  PlateReading Advance(const CornerForces& forces);

 private:
  PlateConfig config_;
  bool started_ = false;
  bool contact_ = false;
  CornerForces last_;
};

// The one way from a board's samples to an even rate: by their impulses.
//
// Samples come irregularly, in ticks of their own, and whoever uses them has steps of a third
// clock. A load that is held until the next sample counts for too long or too short a time, and
// a velocity keeps that error. A mean over a window around an instant (SWARII) loses no impulse
// either, but comes half a window and a sample late. Impulses are added up by the samples' own
// times and are right whenever they are looked at; a step gets the mean load of its own time.

/// Impulses on a board's cells until its newest sample.
struct BoardImpulse {
  bool valid = false;
  double sampled_s = 0;  ///< Time of the newest sample, on the sensor daemon's clock.
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
