#include "daemon/simulation/momentum/height_hypotheses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace footing::momentum {
namespace {

using enum HeightRow;

constexpr double kNever = std::numeric_limits<double>::infinity();

struct Row {
  bool good_cells;  ///< White noise only, else errors as real boards have them.
  double slow_force_n,
      slow_s;  ///< Slow error of the boards, and its correlation time.
  double gain_spread,
      play_n;  ///< Standard deviations: gain of each group of cells; half the width of their play.
  double mass_share;  ///< Error of the T-pose's mass; 0: what its noise makes.
  double weight_spread,
      walk;  ///< Common error of the cells at first, and a root second.
  bool any_weight,
      by_rests;  ///< VerticalConfig's still_at_any_weight and by_rests.
  double enters,
      stays;  ///< Log odds above which it becomes, and remains, active.
};

/// By HeightRow. The mass of kFreeMass is decided by WatchMass, and kInaccurate
/// is always active.
constexpr std::array<Row, kHeightRows> kTable{{
    // cells, slow N, s, gains, play N, mass, weight, walk, any weight, by
    // rests, enters, stays
    {true, 0.0015, 0.16, 0.002, 0, 0.005, 0.005, 0.0002, false, true, 3.5, 3.5},
    {false, 3, 2, 0.005, 3, 0, 0, 0, false, false, 4, 0},
    {false, 4, 2, 0.01, 0, 1, 0.05, 0.002, true, false, 10, -2},
    {false, 1, 6, 0.005, 0, 1, 0.02, 0, true, false, kNever, kNever},
    {true, 0.0015, 0.16, 0.002, 0, 0, 0, 0, false, false, 2, -4},
    {false, 1, 6, 0.005, 0, 0, 0, 0, false, false, -kNever, -kNever},
}};

constexpr const Row& RowOf(HeightRow row) { return kTable[static_cast<std::size_t>(row)]; }

// Standard deviation of the height of an upright body: raised arms, bent knees.
// It stays while the posture does, so no number of looks makes it smaller.
constexpr double kPostureSpreadM = 0.02;
constexpr double kLeastCellNoiseN = 0.1;
// Log odds against another row below which a state is given up for that of the
// other row: at once or, where rows are compared every `kCompareEveryS`, with a
// greater lead.
constexpr double kBehind = -4, kFarBehind = -10;
constexpr double kCompareEveryS = 1, kAdoptEveryS = 5;
// A width of play counts that is positive by so many of its deviations.
constexpr double kPlaySpreads = 1.5;
// Evidence of the ways from rest to rest: the most that counts, and that of a
// way that failed. One way never has enough to be active: it may lead back by
// chance.
constexpr double kMostEvidence = 8, kFailedEvidence = -4;
// Until its ways are known to fail, loads from rest to rest that have the body
// elsewhere than the output contradict it: by so many deviations of both, and
// at least by so much.
constexpr double kApartSpreads = 2, kApartM = 0.1;
// Parts of the weight: by which the T-pose's is wrong before it is doubted at
// all, and to which the weight must be known to be given to the others: from a
// body that kept its T-pose, which they follow better than kFreeMass does, or
// from one that moved.
constexpr double kLeastOverweight = 0.005;
// Share of the weight by which it may differ once the T-pose is left.
constexpr double kAfterTPose = 0.05;
constexpr double kSettledInTPose = 0.0025, kSettledSpread = 0.001;
constexpr double kPostureS = 0.1;  // A posture older than this is not used.
// Where a body is that nothing is known of, and how fast when it lands: a step
// onto the cells and a fall of 46 cm are one deviation off.
constexpr double kAnyHeightM = 0, kAnyHeightSpreadM = 0.15;
constexpr double kLandingMps = -1.5, kLandingSpreadMps = 1.5;
constexpr double kReseedMps = 0.5;
// Where a body is when its feet come down from a flight.
constexpr double kLandingHeightM = -0.03, kLandingSpreadM = 0.06;
constexpr double kTrustedSpreadM = 0.12;
constexpr double kSureSpreads = 4;  // Sure difference of two estimates, over the deviation of both.

/// Stillness and upright bodies as filters of such cells see them, fitted to
/// recorded motion.
VerticalConfig PriorOf(bool good_cells) {
  VerticalConfig config;
  if (good_cells) {
    config.mass_error_kg = 0.13;
    config.still_acceleration_mps2 = 0.018;
    config.still_cop_mps = 0.025;
    config.still_velocity_mps = 0.0004;
    config.look_s = 0.35;
    config.upright_share = 0.18;
    config.upright_spread_m = 0.013;
    config.low_below_m = 0.053;
    config.low_spread_m = 0.42;
    config.highest_m = 0.049;
  } else {
    config.still_acceleration_mps2 = 0.14;
    config.still_cop_mps = 0.055;
    config.still_velocity_mps = 0.006;
    config.look_s = 0.3;
    config.upright_share = 0.87;
    config.upright_spread_m = 0.033;
    config.highest_m = 0.013;
  }
  return config;
}

template <std::size_t... kRow>
std::array<VerticalCom, kHeightRows> FiltersOf(double mass_kg, double step_s, double arms_hang_m,
                                               double cell_noise_n, const PostureError& posture,
                                               std::index_sequence<kRow...>) {
  const auto filter = [&](std::size_t row) {
    VerticalConfig config =
        HeightHypothesis(static_cast<HeightRow>(row), arms_hang_m, cell_noise_n, mass_kg);
    config.posture = posture;
    return VerticalCom(config, mass_kg, step_s);
  };
  return {filter(kRow)...};
}

}  // namespace

