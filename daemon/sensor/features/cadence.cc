#include "daemon/sensor/features/cadence.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/sensor/features/twist.h"

namespace footing::features {
namespace {

constexpr int kMostLags = kGridLength / 2;
using Curve = std::array<double, kMostLags + 2>;

/// 1, 2, 3, ...: W(t) up to its scale, oldest first.
constexpr std::array<double, kGridLength> kRamp = [] {
  std::array<double, kGridLength> ramp{};
  for (int i = 0; i < kGridLength; ++i) ramp[i] = i + 1;
  return ramp;
}();

/// The newest samples, seen across the direction of a twist (see FindTwist): zero sees all.
struct Seen {
  const SampleGrid& grid;
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();
};

/// Mean of W |a(t) - a(t - lag)|² over the newest `overlap` points, in (m/s²)².
double Difference(const Seen& seen, int lag, int overlap) {
  const auto all = seen.grid.Filtered(lag + overlap);
  const auto change = [&](int axis) {
    return all.col(axis).tail(overlap) - all.col(axis).head(overlap);
  };
  const auto squares = [&](int axis) { return change(axis).array().square(); };
  const Eigen::Map<const Eigen::ArrayXd> weight(kRamp.data(), overlap);
  double sum = (weight * (squares(0) + squares(1) + squares(2))).sum();
  if (!seen.twist.isZero()) {
    const auto along =
        seen.twist.x() * change(0) + seen.twist.y() * change(1) + seen.twist.z() * change(2);
    sum -= (weight * along.array().square()).sum();
  }
  return sum / (0.5 * overlap * (overlap + 1));
}

/// Variance of the newest n points, summed over the axes, for every n up to `size`.
std::array<double, kGridLength + 1> Variances(const Seen& seen, int size) {
  std::array<double, kGridLength + 1> variances{};
  const auto samples = seen.grid.Filtered(size);
  const Eigen::RowVector3d newest = samples.row(size - 1);
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  double squares = 0;
  for (int n = 1; n <= size; ++n) {
    Eigen::RowVector3d value = samples.row(size - n) - newest;
    if (!seen.twist.isZero()) value -= value.dot(seen.twist) * seen.twist.transpose();
    sum += value;
    squares += value.squaredNorm();
    variances[n] = std::max(0.0, squares / n - sum.squaredNorm() / (n * n));
  }
  return variances;
}

int Overlap(int lag, double share) { return std::max(4, static_cast<int>(std::ceil(share * lag))); }

struct Peak {
  int lag = 0;  ///< 0: none.
  double correlation = 0;
};

/// The first peak of the normalised autocorrelation that is nearly as high as the highest.
Peak FirstPeak(const Seen& seen, int points, const std::array<double, kGridLength + 1>& variances,
               double overlap_share, double least, const CadenceConfig& config) {
  const int first = std::max(2, static_cast<int>(kGridHz / config.highest_hz));
  int last = std::min(kMostLags, static_cast<int>(kGridHz / config.lowest_hz) + 1);
  while (last > first && last + Overlap(last, overlap_share) > points) --last;
  Curve correlation{};
  double highest = least;
  for (int lag = first; lag <= last; ++lag) {
    const int overlap = Overlap(lag, overlap_share);
    const double variance = variances[lag + overlap];
    correlation[lag] = variance > 0 ? 1 - Difference(seen, lag, overlap) / (2 * variance) : 0.0;
  }
  const auto is_peak = [&](int lag) {
    return correlation[lag] >= least && correlation[lag] >= correlation[lag - 1] &&
           correlation[lag] > correlation[lag + 1];
  };
  for (int lag = first + 1; lag < last; ++lag) {
    if (is_peak(lag)) highest = std::max(highest, correlation[lag]);
  }
  for (int lag = first + 1; lag < last; ++lag) {
    if (is_peak(lag) && correlation[lag] >= config.first_peak_share * highest) {
      return {lag, correlation[lag]};
    }
  }
  return {};
}

/// Where the parabola through three equally spaced values has its minimum, in steps from the
/// middle.
double ParabolaMinimum(double before, double middle, double after) {
  const double bend = before - 2 * middle + after;
  return bend > 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

/// The minimum of the difference near `lag`, between grid points.
double RefinedLag(const Seen& seen, int points, int lag, int overlap) {
  double here = Difference(seen, lag, overlap);
  for (int step = 0; step < 3; ++step) {
    const double before = Difference(seen, lag - 1, overlap);
    const double after = Difference(seen, lag + 1, overlap);
    if (here <= before && here <= after) return lag + ParabolaMinimum(before, here, after);
    lag += before < after ? -1 : 1;
    here = std::min(before, after);
    if (lag < 2 || lag + 1 + overlap > points) break;
  }
  return lag;
}

/// Sharpens the period over as many cycles as still look the same.
double RefinedPeriodSteps(const Seen& seen, int points, int lag, int overlap,
                          const std::array<double, kGridLength + 1>& variances,
                          const CadenceConfig& config) {
  double period = RefinedLag(seen, points, lag, overlap);
  const int longest = std::min(points, static_cast<int>(config.refine_window_s * kGridHz));
  for (int cycles = 2;; ++cycles) {
    const int far = static_cast<int>(std::lround(cycles * period));
    if (far + 1 + overlap > longest) break;
    const double variance = variances[std::min(points, far + overlap)];
    if (variance <= 0) break;
    if (1 - Difference(seen, far, overlap) / (2 * variance) < config.refine_correlation) break;
    period = RefinedLag(seen, points, far, overlap) / cycles;
  }
  return period;
}

/// A period near the known one.
bool IsKnown(int lag, double known_s, const CadenceConfig& config) {
  return std::abs(lag * kGridStepS - known_s) <= config.jump_share * known_s;
}

struct Search {
  Peak peak;
  double overlap_share = 0;
  std::array<double, kGridLength + 1> variances{};
};

/// The sure search, and the quick one where that sees something new.
Search FindPeak(const Seen& seen, int points, double known_s, const CadenceConfig& config) {
  Search search{{}, config.sure_overlap, Variances(seen, points)};
  Peak& peak = search.peak;
  peak = FirstPeak(seen, points, search.variances, config.sure_overlap, config.sure_correlation,
                   config);
  if (peak.lag != 0 && IsKnown(peak.lag, known_s, config) &&
      peak.correlation >= config.quick_correlation) {
    return search;
  }
  const Peak quick = FirstPeak(seen, points, search.variances, config.quick_overlap,
                               config.quick_correlation, config);
  const bool same = std::abs(quick.lag - peak.lag) <= config.jump_share * peak.lag;
  if (quick.lag != 0 && (peak.lag == 0 || same || IsKnown(quick.lag, known_s, config))) {
    search.overlap_share = config.quick_overlap;
    peak = quick;
  }
  return search;
}

PeriodEstimate Refined(const Seen& seen, int points, const Search& search,
                       const CadenceConfig& config) {
  const Peak& peak = search.peak;
  if (peak.lag == 0) return {};
  int overlap = Overlap(peak.lag, search.overlap_share);
  while (peak.lag + 1 + overlap > points) --overlap;
  const double steps =
      RefinedPeriodSteps(seen, points, peak.lag, overlap, search.variances, config);
  return {true, steps * kGridStepS, std::min(1.0, peak.correlation)};
}

}  // namespace

PeriodEstimate FindPeriod(const SampleGrid& grid, int points, double known_s,
                          const CadenceConfig& config) {
  if (points < 8) return {};
  const Seen seen{grid};
  const Search search = FindPeak(seen, points, known_s, config);
  if (known_s > 0 && !IsKnown(search.peak.lag, known_s, config)) {
    const Seen across{grid, FindTwist(grid, points, known_s * kGridHz, config)};
    if (!across.twist.isZero()) {
      const Search without = FindPeak(across, points, known_s, config);
      if (IsKnown(without.peak.lag, known_s, config)) {
        return Refined(across, points, without, config);
      }
    }
  }
  return Refined(seen, points, search, config);
}

bool SpansSeveral(const Cadence& cadence, const Partner& partner, const CadenceConfig& config) {
  return cadence.valid && partner.period_s > 0 &&
         cadence.period_s > (1 + config.jump_share) * partner.period_s;
}

Cadence Next(const Cadence& before, const PeriodEstimate& estimate, const Partner& partner,
             double elapsed_s, const CadenceConfig& config) {
  const auto differ = [](double one_s, double other_s, double share) {
    return std::abs(one_s - other_s) > share * other_s;
  };
  const bool partner_keeps =
      before.valid && partner.estimate.found &&
      !differ(partner.estimate.period_s, before.period_s, config.partner_share);
  Cadence next = before;
  if (!estimate.found) {
    const double cycles = partner_keeps ? config.partner_cycles : config.hold_cycles;
    next.candidate_s = 0;
    next.lost_s += elapsed_s;
    return next.lost_s > cycles * next.period_s ? Cadence{} : next;
  }
  next.lost_s = 0;
  const double share = partner_keeps ? config.partner_share : config.jump_share;
  const bool joins = SpansSeveral(before, partner, config) &&
                     !differ(estimate.period_s, partner.period_s, config.jump_share);
  if (before.valid && !joins && differ(estimate.period_s, before.period_s, share)) {
    const bool same_candidate =
        before.candidate_s > 0 && !differ(estimate.period_s, before.candidate_s, config.jump_share);
    const double persistence = partner_keeps ? config.partner_cycles : config.jump_persistence;
    next.candidate_age_s = same_candidate ? before.candidate_age_s + elapsed_s : 0;
    next.candidate_s = estimate.period_s;
    if (next.candidate_age_s < persistence * before.period_s) return next;
  }
  return {true, estimate.period_s, 0, 0, 0};
}

}  // namespace footing::features
