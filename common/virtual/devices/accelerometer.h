#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/virtual/devices/noise.h"

/// Synthetic motion of two hands that swing a controller each, as the true specific force in the
/// sensor frame S (x left, y front, z down; at rest face up (0, 0, -9.81) m/s²), and its readings.
namespace footing::wrists {

/// One stretch of the script. What changes from the stretch before blends in over the first
/// `blend_s` of it (see HandMotion).
struct Segment {
  double duration_s = 1;
  double frequency_hz = 1;    ///< Cycles of one hand; ignored while the amplitude is 0.
  double phase_rad = 0;       ///< Right minus left: positive, the right one leads.
  double amplitude_mps2 = 0;  ///< Half peak to peak of each hand's swing; 0 is standing still.
  double roll_rad = 0;        ///< Left side higher is positive; both hands.
  double pitch_rad = 0;       ///< Front higher is positive; both hands.
};

/// The shape of one cycle: sin(p) + second sin(2p + second_phase_rad), scaled to the amplitude.
struct Shape {
  double second = 0;            ///< Share of the second harmonic; 0 is a plain sine.
  double second_phase_rad = 0;  ///< Its phase against the fundamental.
  /// Direction of the swing in S; need not be of unit length.
  Eigen::Vector3d direction_S = Eigen::Vector3d(0, 0.6, 0.8);
};

/// A wrist's swing: sharper at one end of its way than at the other.
Shape WristShape();

/// Specific force on both sensors, frame S, m/s2.
struct Hands {
  Eigen::Vector3d left_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d right_mps2 = Eigen::Vector3d::Zero();
};

/// The script made continuous: the left hand's angle is the integral of the blended frequency, the
/// right hand's is that plus the blended phase. A blend runs as 3u² - 2u³, the phase by the shorter
/// way.
class HandMotion {
 public:
  /// `blend_s` 0 changes at once. `start_angle_rad` is the left hand's angle at t = 0. Every
  /// duration and frequency must be positive and finite, `segments` not empty.
  HandMotion(std::vector<Segment> segments, const Shape& shape, double blend_s,
             double start_angle_rad = 0);

  /// At t_s since the start; before it the first instant, after the end the last segment goes on.
  Hands At(double t_s) const;
  double DurationSeconds() const { return duration_s_; }

 private:
  struct Piece {
    Segment from;
    Segment to;
    double start_s = 0;
    double start_angle_rad = 0;
    double blend_s = 0;
  };
  double AngleIn(const Piece& piece, double into_s) const;
  Eigen::Vector3d Swing(double angle_rad, double amplitude_mps2) const;

  std::vector<Piece> pieces_;
  Shape shape_;
  double duration_s_ = 0;
  double shape_half_range_ = 1;
};

/// Specific force at rest, inclined: ax = g sin(roll), ay = g sin(pitch), the rest along -z.
Eigen::Vector3d InclinedGravity(double roll_rad, double pitch_rad);

/// The errors of one accelerometer and the clock that reads it. SI units.
struct SensorModel {
  double rate_hz = 100;
  /// Reading instants are off by up to this, evenly, either way; keep it below half a period.
  double jitter_s = 0;
  double noise_mps2 = 0.0304;  ///< rms an axis; ADXL330, 3.1 mg.
  double quantum_mps2 =
      0.373;                  ///< One count; 38 mg of the 8-bit reports, 0.092 of 10 bits, 0 none.
  double range_mps2 = 29.42;  ///< Clips beyond +- this (3 g, the sensor's own range).
};

/// One sample of an accelerometer.
struct SensorReading {
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;  ///< Bits 0, 1, 2: x, y, z.
};

/// Reading of the sensor for a true specific force: noise, then counts, then the end of the range.
SensorReading Read(const SensorModel& model, const Eigen::Vector3d& true_mps2,
                   noise::Random& random);

/// Samples of both hands at one instant.
struct TimedReading {
  std::int64_t sampled_ns = 0;
  SensorReading left;
  SensorReading right;
};

/// The motion as both sensors record it, from 0 to its end (`start_ns` is added to every stamp).
std::vector<TimedReading> Record(const HandMotion& motion, const SensorModel& model,
                                 std::uint64_t seed, std::int64_t start_ns = 0);

}  // namespace footing::wrists
