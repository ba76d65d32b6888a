#include "daemon/sensor/features/moving.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::features {
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
