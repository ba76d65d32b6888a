#include "daemon/sensor/features/together.h"

#include <algorithm>
#include <cmath>

namespace footing::features {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// The newest `count` points up to grid index `last`, without their mean.
Rows Centred(const SampleGrid& grid, int count, std::int64_t last) {
  const auto late = static_cast<int>(grid.newest_index() - last);
  const Rows rows = grid.Filtered(count + late).topRows(count);
  return rows.rowwise() - rows.colwise().mean();
}

}  // namespace

double CorrelationNow(const SampleGrid& left, const SampleGrid& right,
                      const Eigen::Matrix3d& from_right, double span_s) {
  const auto count = static_cast<int>(std::lround(span_s * kGridHz)) + 1;
  const std::int64_t last = std::min(left.newest_index(), right.newest_index());
  const std::int64_t late = std::max(left.newest_index(), right.newest_index()) - last;
  if (count + late > std::min(left.size(), right.size())) return 0;
  const Rows one = Centred(left, count, last);
  const Rows other = Centred(right, count, last) * from_right.transpose();
  const double size = one.norm() * other.norm();
  return size > 0 ? one.cwiseProduct(other).sum() / size : 0;
}

Together Next(const Together& before, const SampleGrid& left, const SampleGrid& right,
              const Eigen::Matrix3d& from_right, double elapsed_s, const PhaseConfig& config) {
  const double correlation = CorrelationNow(left, right, from_right, config.together_window_s);
  if (correlation < config.least_correlation) return {};
  const double lasted_s = before.lasted_s + elapsed_s;
  return {lasted_s, lasted_s >= config.together_lasts_s};
}

}  // namespace footing::features
