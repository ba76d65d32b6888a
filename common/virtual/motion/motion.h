#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "common/body/skeleton.h"

/// Recorded movement: files of motion capture and of force plates, as plain values in SI.
namespace footing::motion {

/// Limits of every reader, checked before memory is taken.
inline constexpr std::size_t kMostJoints = 1024;
inline constexpr std::size_t kMostDepth = 128;
inline constexpr std::size_t kMostColumns = 8192;
inline constexpr std::size_t kMostValues = 1u << 26;  ///< Frames times columns: 512 MiB.

/// A skeleton through time, one pose a column, at equal steps.
struct Motion {
  body::Skeleton skeleton;
  double rate_hz = 0;
  double start_s = 0;  ///< Time of the first frame on the recording's own clock.
  Eigen::MatrixXd q;   ///< dof x frames: m and rad.

  Eigen::Index frames() const { return q.cols(); }
  double duration_s() const { return rate_hz > 0 ? static_cast<double>(q.cols()) / rate_hz : 0; }
};

}  // namespace footing::motion
