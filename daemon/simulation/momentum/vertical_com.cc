#include "daemon/simulation/momentum/vertical_com.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/momentum/mixture.h"

namespace footing::momentum {
namespace {

using VerticalFilter = VerticalCom::Filter;

constexpr int kGroups = VerticalInput::kGroups;
constexpr int kGains = VerticalCom::kGains, kPlay = VerticalCom::kPlay;
constexpr int kCells = kGroups + 1;          // What is learned of them: gains, and the play.
constexpr double kAccelerationTimeS = 0.12;  // Smoothing of |acceleration|.
// Of the acceleration that is kept. One that is further off than `kLeap` limits of stillness has
// another level, which is found at once where a posture is seen: it shows who moves.
constexpr double kLevelTimeS = 0.5, kLeapTimeS = 0.05, kLeap = 1.2;
constexpr double kCopTimeS = 0.1;     // Smoothing of the COP, and again of its speed.
constexpr double kStillLookS = 0.1;   // Time between zero-velocity measurements.
constexpr double kLoadedShare = 0.5;  // Of the weight: with less, the body may fly.
constexpr double kScoreTimeS = 30;
constexpr double kLeastLogDensity = -20;  // One event alone condemns nothing.
constexpr double kCoastMps2 = 20;         // Of a velocity that nobody watches, per root frame.
constexpr double kLeastShare = 0.5;       // Of a weight that is taken for the true one.
// A body that moves slowly and evenly looks still, too: in this share of looks it is, else it has
// this speed.
constexpr double kStillShare = 0.6, kSlowMps = 0.04;
// A body whose posture rises or sinks is not still, however even its loads are.
constexpr double kStillPostureMps = 0.02;
// A filter has strayed that is sure, by so many deviations, of a height over tiptoe with raised
// arms or under the ground.
constexpr double kStraySpreads = 4, kHighestM = 0.15, kLowestM = -0.75;
constexpr double kReseedGain = 0.03;  // Of the weight: what a filter that strayed may have learned.
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

}  // namespace footing::momentum
