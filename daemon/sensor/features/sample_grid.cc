#include "daemon/sensor/features/sample_grid.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "common/base/units.h"
#include "daemon/sensor/features/cycle.h"

namespace footing::features {
namespace {

/// The first grid index at or after an instant.
std::int64_t IndexAtOrAfter(std::int64_t time_ns) {
  const std::int64_t index = time_ns / kGridStepNs;
  return index * kGridStepNs < time_ns ? index + 1 : index;
}

}  // namespace

void SampleGrid::Start(const Knot& knot) {
  started_ = true;
  ++beginnings_;
  begin_ = end_ = 0;
  knot_ = knot;
  last_ns_ = knot.time_ns;
  next_index_ = IndexAtOrAfter(knot.time_ns);
  if (next_index_ * kGridStepNs == knot.time_ns) {
    Push(knot.raw, knot.filtered, knot.clipped);
    ++next_index_;
  }
}

void SampleGrid::Push(const Eigen::Vector3d& raw, const Eigen::Vector3d& filtered,
                      std::uint32_t clipped) {
  if (end_ == 2 * kGridLength) {
    const int kept = kGridLength - 1;
    raw_.topRows(kept) = raw_.middleRows(end_ - kept, kept).eval();
    filtered_.topRows(kept) = filtered_.middleRows(end_ - kept, kept).eval();
    std::copy(clipped_.end() - kept, clipped_.end(), clipped_.begin());
    begin_ = 0;
    end_ = kept;
  }
  raw_.row(end_) = raw.transpose();
  filtered_.row(end_) = filtered.transpose();
  clipped_[end_] = clipped;
  ++end_;
  begin_ = std::max(begin_, end_ - kGridLength);
}

void SampleGrid::Append(const Knot& knot) {
  const double span = static_cast<double>(knot.time_ns - knot_.time_ns);
  for (; next_index_ * kGridStepNs <= knot.time_ns; ++next_index_) {
    const double share = static_cast<double>(next_index_ * kGridStepNs - knot_.time_ns) / span;
    std::uint32_t clipped = 0;
    if (share > 0) clipped |= knot.clipped;
    if (share < 1) clipped |= knot_.clipped;
    Push(knot_.raw + share * (knot.raw - knot_.raw),
         knot_.filtered + share * (knot.filtered - knot_.filtered), clipped);
  }
  knot_ = knot;
}

void SampleGrid::Add(const stream::MotionSample& sample) {
  if (!sample.specific_force_mps2.allFinite() || !sample.filtered_mps2.allFinite()) return;
  const Knot knot{sample.sampled_ns, sample.specific_force_mps2, sample.filtered_mps2,
                  sample.clipped_axes};
  const double since_s = NanosecondsToSeconds(sample.sampled_ns - last_ns_);
  if (!started_ || std::abs(since_s) > config_.longest_pause_s) {
    Start(knot);
    return;
  }
  if (since_s <= 0) return;
  last_ns_ = sample.sampled_ns;
  const double unknown_s = NanosecondsToSeconds(sample.sampled_ns - knot_.time_ns);
  if (sample.repeated && unknown_s < config_.longest_repeat_s) return;
  Append(knot);
}

namespace {

template <typename Rows>
Eigen::Matrix3d Covariance(const Rows& rows) {
  const Eigen::Matrix<double, Eigen::Dynamic, 3> centred = rows.rowwise() - rows.colwise().mean();
  return centred.transpose() * centred / static_cast<double>(rows.rows());
}

}  // namespace

Eigen::Vector3d FindTwist(const SampleGrid& grid, int points, double steps,
                          const CadenceConfig& config) {
  const int count = static_cast<int>(std::floor(steps)) + 2;
  Eigen::Matrix<double, kGridLength, 3> means;
  int cycles = 0;
  for (int late = 0; late + count <= points; late = static_cast<int>(cycles * steps)) {
    means.row(cycles++) = CycleMean(grid, late, steps);
  }
  if (cycles < 2) return Eigen::Vector3d::Zero();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(Covariance(means.topRows(cycles)));
  const Eigen::Matrix3d swing = Covariance(grid.Filtered(count));
  if (spread.eigenvalues()(2) < config.twist_share * config.twist_share * swing.trace()) {
    return Eigen::Vector3d::Zero();
  }
  const Eigen::Vector3d twist = spread.eigenvectors().col(2);
  const double across = swing.trace() - twist.dot(swing * twist);
  if (across < config.least_across_share * swing.trace()) return Eigen::Vector3d::Zero();
  return twist;
}

namespace {

int Points(double seconds) { return std::max(2, static_cast<int>(std::lround(seconds * kGridHz))); }

double WindowSeconds(const Moving& before, const SampleGrid& grid, const MovingConfig& config) {
  const double since_s =
      kGridStepS * static_cast<double>(grid.newest_index() - before.since_index + 1);
  if (!before.moving) return std::min(config.still_window_s, since_s);
  if (before.period_s > 0) {
    return std::clamp(config.window_cycles * before.period_s, config.shortest_window_s,
                      config.longest_window_s);
  }
  // Some of the rest before it as well: a swing that began with a jerk may hardly change after it.
  return std::min(since_s + config.still_window_s, config.longest_window_s);
}

/// The first of the newest `count` points that left the place where their oldest third rested.
std::int64_t Onset(const SampleGrid& grid, int count, double distance_mps2) {
  const auto samples = grid.Filtered(count);
  const int resting = std::max(1, count / 3);
  const Eigen::RowVector3d rest = samples.topRows(resting).colwise().mean();
  int row = 0;
  while (row + 1 < count && (samples.row(row) - rest).norm() < distance_mps2) ++row;
  return grid.newest_index() - (count - 1 - row);
}

bool CanBeStill(const SampleGrid& grid, int count, const MovingConfig& config) {
  const double force_mps2 = grid.Filtered(count).colwise().mean().norm();
  if (std::abs(force_mps2 - kStandardGravityMps2) < config.gravity_tolerance_mps2) return true;
  const int longest = std::min(grid.size(), Points(config.longest_window_s));
  return Deviation(grid, longest) < config.stop_mps2;
}

void FollowPeriod(double period_s, std::int64_t index, const MovingConfig& config, Moving& moving) {
  if (period_s <= 0) return;
  if (moving.period_s > 0 && period_s > (1 + config.growth_share) * moving.period_s) {
    if (moving.longer_since_index == 0) moving.longer_since_index = index;
    const auto lasted = static_cast<double>(index - moving.longer_since_index);
    if (lasted * kGridStepS < config.growth_delay_s) return;
  }
  moving.period_s = period_s;
  moving.longer_since_index = 0;
}

}  // namespace

double Deviation(const SampleGrid& grid, int count) {
  if (count < 2 || count > grid.size()) return 0;
  const auto samples = grid.Filtered(count);
  const Eigen::RowVector3d mean = samples.colwise().mean();
  return std::sqrt((samples.rowwise() - mean).squaredNorm() / count);
}

Moving Next(const Moving& before, const SampleGrid& grid, double period_s,
            const MovingConfig& config) {
  Moving next = before;
  if (before.moving) FollowPeriod(period_s, grid.newest_index(), config, next);
  const double window_s = WindowSeconds(next, grid, config);
  const int count = std::min(grid.size(), Points(window_s));
  const double deviation = Deviation(grid, count);
  if (before.moving) {
    // The points of this window are the first still ones: what was before them starts nothing.
    const Moving still{false, grid.newest_index() - count + 1, 0, 0};
    return deviation < config.stop_mps2 && CanBeStill(grid, count, config) ? still : next;
  }
  if (deviation < config.start_mps2) return before;
  return {true, Onset(grid, count, config.start_mps2), 0, 0};
}

}  // namespace footing::features
