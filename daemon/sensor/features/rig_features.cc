#include "daemon/sensor/features/rig_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/base/result.h"
#include "common/base/units.h"
#include "daemon/sensor/features/cycle.h"
#include "daemon/sensor/features/sample_grid.h"

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

PeriodEstimate PeriodAsPrinted(const SampleGrid& grid, const Config& config) {
  const int overlap = static_cast<int>(std::lround(config.printed.overlap_s * kGridHz));
  const int first = static_cast<int>(kGridHz / config.cadence.highest_hz);
  const int last =
      std::min(grid.size() - overlap, static_cast<int>(kGridHz / config.cadence.lowest_hz) + 1);
  if (last < first + 2) return {};
  const Eigen::ArrayXd curve =
      PrintedCorrelation(grid.Filtered(overlap), grid.Filtered(last + overlap));
  const auto is_peak = [&](int lag) {
    return curve(lag) >= curve(lag - 1) && curve(lag) > curve(lag + 1);
  };
  const double lowest = curve.tail(last - first + 1).minCoeff();
  double highest = lowest;
  for (int lag = first + 1; lag < last; ++lag) {
    if (is_peak(lag)) highest = std::max(highest, curve(lag));
  }
  const double least = lowest + config.printed.first_peak_share * (highest - lowest);
  for (int lag = first + 1; lag < last; ++lag) {
    if (!is_peak(lag) || curve(lag) < least) continue;
    const double past = ParabolaMinimum(-curve(lag - 1), -curve(lag), -curve(lag + 1));
    return {true, (lag + past) * kGridStepS, 0};
  }
  return {};
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

namespace {

/// Across the front.
std::complex<double> Across(const Eigen::Vector3d& gravity_mps2) {
  return {gravity_mps2.x(), gravity_mps2.z()};
}

/// Into the mean of the last `horizon_s`, of which `seen_s` are known.
void Take(const std::complex<double>& value, double elapsed_s, double horizon_s,
          std::complex<double>& mean, double& seen_s) {
  if (!(elapsed_s > 0)) return;
  seen_s = std::min(seen_s + elapsed_s, horizon_s);
  mean += elapsed_s / seen_s * (value - mean);
}

}  // namespace

bool MeanRepeats(const SampleGrid& grid, double steps, const GripConfig& config) {
  const int late = static_cast<int>(std::lround(steps));
  if (late + static_cast<int>(std::floor(steps)) + 2 > grid.size()) return false;
  const std::complex<double> newest = Across(CycleMean(grid, 0, steps).transpose());
  const std::complex<double> before = Across(CycleMean(grid, late, steps).transpose());
  return std::abs(newest - before) <= config.most_change * std::abs(newest);
}

Eigen::Matrix3d PairGrip::FromRight() const {
  const double size = std::abs(turn_m2ps4);
  if (seen_s == 0 || !(size > 0)) return Eigen::Matrix3d::Identity();
  const double cosine = turn_m2ps4.real() / size, sine = turn_m2ps4.imag() / size;
  Eigen::Matrix3d rotation;
  rotation << cosine, 0, -sine, 0, 1, 0, sine, 0, cosine;
  return rotation;
}

PairGrip Next(const PairGrip& before, const std::optional<Eigen::Vector3d>& left_mps2,
              const std::optional<Eigen::Vector3d>& right_mps2, bool rests, double elapsed_s,
              const GripConfig& config) {
  if (!left_mps2 || !right_mps2) return before;
  const std::complex<double> left = Across(*left_mps2), right = Across(*right_mps2);
  const double least_mps2 = config.least_across * kStandardGravityMps2;
  if (std::min(std::abs(left), std::abs(right)) < least_mps2) return before;
  const std::complex<double> turn_m2ps4 = left * std::conj(right);
  PairGrip next = before;
  if (!rests) {
    next.rest_s = 0;
    Take(turn_m2ps4, elapsed_s, config.horizon_s, next.turn_m2ps4, next.seen_s);
    return next;
  }
  Take(turn_m2ps4, elapsed_s, config.rest_s, next.rest_m2ps4, next.rest_s);
  if (next.seen_s > config.rest_s || next.rest_s < config.rest_s) return next;
  next.turn_m2ps4 = next.rest_m2ps4;
  next.seen_s = config.rest_s;
  return next;
}

DeviceFeatureExtractor::DeviceFeatureExtractor(std::uint32_t device, stream::DeviceRole role,
                                               const Config& config)
    : config_(config), grid_(config) {
  features_.device = device;
  features_.role = role;
}

void DeviceFeatureExtractor::AddSample(const stream::MotionSample& sample) {
  grid_.Add(sample);
  newest_received_ns_ = std::max(newest_received_ns_, sample.received_ns);
  features_.simulated = sample.simulated;
}

void DeviceFeatureExtractor::Forget() {
  moving_ = {};
  cadence_ = {};
  estimate_ = {};
  swing_end_ = {};
  gravity_mps2_.reset();
  features_.moving = features_.frequency_valid = features_.amplitude_valid = false;
  features_.inclination_valid = features_.held = features_.swing_valid = false;
  features_.frequency_hz = features_.amplitude_mps2 = 0;
  features_.roll_rad = features_.pitch_rad = features_.swing_rad = features_.axial_rad = 0;
  features_.axial_valid = false;
}

void DeviceFeatureExtractor::MeasureRest() {
  swing_end_ = {};
  features_.held = features_.amplitude_valid = features_.swing_valid = false;
  features_.amplitude_mps2 = features_.swing_rad = 0;
  const int count =
      std::min(grid_.size(), static_cast<int>(std::lround(config_.rest_window_s * kGridHz)));
  const Eigen::Vector3d gravity = grid_.Filtered(count).colwise().mean().transpose();
  gravity_mps2_ = gravity;
  TakeInclination(gravity);
}

void DeviceFeatureExtractor::TakeInclination(const Eigen::Vector3d& gravity_mps2) {
  const Inclination inclination = InclinationOf(gravity_mps2);
  features_.inclination_valid = true;
  features_.roll_rad = inclination.roll_rad;
  features_.pitch_rad = inclination.pitch_rad;
  features_.axial_valid = inclination.axial_valid;
  features_.axial_rad = inclination.axial_rad;
}

void DeviceFeatureExtractor::MeasureCycle() {
  if (!cadence_.valid) {
    features_.held = features_.amplitude_valid = features_.swing_valid = false;
    features_.amplitude_mps2 = features_.swing_rad = 0;
    return;  // The inclination from before motion stays: nothing better is known yet.
  }
  const Cycle cycle = NewestCycle(grid_, cadence_.period_s, config_.cycle);
  features_.held = cycle.clipped;
  if (!cycle.valid) return;
  // Held, but never below what even the clipped samples show.
  features_.amplitude_mps2 = cycle.clipped && features_.amplitude_valid
                                 ? std::max(features_.amplitude_mps2, cycle.amplitude_mps2)
                                 : cycle.amplitude_mps2;
  features_.amplitude_valid = true;
  if (cycle.clipped) return;
  const bool shown = cadence_.lost_s == 0 && cadence_.candidate_s == 0;
  if (shown && MeanRepeats(grid_, cadence_.period_s * kGridHz, config_.grip)) {
    gravity_mps2_ = cycle.mean_mps2;
  }
  features_.swing_valid = cycle.swing.valid;
  features_.swing_rad = Continued(cycle.swing, swing_end_, config_.cycle).angle_rad;
  swing_end_ = Next(swing_end_, cycle.swing, config_.cycle);
  TakeInclination(cycle.mean_mps2);
}

void DeviceFeatureExtractor::Observe(std::int64_t now_ns, const Partner& partner) {
  elapsed_s_ = 0;
  const double age_s = NanosecondsToSeconds(now_ns - grid_.newest_ns());
  if (grid_.size() == 0 || age_s > config_.stale_s) {
    Forget();
    return;
  }
  const bool restarted = grid_.beginnings() != beginnings_;
  if (restarted) Forget();
  beginnings_ = grid_.beginnings();
  const std::int64_t steps = restarted ? 1 : grid_.newest_index() - computed_index_;
  if (steps == 0) return;
  elapsed_s_ = kGridStepS * static_cast<double>(steps);
  computed_index_ = grid_.newest_index();
  const double known_s = cadence_.valid ? cadence_.period_s : 0.0;
  moving_ = Next(moving_, grid_, known_s, config_.moving);
  estimate_ = {};
  if (!moving_.moving) return;
  if (config_.printed.overlap_s > 0) {
    estimate_ = PeriodAsPrinted(grid_, config_);
    return;
  }
  const auto points = static_cast<int>(
      std::min<std::int64_t>(grid_.size(), grid_.newest_index() - moving_.since_index + 1));
  const bool several = SpansSeveral(cadence_, partner, config_.cadence);
  estimate_ = FindPeriod(grid_, points, several ? 0 : known_s, config_.cadence);
}

const stream::DeviceFeatures& DeviceFeatureExtractor::Compute(const Partner& partner) {
  if (elapsed_s_ == 0) return features_;
  if (config_.printed.overlap_s > 0) {
    cadence_ = {estimate_.found, estimate_.period_s, 0, 0, 0};
  } else if (moving_.moving) {
    cadence_ = Next(cadence_, estimate_, partner, elapsed_s_, config_.cadence);
  } else {
    cadence_ = {};
  }
  features_.moving = moving_.moving;
  features_.frequency_valid = cadence_.valid;
  features_.frequency_hz = cadence_.valid ? 1 / cadence_.period_s : 0.0;
  gravity_mps2_.reset();
  if (moving_.moving) {
    MeasureCycle();
  } else {
    MeasureRest();
  }
  return features_;
}

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

namespace {

constexpr std::size_t kMostMembers = 8;
/// A period that differs by more than this share is another one.
constexpr double kShownShare = 0.25;

/// Whether the newest samples of the controller show about that period, so that it is not merely
/// held.
bool Shows(const DeviceFeatureExtractor& device, double period_s) {
  const PeriodEstimate& estimate = device.estimate();
  return estimate.found && std::abs(estimate.period_s - period_s) <= kShownShare * period_s;
}

}  // namespace

RigFeatureExtractor::RigFeatureExtractor(std::string rig, const std::vector<Member>& members,
                                         const Config& config)
    : rig_(std::move(rig)), config_(config) {
  FOOTING_CHECK(members.size() <= kMostMembers);
  for (const Member& member : members) {
    FOOTING_CHECK(member.role != stream::DeviceRole::kLeftBoard &&
                  member.role != stream::DeviceRole::kRightBoard);
    devices_.emplace_back(member.device, member.role, config);
  }
  AddPair(stream::DeviceRole::kLeftHand, stream::DeviceRole::kRightHand);
  AddPair(stream::DeviceRole::kLeftLeg, stream::DeviceRole::kRightLeg);
}

void RigFeatureExtractor::AddPair(stream::DeviceRole left, stream::DeviceRole right) {
  const auto with = [this](stream::DeviceRole role) {
    return std::find_if(devices_.begin(), devices_.end(),
                        [role](const auto& device) { return device.role() == role; });
  };
  if (with(left) == devices_.end() || with(right) == devices_.end()) return;
  Pair pair;
  pair.left = static_cast<std::size_t>(with(left) - devices_.begin());
  pair.right = static_cast<std::size_t>(with(right) - devices_.begin());
  pairs_.push_back(pair);
}

void RigFeatureExtractor::AddSample(const stream::MotionSample& sample) {
  for (auto& device : devices_) {
    if (device.device() == sample.device) device.AddSample(sample);
  }
}

double RigFeatureExtractor::CommonPeriod(const stream::DeviceFeatures& left,
                                         const stream::DeviceFeatures& right, double elapsed_s,
                                         Pair& pair) const {
  if (!left.frequency_valid || !right.frequency_valid) return 0;
  const double left_s = 1 / left.frequency_hz;
  const double right_s = 1 / right.frequency_hz;
  const double known_s = pair.period_s;
  const bool agree =
      std::abs(left_s - right_s) <= config_.phase.agree_share * std::max(left_s, right_s);
  pair.disagree_s = agree ? 0 : pair.disagree_s + elapsed_s;
  const bool known = known_s > 0;
  if (!agree && (!known || pair.disagree_s > config_.phase.disagree_cycles * known_s)) return 0;
  // A hand whose phase jumps shows a wrong period for a moment; the other one keeps the known one.
  if (known && std::abs(left_s - right_s) > 0.1 * known_s) {
    return std::abs(left_s - known_s) <= std::abs(right_s - known_s) ? left_s : right_s;
  }
  return 0.5 * (left_s + right_s);
}

stream::PairFeatures RigFeatureExtractor::ComputePair(
    Pair& pair, const std::vector<stream::DeviceFeatures>& devices) {
  const auto& left = devices[pair.left];
  const auto& right = devices[pair.right];
  if (config_.printed.overlap_s > 0) {
    PhaseEstimate printed;
    if (left.frequency_valid && right.frequency_valid) {
      const double period_s = 0.5 * (1 / left.frequency_hz + 1 / right.frequency_hz);
      printed = PhaseAsPrinted(devices_[pair.left].grid(), devices_[pair.right].grid(), period_s);
    }
    return {left.device, right.device, printed.found, printed.phase_rad, false};
  }
  const std::int64_t index = std::min(devices_[pair.left].grid().newest_index(),
                                      devices_[pair.right].grid().newest_index());
  const std::int64_t steps = std::clamp<std::int64_t>(index - pair.computed_index, 0, kGridLength);
  pair.computed_index = index;
  const DeviceFeatureExtractor &one = devices_[pair.left], &other = devices_[pair.right];
  const double elapsed_s = kGridStepS * static_cast<double>(steps);
  const bool rests = !left.moving && !right.moving;
  if (rests || (left.moving && right.moving)) {
    pair.grip =
        Next(pair.grip, one.gravity_mps2(), other.gravity_mps2(), rests, elapsed_s, config_.grip);
  }
  if (!left.moving || !right.moving) {
    pair.phase = {};
    pair.together = {};
    pair.period_s = pair.disagree_s = 0;
  } else {
    const double period_s = CommonPeriod(left, right, elapsed_s, pair);
    const Eigen::Matrix3d from_right = pair.grip.FromRight();
    // While both periods are merely held, the newest cycle is none of theirs.
    const bool shown = period_s > 0 && (Shows(one, period_s) || Shows(other, period_s));
    const PhaseEstimate estimate =
        shown ? FindPhase(one.grid(), other.grid(), period_s, from_right, one.swing_end(),
                          other.swing_end(), config_.phase, config_.cycle)
              : PhaseEstimate{};
    if (period_s > 0) pair.period_s = period_s;
    pair.phase = Next(pair.phase, estimate, pair.period_s, elapsed_s, config_.phase);
    const bool seen = estimate.found && !pair.phase.jumping;
    pair.together = seen || pair.period_s == 0 ? Together{}
                                               : Next(pair.together, one.grid(), other.grid(),
                                                      from_right, elapsed_s, config_.phase);
    if (pair.together.sure) pair.phase = {.valid = true};
  }
  const Phase& phase = pair.phase;
  return {left.device, right.device, phase.valid, phase.valid ? phase.phase_rad : 0.0,
          phase.valid && (phase.lost_s > 0 || phase.jumping)};
}

std::vector<Partner> RigFeatureExtractor::Partners() const {
  std::vector<Partner> partners(devices_.size());
  for (const auto& pair : pairs_) {
    partners[pair.left] = devices_[pair.right].AsPartner();
    partners[pair.right] = devices_[pair.left].AsPartner();
  }
  return partners;
}

stream::RigFeatures RigFeatureExtractor::Compute(std::int64_t now_ns) {
  stream::RigFeatures features;
  features.rig = rig_;
  features.computed_ns = now_ns;
  std::vector<Partner> partners = Partners();
  for (std::size_t i = 0; i < devices_.size(); ++i) devices_[i].Observe(now_ns, partners[i]);
  partners = Partners();
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    DeviceFeatureExtractor& device = devices_[i];
    features.devices.push_back(device.Compute(partners[i]));
    features.newest_received_ns =
        std::max(features.newest_received_ns, device.newest_received_ns());
  }
  for (auto& pair : pairs_) {
    features.pairs.push_back(ComputePair(pair, features.devices));
    if (!pair.together.sure) continue;
    for (const std::size_t i : {pair.left, pair.right}) {  // Only that of the motion before.
      features.devices[i].frequency_valid = false;
      features.devices[i].frequency_hz = 0;
    }
  }
  return features;
}

}  // namespace footing::features
