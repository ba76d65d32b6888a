#include "daemon/offline/analysis/board.h"

#include <algorithm>

#include "common/base/quantile.h"

namespace footing::posturography {
namespace {

double MedianWeight(const std::vector<CornerSample>& samples, double least_n) {
  std::vector<double> totals;
  for (const CornerSample& sample : samples) {
    if (Total(sample.forces) >= least_n) totals.push_back(Total(sample.forces));
  }
  return text::Median(std::move(totals));
}

CopSample CentreOfPressure(const CornerSample& sample, const BoardShape& shape) {
  const board::PlatePoint at =
      board::CentreOfPressure(sample.forces, Total(sample.forces), shape.geometry);
  return {sample.time_s, at.x_m, at.y_m};
}

/// Appends to the last stretch, or begins one after a gap or where `begin` says so.
void Append(const CopSample& sample, double longest_s, bool begin, Standing& standing) {
  Stretches& stretches = standing.stretches;
  ++standing.samples;
  if (begin || stretches.empty()) {
    stretches.push_back({sample});
    return;
  }
  const double interval_s = sample.time_s - stretches.back().back().time_s;
  if (interval_s > longest_s) {
    ++standing.gaps.count;
    standing.gaps.longest_s = std::max(standing.gaps.longest_s, interval_s);
    standing.gaps.seconds += interval_s;
    stretches.emplace_back();
  }
  stretches.back().push_back(sample);
}

template <typename Sample>
double LongestInterval(const std::vector<Sample>& samples) {
  std::vector<CopSample> times(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) times[i].time_s = samples[i].time_s;
  return std::max(kLongestIntervalS, 5 * MedianInterval({times}));
}

}  // namespace

Standing FindStanding(const std::vector<CornerSample>& samples, const BoardShape& shape) {
  Standing standing;
  standing.weight_n = MedianWeight(samples, shape.least_body_weight_n);
  if (standing.weight_n <= 0) return standing;
  const double least_n = shape.least_share_of_weight * standing.weight_n;
  const double longest_s = LongestInterval(samples);
  bool stood = false;
  for (const CornerSample& sample : samples) {
    const bool stands = Total(sample.forces) >= least_n;
    if (stands) Append(CentreOfPressure(sample, shape), longest_s, !stood, standing);
    stood = stands;
  }
  return standing;
}

Standing SplitAtGaps(const std::vector<CopSample>& samples) {
  Standing standing;
  const double longest_s = LongestInterval(samples);
  for (const CopSample& sample : samples) Append(sample, longest_s, false, standing);
  return standing;
}

}  // namespace footing::posturography
