#include "common/board/heel_rise.h"

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

}  // namespace footing::board