VerticalConfig HeightHypothesis(HeightRow which, double arms_hang_m, double cell_noise_n,
                                double mass_kg) {
  const Row& row = RowOf(which);
  VerticalConfig config = PriorOf(row.good_cells);
  config.cell_noise_n = std::max(cell_noise_n, kLeastCellNoiseN);
  config.upright_below_m = arms_hang_m;
  config.slow_force_n = row.slow_force_n;
  config.slow_force_time_s = row.slow_s;
  config.gain_spread = row.gain_spread;
  config.play_n = row.play_n;
  if (row.mass_share > 0) config.mass_error_kg = row.mass_share * mass_kg;
  config.weight.spread = row.weight_spread;
  config.weight.walk = row.walk;
  config.still_at_any_weight = row.any_weight;
  if (which == kFreeWeight) config.weight.after_t_pose = kAfterTPose;
  config.by_rests = row.by_rests;
  return config;
}

HeightHypotheses::HeightHypotheses(double mass_kg, double step_s, double arms_hang_m,
                                   double cell_noise_n, const PostureError& posture)
    : filters_(FiltersOf(mass_kg, step_s, arms_hang_m, cell_noise_n, posture,
                         std::make_index_sequence<kHeightRows>())),
      play_(std::max(cell_noise_n, kLeastCellNoiseN)),
      step_s_(step_s),
      posture_(posture) {
  active_.fill(false);
  Active(kInaccurate) = true;
}

void HeightHypotheses::KeepLag(int lag_steps) {
  for (VerticalCom& filter : filters_) filter.KeepLag(lag_steps);
}

void HeightHypotheses::Start(const VerticalInput& mean) {
  for (VerticalCom& filter : filters_) filter.Start(mean);
  active_.fill(false);
  Active(kInaccurate) = true;
  rests_evidence_ = 0;
  held_t_pose_ = false;
  adopted_s_ = 0;
  since_posture_s_ = kPostureS;
}

HeightRow HeightHypotheses::FirstActive(HeightRow from) const {
  auto row = static_cast<std::size_t>(from);
  while (!active_[row]) ++row;
  return static_cast<HeightRow>(row);
}

void HeightHypotheses::Decide(HeightRow row, double log_odds) {
  Active(row) = log_odds > (Active(row) ? RowOf(row).stays : RowOf(row).enters);
}

bool HeightHypotheses::SeesPosture() const {
  return posture_.spread_m > 0 && since_posture_s_ < kPostureS;
}

void HeightHypotheses::Advance(const VerticalInput& input) {
  VerticalInput with_play = input;
  with_play.play = play_.Advance(input.load_n, step_s_);
  for (VerticalCom& filter : filters_) filter.Advance(with_play);
  since_posture_s_ += step_s_;
  Active(kBetweenRests) = Active(kBetweenRests) && SeesPosture();
  since_compared_s_ += step_s_;
  const bool compare = SeesPosture() && since_compared_s_ >= kCompareEveryS;
  if (compare) since_compared_s_ = 0;
  Recover(compare);
  WatchPlay(compare);
  // Without a posture nothing but a height that is impossible shows a wrong
  // weight.
  if (SeesPosture()) {
    const double best = Active(kFreeMass)
                            ? Of(kFreeMass).score()
                            : std::max(Of(kInaccurate).score(), Of(kAccurate).score());
    Decide(kFreeWeight, Of(kFreeWeight).score() - best);
  } else {
    Active(kFreeWeight) = false;
  }
  WatchMass();
  WatchAccuracy();
}

void HeightHypotheses::SeePosture(double height_m) {
  for (VerticalCom& filter : filters_) filter.SeePosture(height_m);
  since_posture_s_ = 0;
  WatchRests();
}

void HeightHypotheses::Coast() {
  for (VerticalCom& filter : filters_) filter.Coast();
}

void HeightHypotheses::Land() {
  // Each keeps its mass: what was learned of the weight stays true.
  for (VerticalCom& filter : filters_) {
    filter.Land(kAnyHeightM, kAnyHeightSpreadM, kLandingMps, kLandingSpreadMps);
  }
  ForgetRests();
}

void HeightHypotheses::Reappear() {
  for (VerticalCom& filter : filters_) {
    filter.Reseed(kAnyHeightM, kAnyHeightSpreadM, 0, kReseedMps);
  }
  ForgetRests();
}

bool HeightHypotheses::CanLand() const {
  const VerticalCom::Filter::Scalar height = output().Height(0);
  const double off_m = height.mean - kLandingHeightM;
  return off_m * off_m <
         kSureSpreads * kSureSpreads * (height.variance + kLandingSpreadM * kLandingSpreadM);
}

