#include "common/board/step_cadence.h"

#include <algorithm>
#include <cmath>

namespace footing::board {
namespace {

/// The COP of standing is followed slowly, and not while it is on the toes.
constexpr double kStandingS = 1.0;

}  // namespace

bool HeelRise::Advance(double time_s, double load_share, double forward_m, double even_s) {
  const double elapsed_s = started_ ? time_s - time_s_ : 0;
  if (!started_) heels_m_ = forward_m;
  started_ = true;
  time_s_ = time_s;
  if (even_s <= 0) {  // A foot is lifted: the next stand is another one.
    heels_m_ = forward_m;
    forward_s_ = pushed_s_ = -1e9;
    peak_ = 1;
    return false;
  }
  const double risen_m = forward_m - heels_m_;
  if (risen_m < borders_.forward_m / 2) {
    if (!down_) down_s_ = time_s;
    down_ = true;
    heels_m_ += risen_m * (1 - std::exp(-elapsed_s / kStandingS));
  }
  if (risen_m >= borders_.forward_m) forward_s_ = time_s;
  if (time_s - pushed_s_ > borders_.together_s) peak_ = 1;
  if (load_share - 1 >= borders_.overshoot) pushed_s_ = time_s;
  peak_ = std::max(peak_, load_share);
  const double first_s = std::min(forward_s_, pushed_s_);
  const double since_s = time_s - first_s;
  if (!down_ || first_s < down_s_ || even_s < borders_.standing_s || since_s > borders_.together_s)
    return false;
  down_ = false;
  return true;
}

namespace {

constexpr double kWeighingS = 3;

}  // namespace

Stance StanceOn(const FootLoad& left, const FootLoad& right) {
  const double left_n = std::max(0.0, left.load_n);
  const double right_n = std::max(0.0, right.load_n);
  Stance stance;
  stance.load_n = left_n + right_n;
  if (stance.load_n <= 0) return stance;
  stance.left_share = left_n / stance.load_n;
  double moment_nm = 0, load_n = 0;
  for (const FootLoad* foot : {&left, &right}) {
    if (!foot->cop_valid) continue;
    moment_nm += foot->load_n * foot->cop_x_m;
    load_n += foot->load_n;
  }
  if (load_n > 0) stance.forward_m = moment_nm / load_n;
  return stance;
}

void Weight::Advance(double load_n, double elapsed_s) {
  weighed_s_ = std::min(kWeighingS, weighed_s_ + elapsed_s);
  const double share = weighed_s_ > elapsed_s ? elapsed_s / weighed_s_ : 1;
  weight_n_ += share * (load_n - weight_n_);
}

namespace {

/// Share of the load from which a foot takes part in standing.
constexpr double kLoadedShare = 0.1;
/// Both carry about alike between this share and its complement.
constexpr double kEvenShare = 0.3;
constexpr double kStandingLeanS = 0.4;
/// Who has leaned on one foot for this time, and lifted none, stands.
constexpr double kLeansS = 0.7;
/// A step that takes longer than this times the last ones ends stepping; not before a heel rise
/// after it has had time to show: both feet stand for 0.2 s, and the heels rise within 0.35 s.
constexpr double kOverdue = 2;
constexpr double kHeelRiseShowsS = 0.55;

}  // namespace

/// The first change may follow a long stand on one foot: the second one measures the first step.
void StepCadence::ChangeFoot(double time_s, int foot) {
  const double took_s = time_s - changed_s_;
  if (steps_ >= 1) {
    steps_ = std::min(steps_ + 1, 3);
    step_s_ = steps_ >= 3 ? (took_s + last_step_s_) / 2 : took_s;
    stepping_lean_ = (lean_now_s_ + lean_before_s_) / (took_s + last_step_s_);
    last_step_s_ = took_s;
    lean_before_s_ = lean_now_s_;
  } else {
    steps_ = 1;
    last_step_s_ = lean_before_s_ = 0;
  }
  lean_now_s_ = 0;
  foot_ = foot;
  changed_s_ = time_s;
}

void StepCadence::Advance(double time_s, double left_share) {
  const double elapsed_s = started_ ? time_s - time_s_ : 0;
  started_ = true;
  time_s_ = time_s;
  const double lean = 1 - 2 * left_share;  // To the right.
  lean_now_s_ += lean * elapsed_s;
  const bool even = left_share > kEvenShare && left_share < 1 - kEvenShare;
  even_s_ = even ? even_s_ + elapsed_s : 0;
  const bool both = left_share > kLoadedShare && left_share < 1 - kLoadedShare;
  both_s_ = both ? both_s_ + elapsed_s : 0;
  const int foot = left_share > borders_.stance_above       ? -1
                   : left_share < 1 - borders_.stance_above ? 1
                   : steps_ == 0 && even                    ? 0
                                                            : foot_;
  if (foot == 0) {
    foot_ = 0;
  } else if (foot != foot_) {
    ChangeFoot(time_s, foot);
  }
  const double overdue_s = std::max(step_s_ + kHeelRiseShowsS, kOverdue * step_s_);
  const double longest_s =
      stepping() ? std::min(borders_.longest_step_s, overdue_s) : borders_.longest_step_s;
  if (time_s - changed_s_ > longest_s) steps_ = 0;
  standing_lean_ += (lean - standing_lean_) * (1 - std::exp(-elapsed_s / kStandingLeanS));
}

double StepCadence::frequency_hz() const {
  const double with_this_s = (time_s_ - changed_s_ + last_step_s_) / 2;
  return 1 / (2 * std::max(step_s_, with_this_s));
}

std::optional<double> StepCadence::lean_right() const {
  if (stepping()) return steps_ >= 3 ? std::optional(stepping_lean_) : std::nullopt;
  const bool stands = steps_ == 0 || time_s_ - changed_s_ > kLeansS;
  if (!stands || both_s_ < kStandingLeanS) return std::nullopt;
  return standing_lean_;
}

}  // namespace footing::board
