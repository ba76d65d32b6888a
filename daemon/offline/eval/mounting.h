#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/stream/device.h"
#include "daemon/sensor/features/config.h"

namespace footing::eval {

/// True features at an instant of a walk.
struct WalkTruth {
  double frequency_hz = 0;
  double phase_rad = 0;
  double amplitude_mps2[2] = {0, 0};
  double roll_rad[2] = {0, 0};
  double pitch_rad[2] = {0, 0};
};

/// Somebody with two sensors who stands, takes three steps, stands, and walks: the specific force
/// of each in its perfect mounting's frame M (see daemon/sensor/mounting), left then right.
struct MountingWalk {
  std::string what;
  stream::DeviceRole roles[2] = {};
  double still_from_s = 0;
  double still_to_s = 0;
  double steps_to_s = 0;  ///< The steps begin where standing still ends.
  double walk_from_s = 0;
  double end_s = 0;
  std::function<Eigen::Vector3d(int side, double t_s)> force_M_mps2;
  /// None where a change is too fresh for features to have settled, and before the walk.
  std::function<std::optional<WalkTruth>(double t_s)> truth;
};

/// Two wrists by common/virtual/devices: swings of 0.9, 1.2 and 1.6 Hz, inclined by up to 15
/// degrees.
MountingWalk SyntheticWalk();

/// Two shins of a person on motion capture: `standing` and `walking` are TRC files with the same
/// markers (metres, y up; names as OpenCap's: L_knee, L_ankle, L_shank_antsup, r_...; L.ASIS,
/// L.PSIS, r.ASIS, r.PSIS). The recorded stride is repeated, since recordings are short; the three
/// steps are that stride too, each leg from its own mid-stance and back to it. Truth is what the
/// features say of the same walk without noise and counts.
Result<MountingWalk> RecordedWalk(const std::string& standing, const std::string& walking);

/// The walk `trials` times, each time with both sensors turned at random: errors of the features
///
///   perfect  of the same sensors mounted perfectly
///   solved   turned, the rotation solved from standing and three steps
///
/// and how each solved rotation differs from the true one. Sensors round as footingd's reports and
/// their own calibrations do. `bar` is 1.5 times the 95th percentile of what perfect reaches;
/// `declared_bar` 1.5 times what `features --synthetic` holds a perfect mounting to.
nlohmann::json MeasureMounting(const MountingWalk& walk, int trials, std::uint64_t seed,
                               const features::Config& config = {});

/// A quantity frame by frame.
using Track = std::vector<Eigen::Vector3d>;

/// Worse than any mismatch that occurs.
inline constexpr double kWorstMismatch = 1e9;

/// Frames either side; Smoothed twice spans 50 ms at 100 Hz.
inline constexpr int kSmoothFrames = 2;

/// Without the noise of markers: the mean over kSmoothFrames either side.
Track Smoothed(const Track& track);

/// How badly a track repeats itself after `period` frames; kWorstMismatch where too few show it.
double Mismatch(const Track& track, std::size_t period);

/// One stride as a loop: where the recording goes on beyond it, end and beginning are blended.
Track Loop(const Track& track, std::size_t period);

/// A loop at a frame between frames, before its beginning or beyond its end.
Eigen::Vector3d At(const Track& loop, double index);

/// The frame of the stride in which the shin feels most nearly what it feels standing: mid-stance.
std::size_t MidStance(const Track& loop, const Eigen::Vector3d& standing, double rate_hz);

}  // namespace footing::eval
