#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "common/stream/sensor.h"
#include "daemon/sensor/features/config.h"

namespace footing::features {

/// The grid that all controllers share: instants n * 10 ms of the host's clock. 100 Hz is the
/// Wiimote's own rate, so hardly anything is lost, and lags are whole numbers on it.
inline constexpr double kGridHz = 100;
inline constexpr double kGridStepS = 1 / kGridHz;
inline constexpr std::int64_t kGridStepNs = 10'000'000;
/// What is kept: two periods of the lowest frequency and some.
inline constexpr int kGridLength = 520;

/// The newest samples of one controller on the uniform grid, oldest first. Columns x, y, z in S,
/// m/s². Arrivals are irregular (bursts, repeats, losses), correlations need even steps, so values
/// between samples lie on the line between them.
class SampleGrid {
 public:
  using Samples = Eigen::Matrix<double, 2 * kGridLength, 3>;

  explicit SampleGrid(const Config& config) : config_(config) {}

  /// Takes a sample by its sampled_ns. Not finite, or not newer than the one before by less than
  /// the longest pause: ignored. After a longer pause, or a jump back beyond it, all before is
  /// forgotten.
  void Add(const stream::MotionSample& sample);

  /// How many grid points there are, at most kGridLength.
  int size() const { return end_ - begin_; }
  /// How often the grid was restarted.
  std::uint32_t beginnings() const { return beginnings_; }
  /// Instant of the newest sample taken; meaningless while empty.
  std::int64_t newest_ns() const { return last_ns_; }
  /// Index on the grid of the host's clock of the newest point.
  std::int64_t newest_index() const { return next_index_ - 1; }

  /// The newest `count` points, count <= size().
  auto Filtered(int count) const { return filtered_.middleRows(end_ - count, count); }
  auto Raw(int count) const { return raw_.middleRows(end_ - count, count); }
  /// Clipped axes (bits 0, 1, 2) of the point `back` steps before the newest.
  std::uint32_t ClippedAxes(int back) const { return clipped_[end_ - 1 - back]; }

 private:
  struct Knot {
    std::int64_t time_ns = 0;
    Eigen::Vector3d raw = Eigen::Vector3d::Zero();
    Eigen::Vector3d filtered = Eigen::Vector3d::Zero();
    std::uint32_t clipped = 0;
  };
  void Start(const Knot& knot);
  void Append(const Knot& knot);
  void Push(const Eigen::Vector3d& raw, const Eigen::Vector3d& filtered, std::uint32_t clipped);

  Config config_;
  bool started_ = false;
  std::int64_t last_ns_ = 0;  ///< Of the last sample, repeats included.
  Knot knot_;                 ///< The last one that said something new.
  std::int64_t next_index_ = 0;
  Samples raw_ = Samples::Zero();
  Samples filtered_ = Samples::Zero();
  std::array<std::uint32_t, 2 * kGridLength> clipped_{};
  std::uint32_t beginnings_ = 0;
  int begin_ = 0;
  int end_ = 0;
};

}  // namespace footing::features