void HeightHypotheses::Recover(bool compare) {
  VerticalCom& free = Of(kFreeWeight);
  // The posture of this frame finds the height.
  if (free.strayed()) free.Reseed(kAnyHeightM, kAnyHeightSpreadM, 0, kReseedMps);
  for (const HeightRow row : {kAccurate, kInaccurate, kFreeMass}) {
    VerticalCom& filter = Of(row);
    if (filter.strayed() || (compare && filter.score() < free.score() + kFarBehind)) {
      filter.Adopt(free);
    }
  }
}

void HeightHypotheses::WatchPlay(bool compare) {
  VerticalCom& with_play = Of(kPlay);
  double best = std::max(Of(kAccurate).score(), Of(kInaccurate).score());
  for (const HeightRow row : {kFreeMass, kFreeWeight}) {
    if (Active(row)) best = std::max(best, Of(row).score());
  }
  const double lead = with_play.score() - best;
  const bool lost = with_play.strayed() || (compare && lead < kFarBehind);
  if (lost) {
    with_play.Adopt(Of(with_play.strayed() ? kFreeWeight : FirstActive(kFreeWeight)));
    with_play.DoubtPlay();
  }
  const VerticalCom::Filter::Scalar play = with_play.Play();
  const bool found = !lost && play.mean > kPlaySpreads * std::sqrt(play.variance);
  Decide(kPlay, SeesPosture() && found ? lead : -kNever);
  if (!compare || !found) return;
  for (const HeightRow row : {kAccurate, kInaccurate, kFreeMass}) {
    if (Of(row).score() < with_play.score() + kFarBehind) Of(row).Adopt(with_play);
  }
}

void HeightHypotheses::WatchMass() {
  VerticalCom& free = Of(kFreeMass);
  const VerticalCom::Filter::Scalar now = free.Overweight(), held = Of(kInaccurate).Overweight();
  if (!Active(kFreeMass)) {
    const double off = std::abs(now.mean - held.mean);
    Active(kFreeMass) = off > kLeastOverweight &&
                        off * off > kSureSpreads * kSureSpreads * (now.variance + held.variance);
    return;
  }
  // The others may have adopted a state that is better by now.
  const VerticalCom& other = Of(FirstActive(kAccurate));
  if (free.score() - other.score() < kBehind) free.Adopt(other);
  if (free.holds_t_pose()) {
    held_t_pose_ = true;
    return;
  }
  const double settled = held_t_pose_ ? kSettledInTPose : kSettledSpread;
  if (now.variance > settled * settled) return;
  Active(kFreeMass) = held_t_pose_ = false;
  free.Reweigh();
  Of(kInaccurate).Adopt(free);
  Of(kAccurate).Adopt(free);
  Of(kBetweenRests).RestartFrom(free);
  ForgetRests();
}

void HeightHypotheses::WatchAccuracy() {
  adopted_s_ += step_s_;
  const double lead = Of(kAccurate).score() - Of(kInaccurate).score();
  Decide(kAccurate, lead);
  if (Active(kAccurate) || lead >= kBehind || adopted_s_ < kAdoptEveryS) return;
  Of(kAccurate).Adopt(Of(kInaccurate));
  adopted_s_ = 0;
}

void HeightHypotheses::WatchRests() {
  VerticalCom& filter = Of(kBetweenRests);
  const std::optional<Return> found = filter.TakeReturn();
  if (filter.strayed() || (found && !found->back)) {
    filter.RestartFrom(Of(FirstActive(kPlay)));
    rests_evidence_ = kFailedEvidence;
  } else if (found) {
    rests_evidence_ = found->by_loads ? std::clamp(rests_evidence_ + found->evidence,
                                                   kFailedEvidence, kMostEvidence)
                                      : 0;
  }
  Decide(kBetweenRests, filter.follows_loads() ? rests_evidence_ : -kNever);
}

void HeightHypotheses::ForgetRests() {
  rests_evidence_ = 0;
  Active(kBetweenRests) = false;
}

bool HeightHypotheses::LoadsContradict() const {
  const VerticalCom& filter = Of(kBetweenRests);
  if (Active(kBetweenRests) || rests_evidence_ < 0 || !filter.follows_loads()) return false;
  const VerticalCom::Filter::Scalar loads = filter.Height(0), out = output().Height(0);
  const double apart_m = std::abs(loads.mean - out.mean);
  return apart_m > kApartM && apart_m > kApartSpreads * std::sqrt(loads.variance + out.variance);
}

bool HeightHypotheses::trusted() const {
  if (SeesPosture() && (output().contradicted() || LoadsContradict())) return false;
  return output().Height(0).variance < kTrustedSpreadM * kTrustedSpreadM;
}

double HeightHypotheses::mass_kg() const {
  // A free row has it in its gains.
  return RowOf(output_row()).any_weight ? output().weighed_kg() : output().mass_kg();
}

VerticalCom::Filter::Scalar HeightHypotheses::Height(int lag_steps) const {
  VerticalCom::Filter::Scalar height = output().Height(lag_steps);
  height.variance += kPostureSpreadM * kPostureSpreadM;
  return height;
}

}  // namespace footing::momentum
