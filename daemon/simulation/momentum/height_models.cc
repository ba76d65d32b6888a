#include "daemon/simulation/momentum/height_models.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/base/units.h"

namespace footing::momentum {
namespace {

using HeightFilter = HeightModels::Filter;
using HeightRow = HeightFilter::Row;
using HeightVector = HeightFilter::Vector;
using HeightMatrix = HeightFilter::Matrix;

constexpr int kGroups = HeightModels::kGroups;
// Places in the state.
constexpr int kHeight = 0, kVelocity = 1, kSlow = 2, kGains = 3, kPlay = kGains + kGroups,
              kPostureError = kPlay + 1;

/// An assumption about the load cells and the weight.
struct CellModel {
  double slow_n, slow_s;  ///< Slow error of the boards: standard deviation, correlation time.
  double gain;            ///< Standard deviation of the gain of a group of cells.
  double play_n;          ///< Standard deviation of half the width of all cells' play.
  double weight;          ///< Standard deviation of the weight at first, as a share.
  double walk;            ///< By which the weight wanders, per root second.
  bool forks;             ///< Begins again and again with the state of the best cells.
  double probability;     ///< Before anything is measured.
};

constexpr double kWeightShare = 0.043, kWeightProbability = 0.0048;
constexpr CellModel kAnotherWeight{1, 6, 0.003, 0, kWeightShare, 0.0002, true, kWeightProbability};
constexpr std::array<CellModel, HeightModels::kCells> kCellModels{{
    {0.0015, 0.16, 0.002, 0, 0.0005, 0, false, 0.35},
    {1, 6, 0.005, 0, 0.001, 0.0002, false, 0.35},
    {2, 4, 0.005, 3, 0.001, 0.0002, false, 0.1},
    kAnotherWeight,
    kAnotherWeight,
    kAnotherWeight,
    kAnotherWeight,
}};
constexpr std::size_t kFirstFork = 3;

// Time between two looks at the posture, at a body that rests, and at where bodies are.
constexpr double kLookS = 0.1, kRestLookS = 0.5, kAnchorLookS = 0.3;

// The posture. One that shows the height has an error that changes with the way, and a white one;
// its standard deviation grows with its distance from the T-pose. One that hides the height moves
// by itself, nearly as fast as before.
constexpr double kPostureS = 0.1;  // One that is older is not used.
constexpr double kWhiteM = 0.01, kErrorWayM = 0.14, kErrorS = 8.5, kErrorShare = 0.3;
constexpr double kFreeM = 0.019, kFreeShare = 0.11, kKeepsSpeed = 0.7;
constexpr double kFreeAcceleration = 0.1;  // Share of the body's that a posture may have.
constexpr double kSmoothS = 0.3;           // Smoothing of its speed.
// Probability that one ceases or begins to show the height, in a look. Where one hides it, it is
// off by the latter distance.
constexpr double kHidesShare = 0.025, kShowsShare = 0.2, kHiddenM = 0.24, kHiddenMeanM = 0.05;
constexpr double kShowsAtFirst = 0.95;

// A body at rest: the shares of looks in which it is still, its velocity and acceleration then, and
// otherwise.
constexpr double kStillShare = 0.55, kStillMps = 0.03, kSlowMps = 0.235;
constexpr double kStillMps2 = 0.015, kSlowMps2 = 0.5, kStillPostureMps = 0.036;
// Acceleration of a body in its T-pose, whose posture, smoothed, keeps within the latter distance.
constexpr double kHeldMps2 = 0.05, kHeldS = 0.1, kHeldM = 0.004;
constexpr double kHoldsM = 0.03, kHoldsMps = 0.01;  // Standard deviations of its height and speed.

// Limits: raised heels, a deep squat and how far beyond it bodies are; a filter that is less sure
// than the last is cut there.
constexpr double kTiptoeM = 0.08, kDeepestM = -0.55, kDeeperM = 0.049, kUnsureM = 0.1;
// Shares of the weight: more is not wrong but elsewhere, as of a foot beside the boards.
constexpr double kMostWrong = 0.15, kMoreWrong = 0.02;
constexpr double kLoadedShare = 0.5;  // With less of the weight on the cells a body may fly.

// Without postures a body is upright with some probability, or elsewhere: {share, mean, spread},
// fitted to recorded motion, for accurate cells and for others.
constexpr double kUprightAccurate = 0.18, kUpright = 0.87;

// Cells: rate of change per look; log odds below which they begin with the state of the best ones;
// time for which a changed weight is followed, and the share of the best from which on it stays.
constexpr double kLeak = 0.00055, kBehind = -13.7, kBehindKeeps = 0.997;
constexpr double kForkS = 4, kForkKeeps = 0.017;
constexpr double kLeastLogDensity = -30;  // One look alone condemns nothing.

// Landing: knees give way, of which the posture shows little for a while.
constexpr double kLandingS = 0.5, kLandingShows = 0.1, kLandingM = 0.15, kTouchdownM = 0.08;
constexpr double kElsewhereS = 0.7;  // Longer without load than any jump.
// How fast a body lands: a step onto the cells and a fall of 46 cm are one deviation off.
constexpr double kLandMps = -1.5, kLandSpreadMps = 1.5, kStandsMps = 0.5, kAnyM = 0.3;

constexpr double kTrustedM = 0.12, kRemainsM = 0.015;
constexpr double kLeastNoiseN = 0.1, kLeastWeight = 0.0005;
constexpr double kStartM = 0.005, kCoastMps2 = 20;

double LogNormal(double off, double variance) {
  return -0.5 * (off * off / variance + std::log(2 * kPi * variance));
}

/// Log of the standard normal distribution.
double LogPhi(double x) {
  if (x > -5) return std::log(0.5 * std::erfc(-x / std::sqrt(2.0)));
  return -0.5 * x * x - std::log(-x * std::sqrt(2 * kPi));
}

struct Transition {
  HeightMatrix a = HeightMatrix::Identity(), q = HeightMatrix::Zero();
  HeightVector u = HeightVector::Zero();
};

struct Scale {
  double mass_kg, step_s, noise_n;
};

/// From the frame with `last` to that with `input`: the trapezoid of both.
Transition TransitionOf(const CellModel& cells, const Scale& scale, const VerticalInput& last,
                        const VerticalInput& input) {
  Transition out;
  const double h = scale.step_s, keep = std::exp(-h / cells.slow_s);
  const auto integrate = [&](int state, double mps2) {
    out.a(kHeight, state) = 0.5 * h * h * mps2;
    out.a(kVelocity, state) = h * mps2;
  };
  const double mean_mps2 =
      0.5 * (last.total_n() + input.total_n()) / scale.mass_kg - kStandardGravityMps2;
  out.u(kHeight) = 0.5 * h * h * mean_mps2;
  out.u(kVelocity) = h * mean_mps2;
  integrate(kSlow, -1);
  for (int i = 0; i < kGroups; ++i) {
    const auto k = static_cast<std::size_t>(i);
    integrate(kGains + i, -0.5 * (last.load_n[k] + input.load_n[k]) / scale.mass_kg);
  }
  integrate(kPlay, 0.5 * (last.play + input.play) / scale.mass_kg);
  out.a(kHeight, kVelocity) = h;
  out.a(kSlow, kSlow) = keep;
  const double white = scale.noise_n * std::sqrt(double{kGroups}) / scale.mass_kg;
  const double slow = cells.slow_n / scale.mass_kg;
  out.q(kHeight, kHeight) = 1e-9;
  out.q(kVelocity, kVelocity) = white * white * h * h;
  out.q(kSlow, kSlow) = slow * slow * (1 - keep * keep);
  out.q.block<kGroups, kGroups>(kGains, kGains).setConstant(cells.walk * cells.walk * h);
  return out;
}

/// Share of each group's gain error in a load, over `divisor`.
HeightRow GainsRow(const VerticalInput& input, double divisor) {
  HeightRow row = HeightRow::Zero();
  for (int i = 0; i < kGroups; ++i) {
    row(kGains + i) = input.load_n[static_cast<std::size_t>(i)] / divisor;
  }
  return row;
}

/// The body stands still in its T-pose, in which all gains together give the weight.
void StartFilter(const CellModel& cells, double mass_kg, const VerticalInput& mean,
                 double posture_m, HeightFilter& filter) {
  HeightMatrix p = HeightMatrix::Zero();
  p(kHeight, kHeight) = p(kVelocity, kVelocity) = kStartM * kStartM;
  p(kSlow, kSlow) = std::pow(cells.slow_n / mass_kg, 2);
  p(kPlay, kPlay) = cells.play_n * cells.play_n;
  p.block<kGroups, kGroups>(kGains, kGains).setConstant(cells.weight * cells.weight);
  for (int i = kGains; i < kPlay; ++i) p(i, i) += cells.gain * cells.gain;
  p(kPostureError, kPostureError) = posture_m * posture_m;
  filter.Start(HeightVector::Zero(), p);
  const HeightRow row = HeightRow::Unit(kSlow) + GainsRow(mean, mass_kg);
  const double error = std::max(cells.weight, kLeastWeight) * kStandardGravityMps2;
  filter.Update(row, 0, error * error);
  filter.Remember(HeightRow::Unit(kHeight));
}

/// Multiplies the density of a scalar by a mixture; the log of the evidence.
double LookAt(const HeightRow& row, const std::array<Component, 2>& mixture, HeightFilter& filter) {
  const HeightFilter::Scalar now = filter.Of(row);
  const MixtureMoments product = TimesMixture({now.mean, now.variance + 1e-12}, mixture);
  filter.SetMoments(row, {product.moments.mean, product.moments.variance});
  return product.log_evidence;
}

/// A body whose loads are steady most likely has no velocity, and `level_mps2` shows the weight;
/// else it has an acceleration of `slow_mps2`.
double LookAtStillness(const HeightRow& level, double level_mps2, double slow_mps2,
                       HeightFilter& filter) {
  return LookAt(level,
                {{{kStillShare, level_mps2, kStillMps2}, {1 - kStillShare, level_mps2, slow_mps2}}},
                filter) +
         LookAt(HeightRow::Unit(kVelocity),
                {{{kStillShare, 0, kStillMps}, {1 - kStillShare, 0, kSlowMps}}}, filter);
}

/// Where bodies are of which no posture is seen.
double LookWithoutPosture(bool accurate, double arms_hang_m, HeightFilter& filter) {
  if (accurate) {
    return LookAt(HeightRow::Unit(kHeight),
                  {{{kUprightAccurate, -arms_hang_m, 0.013}, {1 - kUprightAccurate, -0.053, 0.42}}},
                  filter);
  }
  return LookAt(HeightRow::Unit(kHeight),
                {{{kUpright, -arms_hang_m, 0.033}, {1 - kUpright, -0.12, 0.15}}}, filter);
}

void Weigh(double log_density, double& probability) {
  probability *= std::exp(std::max(log_density, kLeastLogDensity));
}

template <typename Pair>
double ProbabilityOf(const Pair& pair) {
  return pair[0].probability + pair[1].probability;
}

}  // namespace

// Body at rest.
namespace {

// Loads are steady that keep, smoothed, within a limit of their mean. A person who stood still on
// laboratory plates (OpenCap subject 4, static1, 5 s) had a scatter of 0.011 m/s2 about means of
// 0.3 s, which differed from each other by 0.002.
constexpr double kNearS = 0.05, kSteadyMps2 = 0.06, kSteadyS = 0.3;
constexpr double kCopS = 0.1, kStillCopMps = 0.07, kUnknownCopMps = 1;

}  // namespace

void RestWatch::Advance(double raw_mps2, const VerticalInput& input, double step_s) {
  if (!started_) {
    started_ = true;
    cop_m_ = input.cop_m;
    near_mps2_ = level_mps2_ = raw_mps2;
  }
  steady_s_ += step_s;
  near_mps2_ += step_s / (kNearS + step_s) * (raw_mps2 - near_mps2_);
  if (std::abs(near_mps2_ - level_mps2_) > kSteadyMps2) {
    steady_s_ = 0;
    near_mps2_ = raw_mps2;
  }
  level_mps2_ += step_s / (steady_s_ + step_s) * (raw_mps2 - level_mps2_);
  if (!input.cop_valid) {
    cop_mps_ = kUnknownCopMps;
    return;
  }
  const double share = step_s / (kCopS + step_s);
  const Eigen::Vector2d move = share * (input.cop_m - cop_m_);
  cop_m_ += move;
  cop_mps_ += share * (move.norm() / step_s - cop_mps_);
}

bool RestWatch::rests() const { return steady_s_ >= kSteadyS && cop_mps_ < kStillCopMps; }

HeightModels::HeightModels(double mass_kg, double step_s, double arms_hang_m, double cell_noise_n,
                           double posture_spread_m)
    : mass_kg_(mass_kg),
      step_s_(step_s),
      arms_hang_m_(arms_hang_m),
      noise_n_(std::max(cell_noise_n, kLeastNoiseN)),
      posture_m_(posture_spread_m),
      play_(noise_n_) {}

template <typename Apply>
void HeightModels::ForEach(Apply&& apply) {
  for (std::size_t c = 0; c < kCells; ++c) {
    for (Model& model : models_[c]) apply(c, model);
  }
}

template <typename Apply>
double HeightModels::Mean(Apply&& apply) const {
  double sum = 0;
  for (const Pair& pair : models_) {
    for (const Model& model : pair) sum += model.probability * apply(model.filter);
  }
  return sum;
}

bool HeightModels::sees_posture() const { return seen_.since_s < kPostureS; }

double HeightModels::posture_spread_m() const {
  return landing_s_ > 0 ? kLandingM : std::hypot(posture_m_, kErrorShare * seen_.height_m);
}

void HeightModels::KeepLag(int lag_steps) {
  ForEach([&](std::size_t, Model& model) { model.filter.Keep(lag_steps + 1); });
}

void HeightModels::Start(const VerticalInput& mean) {
  mean_ = mean;
  seen_ = {};
  t_pose_ = {};
  landing_s_ = unloaded_s_ = 0;
  ForEach([&](std::size_t c, Model& model) {
    StartFilter(kCellModels[c], mass_kg_, mean, posture_m_, model.filter);
  });
  Restart();
  started_ = false;
}

void HeightModels::Restart() {
  lost_s_ = 0;
  behind_.fill(0);
  for (std::size_t c = 0; c < kCells; ++c) {
    const double shows = landing_s_ > 0 ? kLandingShows : kShowsAtFirst;
    models_[c][kShows].probability = kCellModels[c].probability * shows;
    models_[c][kHides].probability = kCellModels[c].probability * (1 - shows);
    if (c < kFirstFork) continue;
    const auto place = static_cast<double>(c - kFirstFork);
    since_fork_s_[c] = place / static_cast<double>(kCells - kFirstFork) * kForkS;
  }
  Normalise();
}

void HeightModels::Predict(const VerticalInput& input) {
  const double way_m = sees_posture() ? std::abs(seen_.height_m - seen_.smooth_m) / kSmoothS : 1;
  const double keep = std::exp(-step_s_ / kErrorS - way_m * step_s_ / kErrorWayM);
  const double error_m = posture_spread_m();
  for (std::size_t c = 0; c < kCells; ++c) {
    Transition step = TransitionOf(kCellModels[c], {mass_kg_, step_s_, noise_n_}, last_, input);
    step.a(kPostureError, kPostureError) = keep;
    step.q(kPostureError, kPostureError) = error_m * error_m * (1 - keep * keep);
    for (Model& model : models_[c]) model.filter.Predict(step.a, step.u, step.q);
  }
}

void HeightModels::Advance(const VerticalInput& measured) {
  VerticalInput input = measured;
  input.play = play_.Advance(measured.load_n, step_s_);
  if (!started_) {
    started_ = true;
    last_ = input;
  }
  raw_mps2_ = input.total_n() / mass_kg_ - kStandardGravityMps2;
  const bool unloaded = raw_mps2_ < -kLoadedShare * kStandardGravityMps2;
  const double before_s = unloaded_s_;
  unloaded_s_ = unloaded ? unloaded_s_ + step_s_ : 0;
  if (unloaded_s_ > kElsewhereS) {  // It does not fall but stands beside the cells.
    if (before_s <= kElsewhereS) {
      ForEach([](std::size_t, Model& model) {
        model.filter.Forget(kHeight, kAnyM * kAnyM);
        model.filter.Forget(kVelocity, kStandsMps * kStandsMps);
      });
    }
    Coast();
    return;
  }
  Predict(input);
  rest_.Advance(raw_mps2_, input, step_s_);
  last_ = input;
  seen_.since_s += step_s_;
  landing_s_ -= step_s_;
  since_look_.posture_s += step_s_;
  since_look_.rest_s += step_s_;
  since_look_.anchor_s += step_s_;
  LookAtRest();
  constexpr double kRounding = 1e-9;
  if (since_look_.posture_s >= kLookS - kRounding) {
    since_look_.posture_s = 0;
    Look();
  }
  ForEach([](std::size_t, Model& model) { model.filter.Remember(HeightRow::Unit(kHeight)); });
}

void HeightModels::SeePosture(double height_m) {
  if (posture_m_ <= 0) return;
  if (!sees_posture()) {
    seen_.smooth_m = seen_.looked_m = height_m;
    seen_.looked_mps = 0;
  }
  seen_.height_m = height_m;
  seen_.smooth_m += step_s_ / (kSmoothS + step_s_) * (height_m - seen_.smooth_m);
  seen_.since_s = 0;
  FollowTPose(height_m);
  if (seen_.landed) return;
  seen_.landed = true;
  ForEach([&](std::size_t, Model& model) {
    model.filter.Update(HeightRow::Unit(kHeight), height_m, kTouchdownM * kTouchdownM);
  });
}

void HeightModels::FollowTPose(double height_m) {
  if (!t_pose_.held) return;
  if (t_pose_.frames == 0) t_pose_.near_m = height_m;
  t_pose_.frames += 1;
  t_pose_.mean_m += (height_m - t_pose_.mean_m) / t_pose_.frames;
  t_pose_.near_m += step_s_ / (kHeldS + step_s_) * (height_m - t_pose_.near_m);
  t_pose_.held = std::abs(t_pose_.near_m - t_pose_.mean_m) < kHeldM;
}

HeightRow HeightModels::LevelRow() const {
  HeightRow row = HeightRow::Unit(kSlow) + GainsRow(last_, mass_kg_);
  row(kPlay) = -last_.play / mass_kg_;
  return row;
}

template <typename Apply>
void HeightModels::Reweigh(Apply&& apply) {
  std::array<double, kCells> before{};
  for (std::size_t c = 0; c < kCells; ++c) before[c] = ProbabilityOf(models_[c]);
  apply();
  constexpr double kLeast = 1e-300;
  for (std::size_t c = 0; c < kCells; ++c) {
    behind_[c] += std::log((ProbabilityOf(models_[c]) + kLeast) / (before[c] + kLeast));
  }
  const double most = *std::max_element(behind_.begin(), behind_.end());
  for (double& behind : behind_) behind -= most;
  Normalise();
}

void HeightModels::LookAtRest() {
  const double posture_mps = (seen_.height_m - seen_.smooth_m) / kSmoothS;
  if (unloaded_s_ > 0 || !rest_.rests() || since_look_.rest_s < kRestLookS ||
      (sees_posture() && std::abs(posture_mps) > kStillPostureMps)) {
    return;
  }
  since_look_.rest_s = 0;
  const bool holds = sees_posture() && t_pose_.held;
  const double slow_mps2 = holds ? kHeldMps2 : kSlowMps2;
  const HeightRow level = LevelRow();
  Reweigh([&] {
    ForEach([&](std::size_t, Model& model) {
      if (holds) {
        model.filter.Forget(kHeight, kHoldsM * kHoldsM);
        model.filter.Forget(kVelocity, kHoldsMps * kHoldsMps);
      }
      Weigh(LookAtStillness(level, rest_.level_mps2(), slow_mps2, model.filter), model.probability);
    });
  });
}

void HeightModels::Look() {
  for (double& behind : behind_) behind *= kBehindKeeps;
  Reweigh([&] {
    if (sees_posture()) LookAtPosture();
    LookAtLimits();
  });
  for (Pair& pair : models_) MixPostures(pair);
  Normalise();
  MixCells();
  Normalise();
}

void HeightModels::LookAtPosture() {
  const double way_m = seen_.height_m - seen_.looked_m;
  const double free_m = std::hypot(kFreeM, kFreeShare * seen_.looked_mps * kLookS,
                                   kFreeAcceleration * raw_mps2_ * kLookS * kLookS);
  const double hides = LogNormal(way_m - kKeepsSpeed * seen_.looked_mps * kLookS, free_m * free_m);
  HeightRow row = HeightRow::Unit(kHeight);
  row(kPostureError) = 1;
  for (Pair& pair : models_) {
    Model& shows = pair[kShows];
    const Filter::Scalar known = shows.filter.Of(row);
    Weigh(LogNormal(seen_.height_m - known.mean, known.variance + kWhiteM * kWhiteM),
          shows.probability);
    shows.filter.Update(row, seen_.height_m, kWhiteM * kWhiteM);
    Weigh(hides, pair[kHides].probability);
  }
  seen_.looked_mps = way_m / kLookS;
  seen_.looked_m = seen_.height_m;
}

double HeightModels::LogMostWrong(const Filter& filter) const {
  const Filter::Scalar over = filter.Of(OverweightRow());
  return LogPhi((kMostWrong - std::abs(over.mean)) /
                std::hypot(kMoreWrong, std::sqrt(over.variance)));
}

double HeightModels::Limit(std::size_t cells, Filter& filter, double top_m, bool anchors) const {
  const HeightRow row = HeightRow::Unit(kHeight);
  double log = anchors ? LookWithoutPosture(cells == 0, arms_hang_m_, filter) : 0;
  Filter::Scalar now = filter.Of(row);
  const double spread_m = std::sqrt(now.variance);
  const double high = (top_m - now.mean) / spread_m;
  const double low = (now.mean - kDeepestM) / std::hypot(spread_m, kDeeperM);
  log += LogPhi(low) + LogMostWrong(filter);
  constexpr double kFar = 3;
  if (low < kFar && spread_m > kUnsureM) {
    const Moments cut = Below({-now.mean, now.variance}, -kDeepestM);
    filter.SetMoments(row, {-cut.mean, cut.variance});
    now = filter.Of(row);
  }
  if (landing_s_ > 0) return log;
  if (high < kFar) {
    const Moments cut = Below({now.mean, now.variance}, top_m);
    filter.SetMoments(row, {cut.mean, cut.variance});
  }
  return log + LogPhi(high);
}

void HeightModels::LookAtLimits() {
  if (unloaded_s_ > 0) return;
  const bool anchors = !sees_posture() && since_look_.anchor_s >= kAnchorLookS;
  if (since_look_.anchor_s >= kAnchorLookS) since_look_.anchor_s = 0;
  const double top_m = (sees_posture() ? std::max(seen_.height_m, 0.0) : 0.0) + kTiptoeM;
  ForEach([&](std::size_t c, Model& model) {
    Weigh(Limit(c, model.filter, top_m, anchors), model.probability);
  });
}

void HeightModels::MixPostures(Pair& pair) const {
  Model& shows = pair[kShows];
  Model& hides = pair[kHides];
  if (!sees_posture()) {
    if (shows.probability > 0) {
      hides.filter.Merge(hides.probability, shows.filter, shows.probability);
      hides.probability += shows.probability;
      shows.probability = 0;
    }
    return;
  }
  // The error of a posture that begins to show the height is not known; how well it fits says
  // whether it does.
  const double error_m2 = std::pow(posture_spread_m(), 2);
  const Filter::Scalar height = hides.filter.Of(HeightRow::Unit(kHeight));
  const double off_m = seen_.height_m - height.mean;
  constexpr double kMostLogFit = 10;
  const double log_fit = LogNormal(off_m, height.variance + error_m2) -
                         LogNormal(off_m - kHiddenMeanM, height.variance + kHiddenM * kHiddenM);
  const double fit = std::exp(std::min(log_fit, kMostLogFit));
  Filter begins = hides.filter;
  begins.Forget(kPostureError, error_m2);
  HeightRow row = HeightRow::Unit(kHeight);
  row(kPostureError) = 1;
  begins.Update(row, seen_.height_m, kWhiteM * kWhiteM);
  const double shows_share = landing_s_ > 0 ? kShowsShare * kLandingShows : kShowsShare;
  const double stay = shows.probability * (1 - kHidesShare);
  const double cease = shows.probability * kHidesShare;
  const double begin = hides.probability * shows_share * fit;
  const double remain = hides.probability * (1 - shows_share);
  if (cease > 0) hides.filter.Merge(remain, shows.filter, cease);
  if (begin > 0) shows.filter.Merge(stay, begins, begin);
  shows.probability = stay + begin;
  hides.probability = cease + remain;
}

bool HeightModels::IsLost(std::size_t best) {
  constexpr double kLostM = -0.8, kLostS = 0.5;
  const Pair& pair = models_[best];
  const Model& model = pair[pair[kShows].probability > pair[kHides].probability ? kShows : kHides];
  lost_s_ = model.filter.x()(kHeight) < kLostM ? lost_s_ + kLookS : 0;
  return lost_s_ > kLostS;
}

void HeightModels::MixCells() {
  std::size_t best = 0;
  for (std::size_t c = 0; c < kCells; ++c) {
    Pair& pair = models_[c];
    const double sum = ProbabilityOf(pair);
    const double next = (1 - kLeak) * sum + kLeak * kCellModels[c].probability;
    for (Model& model : pair) {
      model.probability = sum > 1e-12 ? model.probability * next / sum : next / double{kPostures};
    }
    if (ProbabilityOf(pair) > ProbabilityOf(models_[best])) best = c;
  }
  if (IsLost(best)) {
    Begin(kLandingM, 0, kStandsMps);
    return;
  }
  for (std::size_t c = 0; c < kCells; ++c) {
    since_fork_s_[c] += kLookS;
    if (c == best) continue;
    if (!kCellModels[c].forks) {
      if (behind_[c] < kBehind) Fork(c, best);
    } else if (sees_posture() && since_fork_s_[c] >= kForkS &&
               ProbabilityOf(models_[c]) < kForkKeeps * ProbabilityOf(models_[best])) {
      Fork(c, best);
    }
  }
}

void HeightModels::Fork(std::size_t cells, std::size_t from) {
  const CellModel& model = kCellModels[cells];
  const double sum = std::max(ProbabilityOf(models_[from]), 1e-300);
  for (std::size_t k = 0; k < kPostures; ++k) {
    Model& to = models_[cells][k];
    to.filter = models_[from][k].filter;
    to.filter.Forget(kSlow, std::pow(model.slow_n / mass_kg_, 2));
    to.filter.Forget(kPlay, model.play_n * model.play_n);
    HeightMatrix doubt = HeightMatrix::Zero();
    doubt.block<kGroups, kGroups>(kGains, kGains).setConstant(model.weight * model.weight);
    to.filter.Predict(HeightMatrix::Identity(), HeightVector::Zero(), doubt);
    to.probability = model.probability * models_[from][k].probability / sum;
  }
  behind_[cells] = since_fork_s_[cells] = 0;
}

void HeightModels::Normalise() {
  double sum = 0;
  ForEach([&](std::size_t, const Model& model) { sum += model.probability; });
  ForEach([&](std::size_t c, Model& model) {
    model.probability =
        sum > 0 ? model.probability / sum : kCellModels[c].probability / double{kPostures};
  });
}

void HeightModels::Begin(double height_sd_m, double velocity_mps, double velocity_sd_mps) {
  ForEach([&](std::size_t c, Model& model) {
    constexpr int kCellStates = kGroups + 1;
    HeightVector x = model.filter.x();
    HeightMatrix p = HeightMatrix::Zero();
    p.block<kCellStates, kCellStates>(kGains, kGains) =
        model.filter.p().block<kCellStates, kCellStates>(kGains, kGains);
    x(kHeight) = x(kSlow) = x(kPostureError) = 0;
    x(kVelocity) = velocity_mps;
    p(kHeight, kHeight) = height_sd_m * height_sd_m;
    p(kVelocity, kVelocity) = velocity_sd_mps * velocity_sd_mps;
    p(kSlow, kSlow) = std::pow(kCellModels[c].slow_n / mass_kg_, 2);
    p(kPostureError, kPostureError) = kLandingM * kLandingM;
    model.filter.Start(x, p);
    model.filter.Remember(HeightRow::Unit(kHeight));
  });
  landing_s_ = kLandingS;
  unloaded_s_ = 0;
  seen_.landed = false;
  t_pose_.held = false;
  Restart();
}

void HeightModels::Coast() {
  Transition step;
  step.a(kHeight, kVelocity) = step_s_;
  step.q(kVelocity, kVelocity) = kCoastMps2 * kCoastMps2 * step_s_ * step_s_;
  ForEach([&](std::size_t, Model& model) {
    model.filter.Predict(step.a, step.u, step.q);
    model.filter.Remember(HeightRow::Unit(kHeight));
  });
  started_ = false;
  seen_.since_s += step_s_;
  rest_.Stop();
}

void HeightModels::Land() { Begin(kAnyM, kLandMps, kLandSpreadMps); }

void HeightModels::Reappear() { Begin(kAnyM, 0, kStandsMps); }

bool HeightModels::CanLand() const {
  constexpr double kLandsM = -0.03, kLandsSpreadM = 0.06, kSure = 4;
  const Filter::Scalar height = Height(0);
  const double off_m = height.mean - kLandsM;
  return off_m * off_m < kSure * kSure * (height.variance + kLandsSpreadM * kLandsSpreadM);
}

bool HeightModels::trusted() const { return Height(0).variance < kTrustedM * kTrustedM; }

HeightModels::Filter::Scalar HeightModels::Height(int lag_steps) const {
  const double mean = Mean([&](const Filter& filter) { return filter.Delayed(lag_steps).mean; });
  const double variance = Mean([&](const Filter& filter) {
    const Filter::Scalar one = filter.Delayed(lag_steps);
    return one.variance + (one.mean - mean) * (one.mean - mean);
  });
  return {mean, variance + kRemainsM * kRemainsM};
}

HeightModels::Filter::Scalar HeightModels::Velocity() const {
  const HeightRow row = HeightRow::Unit(kVelocity);
  const double mean = Mean([&](const Filter& filter) { return filter.x()(kVelocity); });
  return {mean, Mean([&](const Filter& filter) {
            const Filter::Scalar one = filter.Of(row);
            return one.variance + (one.mean - mean) * (one.mean - mean);
          })};
}

double HeightModels::acceleration_mps2() const {
  const HeightRow level = LevelRow();
  return raw_mps2_ - Mean([&](const Filter& filter) { return filter.Of(level).mean; });
}

HeightRow HeightModels::OverweightRow() const {
  return GainsRow(mean_, mass_kg_ * kStandardGravityMps2);
}

double HeightModels::mass_kg() const {
  constexpr double kMostShare = 0.5, kLeastShare = 0.002;  // Less is what any weighing is off by.
  const HeightRow row = OverweightRow();
  const double over = Mean([&](const Filter& filter) { return filter.Of(row).mean; });
  if (std::abs(over) < kLeastShare) return mass_kg_;
  return mass_kg_ / (1 - std::clamp(over, -kMostShare, kMostShare));
}

namespace {

/// Looks of the offline filter at a body that rests, and at where bodies are.
class OfflineLooks {
 public:
  void Advance(double raw_mps2, const VerticalInput& input, double step_s, double arms_hang_m,
               HeightFilter& filter) {
    rest_.Advance(raw_mps2, input, step_s);
    rest_s_ += step_s;
    anchor_s_ += step_s;
    if (rest_.rests() && std::abs(rest_.level_mps2()) < kStillLoadsMps2 && rest_s_ >= kLookS) {
      rest_s_ = 0;
      LookAt(HeightRow::Unit(kVelocity), {{{kStillShare, 0, 0.006}, {1 - kStillShare, 0, 0.04}}},
             filter);
    }
    if (anchor_s_ < kAnchorLookS || raw_mps2 < -kLoadedShare * kStandardGravityMps2) return;
    anchor_s_ = 0;
    LookWithoutPosture(false, arms_hang_m, filter);
    const HeightFilter::Scalar now = filter.Of(HeightRow::Unit(kHeight));
    const Moments cut = Below({now.mean, now.variance}, kHighestM);
    filter.SetMoments(HeightRow::Unit(kHeight), {cut.mean, cut.variance});
  }

