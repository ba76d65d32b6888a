#include "daemon/simulation/momentum/vertical_bank.h"

#include <algorithm>
#include <cmath>

namespace footing::momentum {
namespace {

// Of the height of an upright body: raised arms, bent knees. It stays while the posture does, so
// no number of looks makes it smaller.
constexpr double kPostureSpreadM = 0.02;
constexpr double kLeastCellNoiseN = 0.1;
// Log densities: the trusting filter must have foreseen more, or much less, to change who speaks.
constexpr double kTrustAbove = 2;
constexpr double kDoubtBelow = -4;
// By which the one of cells with play must have foreseen more than what would speak without it.
constexpr double kPlayAbove = 4;
// And there must be some, by so many of its deviations.
constexpr double kPlaySpreads = 1.5;
constexpr double kAdoptEveryS = 5;
// Evidence of the ways from rest to rest: above which, and most of which, counts. One way never has
// as much: it may lead back by chance.
constexpr double kReturnsAbove = 3.5, kMostReturns = 8, kFailedReturns = -4;
// Until its ways are known to fail, loads from rest to rest that have the body elsewhere than the
// output are contradicted by it: by so many deviations of both, and at least by so much.
constexpr double kApartSpreads = 2, kApartM = 0.1;
// Parts of the weight: by which the T-pose's is wrong before it is doubted at all, and to which the
// weight must be known to be given to the others: from a body that kept its T-pose, which they
// follow better than the unweighed filter does, or from one that moved.
constexpr double kLeastOverweight = 0.005;
constexpr double kSettledInTPose = 0.0025, kSettledSpread = 0.001;
constexpr double kPostureS = 0.1;  // A posture older than this is not used.
// Where a body is that nothing is known of, and how fast when it lands: a step onto the cells and a
// fall of 46 cm are one deviation off.
constexpr double kAnyHeightM = 0, kAnyHeightSpreadM = 0.15;
constexpr double kLandingMps = -1.5, kLandingSpreadMps = 1.5;
constexpr double kReseedMps = 0.5;
// Where a body is when its feet come down from a flight.
constexpr double kLandingHeightM = -0.03, kLandingSpreadM = 0.06;
constexpr double kRecoverEveryS = 1,
                 kBehind = 10;  // How often, and by how much, others may be worse.
constexpr double kTrustedSpreadM = 0.12;
constexpr double kSureSpreads = 4;  // Of what both know of it.

VerticalConfig WithPosture(VerticalConfig config, const PostureError& posture) {
  config.posture = posture;
  return config;
}

}  // namespace

VerticalConfig TrustingVertical(double arms_hang_m, double cell_noise_n) {
  VerticalConfig config;
  config.cell_noise_n = std::max(cell_noise_n, kLeastCellNoiseN);
  config.upright_below_m = arms_hang_m;
  config.slow_force_n = 0.0015;
  config.slow_force_time_s = 0.16;
  config.gain_spread = 0.002;
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
  return config;
}

VerticalConfig DoubtfulVertical(double arms_hang_m, double cell_noise_n) {
  VerticalConfig config;
  config.cell_noise_n = std::max(cell_noise_n, kLeastCellNoiseN);
  config.upright_below_m = arms_hang_m;
  config.slow_force_n = 1.0;
  config.slow_force_time_s = 6;
  config.still_acceleration_mps2 = 0.14;
  config.still_cop_mps = 0.055;
  config.still_velocity_mps = 0.006;
  config.look_s = 0.3;
  config.upright_share = 0.87;
  config.upright_spread_m = 0.033;
  config.highest_m = 0.013;
  return config;
}

VerticalConfig UnweighedVertical(double arms_hang_m, double cell_noise_n, double mass_kg) {
  VerticalConfig config = DoubtfulVertical(arms_hang_m, cell_noise_n);
  config.weight.spread = 0.02;
  config.mass_error_kg = mass_kg;  // What the T-pose weighed says nothing.
  config.still_at_any_weight = true;
  return config;
}

VerticalConfig WaryVertical(double arms_hang_m, double cell_noise_n, double mass_kg) {
  VerticalConfig config = UnweighedVertical(arms_hang_m, cell_noise_n, mass_kg);
  config.weight.spread = 0.05;
  config.weight.walk = 0.002;
  config.slow_force_n = 4;
  config.slow_force_time_s = 2;
  config.gain_spread = 0.01;
  return config;
}

VerticalConfig LooseVertical(double arms_hang_m, double cell_noise_n) {
  VerticalConfig config = DoubtfulVertical(arms_hang_m, cell_noise_n);
  config.play_n = 3;
  config.slow_force_n = 3;
  config.slow_force_time_s = 2;
  return config;
}

VerticalConfig ReturningVertical(double arms_hang_m, double cell_noise_n, double mass_kg) {
  VerticalConfig config = TrustingVertical(arms_hang_m, cell_noise_n);
  config.by_rests = true;
  config.weight.spread = 0.005;  // Ways from rest to rest show the weight.
  config.mass_error_kg = config.weight.spread * mass_kg;
  config.weight.walk = 0.0002;
  return config;
}

VerticalBank::VerticalBank(double mass_kg, double step_s, double arms_hang_m, double cell_noise_n,
                           const PostureError& posture)
    : trusting_(WithPosture(TrustingVertical(arms_hang_m, cell_noise_n), posture), mass_kg, step_s),
      doubtful_(WithPosture(DoubtfulVertical(arms_hang_m, cell_noise_n), posture), mass_kg, step_s),
      unweighed_(WithPosture(UnweighedVertical(arms_hang_m, cell_noise_n, mass_kg), posture),
                 mass_kg, step_s),
      wary_(WithPosture(WaryVertical(arms_hang_m, cell_noise_n, mass_kg), posture), mass_kg,
            step_s),
      loose_(WithPosture(LooseVertical(arms_hang_m, cell_noise_n), posture), mass_kg, step_s),
      returning_(WithPosture(ReturningVertical(arms_hang_m, cell_noise_n, mass_kg), posture),
                 mass_kg, step_s),
      play_(std::max(cell_noise_n, kLeastCellNoiseN)),
      step_s_(step_s),
      posture_(posture) {}

void VerticalBank::KeepLag(int lag_steps) {
  for (VerticalCom* filter : All()) filter->KeepLag(lag_steps);
}

void VerticalBank::Start(const VerticalInput& mean) {
  for (VerticalCom* filter : All()) filter->Start(mean);
  returns_ = 0;
  returning_speaks_ = false;
  loose_speaks_ = false;
  wary_speaks_ = false;
  since_posture_s_ = kPostureS;
  trusts_ = false;
  adopted_s_ = 0;
  weighing_ = false;
  weighed_in_t_pose_ = false;
}

void VerticalBank::SeePosture(double height_m) {
  for (VerticalCom* filter : All()) filter->SeePosture(height_m);
  since_posture_s_ = 0;
  WatchReturns();
}

void VerticalBank::WatchReturns() {
  const std::optional<Return> found = returning_.TakeReturn();
  if (returning_.strayed() || (found && !found->back)) {
    returning_.RestartFrom(Others());
    returns_ = kFailedReturns;
  } else if (found) {
    returns_ =
        found->by_loads ? std::clamp(returns_ + found->evidence, kFailedReturns, kMostReturns) : 0;
  }
  returning_speaks_ = returns_ > kReturnsAbove && returning_.follows_loads();
}

bool VerticalBank::SeesPosture() const {
  return posture_.spread_m > 0 && since_posture_s_ < kPostureS;
}

void VerticalBank::Land() {
  // Each keeps its mass: what was learned of the weight stays true.
  for (VerticalCom* filter : All()) {
    filter->Land(kAnyHeightM, kAnyHeightSpreadM, kLandingMps, kLandingSpreadMps);
  }
  ForgetReturns();
}

void VerticalBank::Reappear() {
  for (VerticalCom* filter : All()) filter->Reseed(kAnyHeightM, kAnyHeightSpreadM, 0, kReseedMps);
  ForgetReturns();
}

void VerticalBank::ForgetReturns() {
  returns_ = 0;
  returning_speaks_ = false;
}

bool VerticalBank::CanLand() const {
  const VerticalCom::Filter::Scalar height = chosen().Height(0);
  const double off_m = height.mean - kLandingHeightM;
  return off_m * off_m <
         kSureSpreads * kSureSpreads * (height.variance + kLandingSpreadM * kLandingSpreadM);
}

void VerticalBank::Recover() {
  // The posture of this frame finds the height.
  if (wary_.strayed()) wary_.Reseed(kAnyHeightM, kAnyHeightSpreadM, 0, kReseedMps);
  since_look_s_ += step_s_;
  // Without a posture nothing but a height that is impossible speaks for it.
  const bool seen = SeesPosture();
  const bool look = seen && since_look_s_ >= kRecoverEveryS;
  if (look) since_look_s_ = 0;
  for (VerticalCom* filter : {&trusting_, &doubtful_, &unweighed_}) {
    if (filter->strayed() || (look && filter->score() < wary_.score() - kBehind)) {
      filter->Adopt(wary_);
    }
  }
  WatchPlay(seen, look);
  if (!seen) {
    wary_speaks_ = false;
    return;
  }
  // Those that would supply the output without it.
  const double best =
      weighing_ ? unweighed_.score() : std::max(doubtful_.score(), trusting_.score());
  wary_speaks_ = wary_speaks_ ? best < wary_.score() + kTrustAbove : best < wary_.score() - kBehind;
}

void VerticalBank::WatchPlay(bool seen, bool look) {
  double best = std::max(trusting_.score(), doubtful_.score());
  if (weighing_) best = std::max(best, unweighed_.score());
  if (wary_speaks_) best = std::max(best, wary_.score());
  const double lead = loose_.score() - best;
  const bool lost = loose_.strayed() || (look && lead < -kBehind);
  if (lost) {
    loose_.Adopt(loose_.strayed() ? wary_ : Tight());
    loose_.DoubtPlay();
  }
  const VerticalCom::Filter::Scalar play = loose_.Play();
  const bool found = !lost && play.mean > kPlaySpreads * std::sqrt(play.variance);
  loose_speaks_ = seen && found && lead > (loose_speaks_ ? 0 : kPlayAbove);
  if (!look || !found) return;
  for (VerticalCom* filter : {&trusting_, &doubtful_, &unweighed_}) {
    if (filter->score() < loose_.score() - kBehind) filter->Adopt(loose_);
  }
}

bool VerticalBank::LoadsContradict() const {
  if (returning_speaks_ || returns_ < 0 || !returning_.follows_loads()) return false;
  const VerticalCom::Filter::Scalar loads = returning_.Height(0), output = Others().Height(0);
  const double apart_m = std::abs(loads.mean - output.mean);
  return apart_m > kApartM && apart_m > kApartSpreads * std::sqrt(loads.variance + output.variance);
}

bool VerticalBank::trusted() const {
  if (SeesPosture() && (chosen().contradicted() || LoadsContradict())) return false;
  return chosen().Height(0).variance < kTrustedSpreadM * kTrustedSpreadM;
}

void VerticalBank::Advance(const VerticalInput& input) {
  VerticalInput with_play = input;
  with_play.play = play_.Advance(input.load_n, step_s_);
  for (VerticalCom* filter : All()) filter->Advance(with_play);
  since_posture_s_ += step_s_;
  returning_speaks_ = returning_speaks_ && SeesPosture();
  Recover();
  Weigh();
  adopted_s_ += step_s_;
  const double lead = trusting_.score() - doubtful_.score();
  if (trusts_ ? lead < kDoubtBelow : lead > kTrustAbove) trusts_ = !trusts_;
  if (!trusts_ && lead < kDoubtBelow && adopted_s_ >= kAdoptEveryS) {
    trusting_.Adopt(doubtful_);
    adopted_s_ = 0;
  }
}

void VerticalBank::Weigh() {
  const auto free = unweighed_.Overweight(), held = doubtful_.Overweight();
  if (weighing_) {
    // They may have adopted a state that is better by now.
    const VerticalCom& other = trusts_ ? trusting_ : doubtful_;
    if (unweighed_.score() - other.score() < kDoubtBelow) unweighed_.Adopt(other);
    if (unweighed_.holds_t_pose()) {
      weighed_in_t_pose_ = true;
      return;
    }
    const double settled = weighed_in_t_pose_ ? kSettledInTPose : kSettledSpread;
    if (free.variance > settled * settled) return;
    weighing_ = false;
    weighed_in_t_pose_ = false;
    unweighed_.Reweigh();
    doubtful_.Adopt(unweighed_);
    trusting_.Adopt(unweighed_);
    returning_.RestartFrom(unweighed_);
    returns_ = 0;
    returning_speaks_ = false;
    return;
  }
  const double off = std::abs(free.mean - held.mean);
  weighing_ = off > kLeastOverweight &&
              off * off > kSureSpreads * kSureSpreads * (free.variance + held.variance);
}

void VerticalBank::Coast() {
  for (VerticalCom* filter : All()) filter->Coast();
}

VerticalCom::Filter::Scalar VerticalBank::Height(int lag_steps) const {
  VerticalCom::Filter::Scalar height = chosen().Height(lag_steps);
  height.variance += kPostureSpreadM * kPostureSpreadM;
  return height;
}

}  // namespace footing::momentum
