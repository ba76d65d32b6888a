#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "common/stream/sensor.h"
#include "daemon/sensor/features/config.h"

namespace footing::features {

/// The grid that all controllers share: instants n * 10 ms of the host's clock. 100 Hz is the
/// Wiimote's own rate, so hardly anything is lost, and lags are whole numbers on it.
inline constexpr double kGridHz = 100;
inline constexpr double kGridStepS = 1 / kGridHz;
inline constexpr std::int64_t kGridStepNs = 10'000'000;
/// Samples kept: two periods of the lowest frequency and some.
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
  std::int64_t last_ns_ = 0;  ///< Time of the last sample, repeats included.
  Knot knot_;                 ///< The last one that said something new.
  std::int64_t next_index_ = 0;
  Samples raw_ = Samples::Zero();
  Samples filtered_ = Samples::Zero();
  std::array<std::uint32_t, 2 * kGridLength> clipped_{};
  std::uint32_t beginnings_ = 0;
  int begin_ = 0;
  int end_ = 0;
};

/// The direction, of unit length, along which the means of the cycles of `steps` grid points spread
/// over the newest `points`: that in which gravity moves while a wrist twists. Zero when they
/// hardly spread, or when little of the swing is left across it.
Eigen::Vector3d FindTwist(const SampleGrid& grid, int points, double steps,
                          const CadenceConfig& config);

/// Whether a controller moves (section 6, feature 1).
struct Moving {
  bool moving = false;
  /// Grid index of the first point that belongs to the motion, or of the first still one after it.
  std::int64_t since_index = 0;
  /// The period that the window is cut to, 0 while none was known since then. It follows a shorter
  /// one at once, a longer one only once that has lasted: a stop looks like a longer period at
  /// first.
  double period_s = 0;
  /// Grid index since which the period has been longer; 0 while it is not.
  std::int64_t longer_since_index = 0;
};

/// Standard deviation over the newest `count` filtered points: root of the sum of the three axes'
/// variances, m/s². 0 for fewer than two.
double Deviation(const SampleGrid& grid, int count);

/// The state after the newest point. `period_s` is the length of a cycle, 0 while unknown.
Moving Next(const Moving& before, const SampleGrid& grid, double period_s,
            const MovingConfig& config);

}  // namespace footing::features
