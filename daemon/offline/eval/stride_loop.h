#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace footing::eval {

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