 private:
  static constexpr double kStillLoadsMps2 = 0.14, kHighestM = 0.013;

  RestWatch rest_;
  double rest_s_ = 0, anchor_s_ = 0;
};

struct SmoothedStep {
  Transition transition;
  HeightVector x;
  HeightMatrix p;
};

/// Rauch-Tung-Striebel.
std::vector<HeightFilter::Scalar> Backwards(const std::vector<SmoothedStep>& steps) {
  std::vector<HeightFilter::Scalar> out(steps.size());
  HeightVector x = steps.back().x;
  HeightMatrix p = steps.back().p;
  for (std::size_t i = steps.size(); i-- > 0;) {
    if (i + 1 < steps.size()) {
      const Transition& next = steps[i + 1].transition;
      const HeightMatrix ahead = next.a * steps[i].p * next.a.transpose() + next.q;
      const HeightMatrix gain = ahead.ldlt().solve(next.a * steps[i].p).transpose();
      x = steps[i].x + gain * (x - (next.a * steps[i].x + next.u));
      p = steps[i].p + gain * (p - ahead) * gain.transpose();
    }
    out[i] = {x(kHeight), std::max(0.0, p(kHeight, kHeight))};
  }
  return out;
}

}  // namespace

std::vector<HeightModels::Filter::Scalar> SmoothHeight(double mass_kg, double step_s,
                                                       double arms_hang_m, double cell_noise_n,
                                                       const VerticalInput& mean,
                                                       const std::vector<VerticalInput>& inputs) {
  if (inputs.empty()) return {};
  constexpr CellModel kInaccurate = kCellModels[1];
  const Scale scale{mass_kg, step_s, std::max(cell_noise_n, kLeastNoiseN)};
  HeightFilter filter;
  StartFilter(kInaccurate, mass_kg, mean, 0, filter);
  OfflineLooks looks;
  std::vector<SmoothedStep> steps;
  steps.reserve(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Transition step = TransitionOf(kInaccurate, scale, inputs[i > 0 ? i - 1 : 0], inputs[i]);
    filter.Predict(step.a, step.u, step.q);
    looks.Advance(inputs[i].total_n() / mass_kg - kStandardGravityMps2, inputs[i], step_s,
                  arms_hang_m, filter);
    steps.push_back({step, filter.x(), filter.p()});
  }
  return Backwards(steps);
}

}  // namespace footing::momentum
