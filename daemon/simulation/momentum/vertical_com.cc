#include "daemon/simulation/momentum/vertical_com.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/base/units.h"
#include "daemon/simulation/momentum/linear_filter.h"

namespace footing::momentum {
namespace {

using VerticalFilter = VerticalCom::Filter;

constexpr int kGroups = VerticalInput::kGroups;
constexpr int kCells = kGroups + 1;  // States of the cells that are learned: gains, and the play.
constexpr double kAccelerationTimeS = 0.12;  // Smoothing of |acceleration|.
// Time constants of the acceleration that is kept. One that is further off than `kLeap` limits of
// stillness has another level, which is found at once where a posture is seen: it shows who moves.
constexpr double kLevelTimeS = 0.5, kLeapTimeS = 0.05, kLeap = 1.2;
constexpr double kCopTimeS = 0.1;     // Smoothing of the COP, and again of its speed.
constexpr double kStillLookS = 0.1;   // Time between zero-velocity measurements.
constexpr double kLoadedShare = 0.5;  // Load over the weight: with less, the body may fly.
constexpr double kScoreTimeS = 30;
constexpr double kLeastLogDensity = -20;  // One event alone condemns nothing.
constexpr double kCoastMps2 = 20;  // Noise of the acceleration that nobody watches, per root frame.
constexpr double kLeastShare = 0.5;  // Least assumed mass over the weighed one.
// A body that moves slowly and evenly looks still, too: in this share of looks it is, else it has
// this speed.
constexpr double kStillShare = 0.6, kSlowMps = 0.04;
// A body whose posture rises or sinks is not still, however even its loads are.
constexpr double kStillPostureMps = 0.02;
// A filter has strayed that is sure, by so many deviations, of a height over tiptoe with raised
// arms or under the ground.
constexpr double kStraySpreads = 4, kHighestM = 0.15, kLowestM = -0.75;
// Error of the weight, as a share, that a filter that strayed may have learned.
constexpr double kReseedGain = 0.03;
constexpr double kStartHeightM = 0.005;
constexpr double kStartVelocityMps = 0.005;

double Total(const VerticalInput& input) {
  double total = 0;
  for (const double load : input.load_n) total += load;
  return total;
}

}  // namespace

VerticalCom::VerticalCom(const VerticalConfig& config, double mass_kg, double step_s)
    : config_(config), mass_kg_(mass_kg), step_s_(step_s) {
  const double keep = std::exp(-step_s / config.slow_force_time_s);
  const double slow = config.slow_force_n / mass_kg;
  const double white = config.cell_noise_n * std::sqrt(double{kGroups}) / mass_kg;
  a_.setIdentity();
  a_(0, 1) = step_s;
  a_(2, 2) = keep;
  q_.setZero();
  q_(0, 0) = 1e-9;
  q_(1, 1) = white * white * step_s * step_s;
  q_(2, 2) = slow * slow * (1 - keep * keep);
  q_.block<kGroups, kGroups>(kGains, kGains)
      .setConstant(config.weight.walk * config.weight.walk * step_s);
  if (!config.by_rests) {
    const double keep_posture = std::exp(-step_s / config.posture.time_s);
    a_(kPosture, kPosture) = keep_posture;
    q_(kPosture, kPosture) =
        std::pow(config.posture.spread_m, 2) * (1 - keep_posture * keep_posture);
  }
  u_.setZero();
}

bool VerticalCom::Loaded(double raw_mps2) {
  return raw_mps2 > (kLoadedShare - 1) * kStandardGravityMps2;
}

void VerticalCom::Start(const VerticalInput& mean) {
  VerticalFilter::Matrix p = VerticalFilter::Matrix::Zero();
  p(0, 0) = kStartHeightM * kStartHeightM;
  p(1, 1) = kStartVelocityMps * kStartVelocityMps;
  p(2, 2) = config_.slow_force_n * config_.slow_force_n / (mass_kg_ * mass_kg_);
  p.block<kGroups, kGroups>(kGains, kGains)
      .setConstant(config_.weight.spread * config_.weight.spread);
  p(kPlay, kPlay) = config_.play_n * config_.play_n;
  for (int i = kGains; i < kPlay; ++i) p(i, i) += config_.gain_spread * config_.gain_spread;
  p(kPosture, kPosture) = PostureSpread() * PostureSpread();
  filter_.Start(PostureMean() * VerticalFilter::Vector::Unit(kPosture), p);
  // In the T-pose all gains together give the weight, but for what the mass is wrong by.
  VerticalFilter::Row h = VerticalFilter::Row::Zero();
  for (int i = 0; i < kGroups; ++i) h(3 + i) = mean.load_n[static_cast<std::size_t>(i)] / mass_kg_;
  overweight_ = h / kStandardGravityMps2;
  h(2) = 1;
  const double error = config_.mass_error_kg * kStandardGravityMps2 / mass_kg_;
  filter_.Update(h, 0, error * error);
  filter_.Remember(VerticalFilter::Row::Unit(0));
  last_.started = false;
  posture_ = {};
  t_pose_ = {};
  rest_ = {};
}

void VerticalCom::Advance(const VerticalInput& input) {
  const double raw = Total(input) / mass_kg_ - kStandardGravityMps2;
  if (!last_.started) {
    last_ = {true, input, raw};
    cop_.mean_m = input.cop_m;
    level_mps2_ = raw;
    still_.mean_mps2 = std::abs(raw);
  }
  // Trapezoid over the step; the errors enter with the loads of the same time.
  const double h = step_s_, mean = 0.5 * (raw + last_.raw_mps2);
  u_.setZero();
  u_(0) = 0.5 * mean * h * h;
  u_(1) = mean * h;
  a_(0, 2) = -0.5 * h * h;
  a_(1, 2) = -h;
  acceleration_mps2_ = raw - filter_.x()(2);
  for (int i = 0; i < kGroups; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double share = 0.5 * (input.load_n[k] + last_.input.load_n[k]) / mass_kg_;
    a_(0, 3 + i) = -0.5 * h * h * share;
    a_(1, 3 + i) = -h * share;
    acceleration_mps2_ -= filter_.x()(3 + i) * input.load_n[k] / mass_kg_;
  }
  const double play = 0.5 * (input.play + last_.input.play) / mass_kg_;
  a_(0, kPlay) = 0.5 * h * h * play;
  a_(1, kPlay) = h * play;
  acceleration_mps2_ += filter_.x()(kPlay) * input.play / mass_kg_;
  filter_.Predict(a_, u_, q_);
  Watch(input, raw);
  if (config_.still_at_any_weight && holds_t_pose()) {
    LookAtTPose(input);
  } else if (still()) {
    still_.since_look_s += h;
    if (still_.since_look_s >= kStillLookS) {
      still_.since_look_s = 0;
      if (config_.still_at_any_weight && posture_.anchors_s > 0) LookAtLevel(input);
      if (!config_.by_rests || posture_.anchors_s <= 0) LookAtVelocity();
    }
  }
  score_ *= std::exp(-h / kScoreTimeS);
  posture_.anchors_s -= h;
  posture_.landing_s -= h;
  since_look_s_ += h;
  if (since_look_s_ >= config_.look_s) {
    since_look_s_ = 0;
    if (Loaded(raw)) Anchor();
  }
  last_.input = input;
  last_.raw_mps2 = raw;
  filter_.Remember(VerticalFilter::Row::Unit(0));
}

void VerticalCom::Watch(const VerticalInput& input, double raw_mps2) {
  const double share = step_s_ / (kAccelerationTimeS + step_s_);
  const double off_mps2 = raw_mps2 - level_mps2_;
  WatchLevel(raw_mps2);
  const bool leaps =
      posture_.anchors_s > 0 && std::abs(off_mps2) > kLeap * config_.still_acceleration_mps2;
  level_mps2_ += step_s_ / ((leaps ? kLeapTimeS : kLevelTimeS) + step_s_) * off_mps2;
  const double moved = raw_mps2 - (config_.still_at_any_weight ? level_mps2_ : 0);
  still_.mean_mps2 += share * (std::abs(moved) - still_.mean_mps2);
  const double cop_share = step_s_ / (kCopTimeS + step_s_);
  const Eigen::Vector2d move = input.cop_valid
                                   ? Eigen::Vector2d(cop_share * (input.cop_m - cop_.mean_m))
                                   : Eigen::Vector2d::Zero();
  cop_.mean_m += move;
  const double speed = input.cop_valid ? move.norm() / step_s_ : config_.still_cop_mps * 2;
  cop_.speed_mps += cop_share * (speed - cop_.speed_mps);
  const bool calm = still_.mean_mps2 < config_.still_acceleration_mps2 &&
                    cop_.speed_mps < config_.still_cop_mps &&
                    !(posture_.anchors_s > 0 && std::abs(posture_.speed_mps) > kStillPostureMps);
  still_.for_s = calm ? still_.for_s + step_s_ : 0;
}

void VerticalCom::LookAtVelocity() {
  const VerticalFilter::Row row = VerticalFilter::Row::Unit(1);
  const VerticalFilter::Scalar now = filter_.Of(row);
  const MixtureMoments product = TimesMixture(
      {now.mean, now.variance},
      {{{kStillShare, 0, config_.still_velocity_mps}, {1 - kStillShare, 0, kSlowMps}}});
  // Filters find stillness at different times, postures at the same.
  if (posture_.anchors_s <= 0) Score(product.log_evidence);
  filter_.SetMoments(row, {product.moments.mean, product.moments.variance});
}

bool VerticalCom::IsImpossible(const VerticalFilter::Scalar& height) const {
  const double sure_m = kStraySpreads * std::sqrt(height.variance);
  return height.mean - sure_m > kHighestM || height.mean + sure_m < kLowestM;
}

void VerticalCom::Anchor() {
  const VerticalFilter::Row row = VerticalFilter::Row::Unit(0);
  const VerticalFilter::Scalar now = filter_.Of(row);
  if (IsImpossible(now)) {
    posture_.strayed = true;  // A cut would make it surer still.
    return;
  }
  if (posture_.anchors_s > 0) return;
  const double upright = config_.upright_share;
  MixtureMoments product = TimesMixture(
      {now.mean, now.variance}, {{{upright, -config_.upright_below_m, config_.upright_spread_m},
                                  {1 - upright, -config_.low_below_m, config_.low_spread_m}}});
  Score(product.log_evidence);
  const Moments posterior = Below(product.moments, config_.highest_m);
  filter_.SetMoments(row, {posterior.mean, posterior.variance});
}

void VerticalCom::Reseed(double height_m, double height_sd_m, double velocity_mps,
                         double velocity_sd_mps) {
  VerticalFilter::Vector x = filter_.x();
  VerticalFilter::Matrix p = VerticalFilter::Matrix::Zero();
  p.block<kCells, kCells>(kGains, kGains) = filter_.p().block<kCells, kCells>(kGains, kGains);
  p.block<kGroups, kGroups>(kGains, kGains).array() += kReseedGain * kReseedGain;
  x(0) = height_m;
  x(1) = velocity_mps;
  x(2) = 0;
  x(kPosture) = PostureMean();
  p(0, 0) = height_sd_m * height_sd_m;
  p(1, 1) = velocity_sd_mps * velocity_sd_mps;
  p(2, 2) = config_.slow_force_n * config_.slow_force_n / (mass_kg_ * mass_kg_);
  p(kPosture, kPosture) = PostureSpread() * PostureSpread();
  filter_.Start(x, p);
  posture_ = {};
  t_pose_.held = false;
  LeaveRests();
  filter_.Remember(VerticalFilter::Row::Unit(0));
}

void VerticalCom::Score(double log_density) { score_ += std::max(log_density, kLeastLogDensity); }

void VerticalCom::Adopt(const VerticalCom& other) {
  filter_ = other.filter_;
  score_ = other.score_;
  mass_kg_ = other.mass_kg_;
  overweight_ = other.overweight_;
  posture_ = other.posture_;
  last_.raw_mps2 = Total(last_.input) / mass_kg_ - kStandardGravityMps2;
}

double VerticalCom::weighed_kg() const {
  return mass_kg_ / std::clamp(1 - Overweight().mean, kLeastShare, 2 - kLeastShare);
}

void VerticalCom::Reweigh() {
  // (1 - gain) / mass of each group stays what it was.
  const double share = mass_kg_ / weighed_kg();
  VerticalFilter::Vector shift = VerticalFilter::Vector::Zero();
  for (int i = kGains; i < kPlay; ++i) shift(i) = 1 - (1 - filter_.x()(i)) / share - filter_.x()(i);
  filter_.Predict(VerticalFilter::Matrix::Identity(), shift, VerticalFilter::Matrix::Zero());
  mass_kg_ /= share;
  overweight_ *= share;
  last_.raw_mps2 = Total(last_.input) / mass_kg_ - kStandardGravityMps2;
}

VerticalFilter::Scalar VerticalCom::Play() const {
  return filter_.Of(VerticalFilter::Row::Unit(kPlay));
}

void VerticalCom::DoubtPlay() {
  VerticalFilter::Matrix q = VerticalFilter::Matrix::Zero();
  q(kPlay, kPlay) = std::max(0.0, config_.play_n * config_.play_n - filter_.p()(kPlay, kPlay));
  filter_.Predict(VerticalFilter::Matrix::Identity(), VerticalFilter::Vector::Zero(), q);
}

void VerticalCom::Coast() {
  VerticalFilter::Matrix a = VerticalFilter::Matrix::Identity();
  a(0, 1) = step_s_;
  VerticalFilter::Matrix q = q_;
  q(1, 1) += kCoastMps2 * kCoastMps2 * step_s_ * step_s_;
  u_.setZero();
  filter_.Predict(a, u_, q);
  last_.started = false;
  LeaveRests();
  steady_.since_s = 0;
  still_.for_s = 0;
  filter_.Remember(VerticalFilter::Row::Unit(0));
}

// Weight as a filter learns it from a body that keeps its T-pose, or stands still.
namespace {

// Loads are steady that keep, smoothed, within a limit of their mean. A person who stood still on
// laboratory plates (OpenCap subject 4, static1, 5 s) had a scatter of 0.011 m/s2 about means of
// 0.3 s, which differed from each other by 0.002.
constexpr double kNearS = 0.05, kSteadyMps2 = 0.06, kSteadyS = 0.3;
// Standard deviation of a mean of steady loads, as an acceleration.
constexpr double kLevelSpreadMps2 = 0.01;
// More of the weight than this is not wrong but elsewhere: a foot stands beside the boards.
constexpr double kMostWrong = 0.15;
// A body that the loads accelerate has moved by this while they were steady, more than its posture.
constexpr double kMovedM = 0.02;
// Means of the same steady loads are all wrong by the same: one counts where it says so many times
// more than is known.
constexpr double kNewLevel = 2;
// The T-pose is kept by a posture that, smoothed, is off its mean by less.
constexpr double kHeldS = 0.1, kHeldM = 0.004;
// Time between looks at a body in its T-pose, and what its velocity and height are worth.
constexpr double kLookS = 0.2, kHoldMps = 0.01, kHoldM = 0.015;

}  // namespace

void VerticalCom::WatchLevel(double raw_mps2) {
  steady_.since_s += step_s_;
  steady_.near_mps2 += step_s_ / (kNearS + step_s_) * (raw_mps2 - steady_.near_mps2);
  if (std::abs(steady_.near_mps2 - steady_.mean_mps2) > kSteadyMps2) {
    steady_.since_s = 0;
    steady_.near_mps2 = raw_mps2;
  }
  steady_.mean_mps2 += step_s_ / (steady_.since_s + step_s_) * (raw_mps2 - steady_.mean_mps2);
}

void VerticalCom::FollowHold(double height_m) {
  if (!t_pose_.held) return;
  if (t_pose_.frames == 0) t_pose_.near_m = height_m;
  t_pose_.frames += 1;
  t_pose_.mean_m += (height_m - t_pose_.mean_m) / t_pose_.frames;
  t_pose_.near_m += step_s_ / (kHeldS + step_s_) * (height_m - t_pose_.near_m);
  t_pose_.held = std::abs(t_pose_.near_m - t_pose_.mean_m) < kHeldM;
  if (!t_pose_.held) DoubtWeight(config_.weight.after_t_pose);
}

void VerticalCom::DoubtWeight(double share) {
  Filter::Matrix q = Filter::Matrix::Zero();
  q.block<VerticalInput::kGroups, VerticalInput::kGroups>(kGains, kGains)
      .setConstant(share * share);
  filter_.Predict(Filter::Matrix::Identity(), Filter::Vector::Zero(), q);
}

bool VerticalCom::holds_t_pose() const {
  return t_pose_.held && posture_.anchors_s > 0 && steady_.since_s >= kSteadyS &&
         cop_.speed_mps < config_.still_cop_mps;
}

bool VerticalCom::IsWeight(double left_mps2) const {
  const double off_mps2 = std::abs(left_mps2);
  return 0.5 * off_mps2 * steady_.since_s * steady_.since_s > kMovedM &&
         off_mps2 < kMostWrong * kStandardGravityMps2;
}

void VerticalCom::LookAtTPose(const VerticalInput& input) {
  t_pose_.since_look_s += step_s_;
  if (t_pose_.since_look_s < kLookS) return;
  t_pose_.since_look_s = 0;
  const Filter::Row row = LevelRow(input);
  const Filter::Scalar known = filter_.Of(row);
  const double left_mps2 = steady_.mean_mps2 - known.mean;
  const bool wrong = std::abs(left_mps2) > kSteadyMps2;
  if (wrong && !IsWeight(left_mps2)) return;
  if (wrong || known.variance > std::pow(kNewLevel * kLevelSpreadMps2, 2)) {
    LearnLevel(row, steady_.mean_mps2, left_mps2, kLevelSpreadMps2);
  }
  filter_.Update(Filter::Row::Unit(1), 0, kHoldMps * kHoldMps);
  filter_.Update(Filter::Row::Unit(0), 0, kHoldM * kHoldM);
}

void VerticalCom::LookAtLevel(const VerticalInput& input) {
  const Filter::Row row = LevelRow(input);
  const double left_mps2 = level_mps2_ - filter_.Of(row).mean;
  const double limit_mps2 = config_.still_acceleration_mps2;
  if (std::abs(left_mps2) > limit_mps2 && IsWeight(left_mps2)) {
    LearnLevel(row, level_mps2_, left_mps2, limit_mps2);
  }
}

VerticalCom::Filter::Row VerticalCom::LevelRow(const VerticalInput& input) const {
  Filter::Row row = Filter::Row::Unit(2);
  for (int i = 0; i < VerticalInput::kGroups; ++i) {
    row(kGains + i) = input.load_n[static_cast<std::size_t>(i)] / mass_kg_;
  }
  row(kPlay) = -input.play / mass_kg_;
  return row;
}

void VerticalCom::LearnLevel(const Filter::Row& row, double level_mps2, double left_mps2,
                             double sd_mps2) {
  if (std::abs(left_mps2) > std::max(sd_mps2, kSteadyMps2)) {  // All that was known is in doubt.
    DoubtWeight(left_mps2 / kStandardGravityMps2);
  }
  filter_.Update(row, level_mps2, sd_mps2 * sd_mps2);
}

// Use of postures by the filter of the height.
namespace {

constexpr double kPostureLookS = 0.3;
constexpr double kPostureAnchorLookS = 0.5, kPostureAnchorsS = 0.1;
// A filter has strayed that is for a while so many deviations from the posture.
constexpr double kFarSpreads = 4, kFarS = 0.2, kDoubtSpreads = 3;
// How fast a posture rises, smoothed, says how fast the body does: in kSpeedRight of looks right to
// the sum of kSpeedMps and a share of itself, else, as where knees bend under still hands, to
// kWrongSpeedMps. On people left out 0.9, 0.02, 0.7 and 0.2 fit best; looks that follow each other
// so closely are not independent, hence more.
constexpr double kPostureSpeedS = 0.3, kSpeedLookS = 0.25, kSpeedSettlesS = 3 * kPostureSpeedS;
constexpr double kLandingS = 0.8;  // Until a body that has landed stands again, or leaps.
// Share of landings on straight legs; in the others the knees give way by up to 40 cm, of which a
// posture shows little.
constexpr double kStiffLandings = 0.5, kGivesWayM = 0.2, kGivesWaySpreadM = 0.12;
constexpr double kSpeedRight = 0.8, kSpeedMps = 0.04, kSpeedShare = 0.7, kWrongSpeedMps = 0.25;

/// A posture is off by so much, and may be by that variance.
template <typename Watched>
void Compare(double off_m, double variance_m2, double step_s, Watched& posture) {
  const bool far = off_m * off_m > kFarSpreads * kFarSpreads * variance_m2;
  posture.contradicted = off_m * off_m > kDoubtSpreads * kDoubtSpreads * variance_m2;
  posture.far_s = far ? posture.far_s + step_s : 0;
  posture.strayed = posture.strayed || posture.far_s > kFarS;
  posture.since_score_s += step_s;
}

}  // namespace

void VerticalCom::SeePosture(double height_m) {
  const PostureError& posture = config_.posture;
  if (posture.spread_m <= 0) return;
  if (posture.right_share > 0) {
    AnchorToPosture(height_m);
    return;
  }
  Filter::Row h = posture.share * Filter::Row::Unit(0);
  h(kPosture) = 1;
  filter_.Update(h, height_m, posture.white_m * posture.white_m);
  const double s = filter_.p()(0, 0) + posture.spread_m * posture.spread_m;
  const double off_m = height_m - posture.share * filter_.x()(0);
  Compare(off_m, s, step_s_, posture_);
  if (posture_.since_score_s >= kPostureLookS) {
    posture_.since_score_s = 0;
    Score(-0.5 * (off_m * off_m / s + std::log(s)));
  }
}

void VerticalCom::FollowSpeed(double height_m) {
  if (posture_.anchors_s <= 0) {
    posture_.level_m = height_m;
    posture_.gained_mps = 0;
    // From rest it is right at once.
    const bool rests = filter_.Of(Filter::Row::Unit(1)).variance < kSpeedMps * kSpeedMps;
    posture_.since_speed_s = rests ? 0 : -kSpeedSettlesS;
  }
  posture_.anchors_s = kPostureAnchorsS;
  const double share = step_s_ / (kPostureSpeedS + step_s_);
  posture_.speed_mps = (height_m - posture_.level_m) / kPostureSpeedS;
  posture_.level_m += share * (height_m - posture_.level_m);
  FollowHold(height_m);
  posture_.gained_mps = (1 - share) * (posture_.gained_mps + step_s_ * acceleration_mps2_);
  posture_.since_speed_s += step_s_;
  if (config_.by_rests && follows_loads()) return;
  if (posture_.since_speed_s < kSpeedLookS || !Loaded(last_.raw_mps2)) return;
  posture_.since_speed_s = 0;
  LookAtPostureSpeed();
}

void VerticalCom::LookAtPostureSpeed() {
  const Filter::Row row = Filter::Row::Unit(1);
  const Filter::Scalar now = filter_.Of(row);
  const double seen_mps = posture_.speed_mps + posture_.gained_mps;
  const double right_mps = kSpeedMps + kSpeedShare * std::abs(posture_.speed_mps);
  const MixtureMoments product = TimesMixture(
      {now.mean, now.variance},
      {{{kSpeedRight, seen_mps, right_mps}, {1 - kSpeedRight, seen_mps, kWrongSpeedMps}}});
  Score(product.log_evidence);
  filter_.SetMoments(row, {product.moments.mean, product.moments.variance});
}

void VerticalCom::Land(double height_m, double height_sd_m, double velocity_mps,
                       double velocity_sd_mps) {
  Reseed(height_m, height_sd_m, velocity_mps, velocity_sd_mps);
  posture_.landing_s = kLandingS;
  posture_.since_score_s = kLandingS;  // The first posture counts.
}

std::array<Component, 2> VerticalCom::ByPosture(double height_m) const {
  const PostureError& posture = config_.posture;
  if (posture_.landing_s > 0) {
    return {{{kStiffLandings, height_m, posture.right_m},
             {1 - kStiffLandings, height_m - kGivesWayM, kGivesWaySpreadM}}};
  }
  return {{{posture.right_share, height_m, posture.right_m},
           {1 - posture.right_share, height_m, posture.spread_m}}};
}

void VerticalCom::AnchorToPosture(double height_m) {
  const PostureError& posture = config_.posture;
  FollowSpeed(height_m);
  if (config_.by_rests) SeeRest(height_m);
  const Filter::Row row = Filter::Row::Unit(0);
  const Filter::Scalar now = filter_.Of(row);
  Compare(height_m - now.mean, now.variance + posture.spread_m * posture.spread_m, step_s_,
          posture_);
  if (config_.by_rests && follows_loads()) return;
  // A height that is less certain than a posture at its worst is corrected before a look is due;
  // but looks at a landing that follow each other are all wrong by the same.
  const bool lands = posture_.landing_s > 0;
  const bool lost = !lands && now.variance > posture.spread_m * posture.spread_m;
  const bool due = posture_.since_score_s >= kPostureAnchorLookS;
  if (!due && !lost) return;
  if (due) posture_.since_score_s = 0;
  const MixtureMoments product = TimesMixture({now.mean, now.variance}, ByPosture(height_m));
  if (due) Score(product.log_evidence);
  // No straight leg carries a body further up, however wrong the posture is about bent ones.
  const Moments posterior = Loaded(last_.raw_mps2)
                                ? Below(product.moments, std::max(height_m, 0.0) + kTiptoeM)
                                : product.moments;
  filter_.SetMoments(row, {posterior.mean, posterior.variance});
}

// A filter that integrates the loads from rest to rest, where postures show how high the body is.
namespace {

// A body is calm that has nearly no acceleration, by the loads less what is known of them, and a
// COP that hardly moves. It rests when it is calm for `kCalmS` and, by the filter, still and as
// high as the posture shows; or when its loads are steady for `kRestSteadyS` and it is still by the
// filter, at any height that legs allow: hands that stay where they are do not show a squat. Its
// loads are steady for `kSureS` where it is not still by the filter: then the filter may be wrong.
constexpr double kCalmMps2 = 0.5, kCalmCopMps = 0.15, kCalmS = 0.15;
constexpr double kRestSteadyS = 0.3, kSureS = 1, kLowestRestM = -0.6;
// Squared Mahalanobis distances: of a velocity from zero at which the body is still, and at which
// it has left a rest of unknown height.
constexpr double kStillDistance2 = 4, kMovesDistance2 = 9;
// Evidence below which a way has not led to a rest.
constexpr double kFailed = -1;
// The error of the height of a posture that stands: mean and standard deviation of what is the same
// at every rest, and standard deviation of the rest. Two people left out of the model stand 1 to 2
// cm too low in the mean.
constexpr double kStandsM = -0.015, kStandsSpreadM = 0.03, kStandsWhiteM = 0.01;
constexpr double kRestMps = 0.02;     // Standard deviation of the velocity of a body that rests.
constexpr double kRestLookS = 0.5;    // Time between independent looks at one rest.
constexpr double kBackDistance2 = 6;  // Squared Mahalanobis distance, of height and velocity.
// Wrong cells end a way too high or low, and too fast, by so much of its depth (m, and m/s).
constexpr double kWrongShare = 0.5;
// Doubt after a return that failed: of the weight, and of the height.
constexpr double kRestartGain = 0.005, kRestartM = 0.03;
constexpr double kTooHighSpreads = 3;
constexpr double kLongS = 1e3;

}  // namespace

double VerticalCom::PostureMean() const { return config_.by_rests ? kStandsM : 0; }

double VerticalCom::PostureSpread() const {
  return config_.by_rests ? kStandsSpreadM : config_.posture.spread_m;
}

void VerticalCom::LeaveRests() {
  rest_ = {};
  rest_.away_s = kLongS;
}

std::optional<Return> VerticalCom::TakeReturn() {
  const std::optional<Return> found = rest_.found;
  rest_.found.reset();
  return found;
}

void VerticalCom::RestartFrom(const VerticalCom& other) {
  Adopt(other);
  Filter::Vector x = filter_.x();
  Filter::Matrix p = filter_.p();
  x(kPosture) = kStandsM;
  p.row(kPosture).setZero();
  p.col(kPosture).setZero();
  p(kPosture, kPosture) = kStandsSpreadM * kStandsSpreadM;
  p(0, 0) += kRestartM * kRestartM;
  p.block<VerticalInput::kGroups, VerticalInput::kGroups>(kGains, kGains).array() +=
      kRestartGain * kRestartGain;
  filter_.Start(x, p);
  filter_.Remember(Filter::Row::Unit(0));
  LeaveRests();
}

VerticalCom::Fit VerticalCom::FitOfRest(double height_m, double wrong) const {
  Filter::Row h = Filter::Row::Unit(0);
  h(kPosture) = 1;
  const Filter::Row v = Filter::Row::Unit(1);
  const double off_m = height_m - h * filter_.x(), off_mps = -filter_.x()(1);
  const double a = filter_.Of(h).variance + kStandsWhiteM * kStandsWhiteM + wrong * wrong;
  const double b = filter_.Of(v).variance + kRestMps * kRestMps + wrong * wrong;
  const double c = h * filter_.p() * v.transpose(), det = a * b - c * c;
  const double distance2 =
      (b * off_m * off_m - 2 * c * off_m * off_mps + a * off_mps * off_mps) / det;
  return {distance2, -0.5 * (distance2 + std::log(det))};
}

VerticalCom::Fit VerticalCom::FitOfStillness(double wrong) const {
  const Filter::Scalar v = filter_.Of(Filter::Row::Unit(1));
  const double variance = v.variance + kRestMps * kRestMps + wrong * wrong;
  const double distance2 = v.mean * v.mean / variance;
  return {distance2, -0.5 * (distance2 + std::log(variance))};
}

void VerticalCom::SeeRest(double height_m) {
  const bool calm = std::abs(acceleration_mps2_) < kCalmMps2 && cop_.speed_mps < kCalmCopMps;
  rest_.calm_s = calm ? rest_.calm_s + step_s_ : 0;
  const bool rested = rest_.rests;
  if (!rested) {
    ComeToRest(height_m);
  } else {
    // The end of a rest of unknown height is shown by nothing but the velocity.
    rest_.rests = calm && (rest_.known || FitOfStillness(0).distance2 < kMovesDistance2);
  }
  if (rest_.rests) {
    LookAtRest(height_m);
    return;
  }
  const Filter::Scalar now = filter_.Of(Filter::Row::Unit(0));
  if (rested) rest_.lowest_m = rest_.highest_m = now.mean;
  rest_.away_s += step_s_;
  rest_.lowest_m = std::min(rest_.lowest_m, now.mean);
  rest_.highest_m = std::max(rest_.highest_m, now.mean);
  const double sure_m = kTooHighSpreads * std::sqrt(now.variance);
  if (Loaded(last_.raw_mps2) && now.mean - sure_m > std::max(height_m, 0.0) + kTiptoeM) {
    rest_.found = Return{};
  }
}

void VerticalCom::ComeToRest(double height_m) {
  const double steady_s = std::min(steady_.since_s, rest_.calm_s), z_m = filter_.x()(0);
  const bool back = rest_.calm_s >= kCalmS && FitOfRest(height_m, 0).distance2 < kBackDistance2;
  const bool still = steady_s >= kRestSteadyS && FitOfStillness(0).distance2 < kStillDistance2 &&
                     z_m > kLowestRestM && z_m < std::max(height_m, 0.0) + kTiptoeM;
  if (!back && !still && steady_s < kSureS) return;
  const double wrong = kWrongShare * (rest_.highest_m - rest_.lowest_m);
  const double evidence =
      back ? FitOfRest(height_m, 0).log_density - FitOfRest(height_m, wrong).log_density
           : FitOfStillness(0).log_density - FitOfStillness(wrong).log_density;
  rest_.rests = back || still;
  if (!rest_.rests && evidence > kFailed) return;
  rest_.found = Return{rest_.rests, follows_loads(), evidence};
  rest_.known = back;
  rest_.since_look_s = kRestLookS;
}

void VerticalCom::LookAtRest(double height_m) {
  rest_.away_s = 0;
  rest_.known = rest_.known || FitOfRest(height_m, 0).distance2 < kBackDistance2;
  rest_.since_look_s += step_s_;
  if (rest_.since_look_s < kRestLookS) return;
  rest_.since_look_s = 0;
  if (!rest_.known && FitOfStillness(0).distance2 > kStillDistance2) return;
  filter_.Update(Filter::Row::Unit(1), 0, kRestMps * kRestMps);
  if (!rest_.known) return;
  Filter::Row h = Filter::Row::Unit(0);
  h(kPosture) = 1;
  filter_.Update(h, height_m, kStandsWhiteM * kStandsWhiteM);
}

std::vector<VerticalFilter::Scalar> SmoothVertical(const VerticalConfig& config, double mass_kg,
                                                   double step_s, const VerticalInput& mean,
                                                   const std::vector<VerticalInput>& inputs) {
  if (inputs.empty()) return {};
  struct Step {
    VerticalFilter::Vector x, u;
    VerticalFilter::Matrix p, a;
  };
  VerticalCom com(config, mass_kg, step_s);
  com.Start(mean);
  std::vector<Step> steps;
  steps.reserve(inputs.size());
  for (const VerticalInput& input : inputs) {
    com.Advance(input);
    steps.push_back({com.filter().x(), com.input_shift(), com.filter().p(), com.transition()});
  }
  std::vector<VerticalFilter::Scalar> out(steps.size());
  VerticalFilter::Vector x = steps.back().x;
  VerticalFilter::Matrix p = steps.back().p;
  for (std::size_t i = steps.size(); i-- > 0;) {
    if (i + 1 < steps.size()) {
      const Step& next = steps[i + 1];
      const VerticalFilter::Matrix p_ahead = next.a * steps[i].p * next.a.transpose() + com.noise();
      const VerticalFilter::Matrix gain = p_ahead.ldlt().solve(next.a * steps[i].p).transpose();
      x = steps[i].x + gain * (x - (next.a * steps[i].x + next.u));
      p = steps[i].p + gain * (p - p_ahead) * gain.transpose();
    }
    out[i] = {x(0), std::max(0.0, p(0, 0))};
  }
  return out;
}

namespace {

constexpr double kNoiseSpreads = 3;    // A reading within so many deviations of its noise rests.
constexpr double kFlipSpreads = 2;     // A reading that moves by so many is at the end of its play.
constexpr double kMiddleTimeS = 0.08;  // In which the middle is taken for one that rests.

}  // namespace

double CellPlay::Advance(const std::array<double, VerticalInput::kGroups>& load_n, double step_s) {
  const double rests_n = kNoiseSpreads * noise_n_;
  double sum = 0;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    Group& group = groups_[i];
    if (!started_) group.reading_n = load_n[i];
    const double moved_n =
        std::clamp(group.reading_n, load_n[i] - rests_n, load_n[i] + rests_n) - group.reading_n;
    group.reading_n += moved_n;
    group.end = moved_n == 0
                    ? group.end * std::exp(-step_s / kMiddleTimeS)
                    : std::clamp(group.end + moved_n / (kFlipSpreads * noise_n_), -1.0, 1.0);
    sum += group.end;
  }
  started_ = true;
  return sum;
}

}  // namespace footing::momentum
