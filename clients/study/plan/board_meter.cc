#include "clients/study/plan/board_meter.h"

#include <algorithm>

namespace footing::study::ranges {
namespace {

/// As in boards_mapping.json, but for the push: who rises gently is to be measured, too.
constexpr double kStandingLoadN = 150;
constexpr board::StepBorders kSteps{.stance_above = 0.75, .longest_step_s = 1.3};
constexpr board::HeelRiseBorders kRise{
    .forward_m = 0.04, .overshoot = 0.06, .together_s = 0.35, .standing_s = 0.2};
/// A rise's push is over this time after it was recognised.
constexpr double kPushS = 0.15;
constexpr double kLongestPauseS = 0.1;

}  // namespace

BoardMeter::BoardMeter() : steps_(kSteps), rise_(kRise) {}

BoardMotion BoardMeter::Advance(double time_s, const board::Stance& stance) {
  const double elapsed_s = begun_ ? std::clamp(time_s - time_s_, 0.0, kLongestPauseS) : 0;
  begun_ = true;
  time_s_ = time_s;
  if (stance.load_n < kStandingLoadN) {
    *this = BoardMeter();
    return {};
  }
  weight_.Advance(stance.load_n, elapsed_s);
  steps_.Advance(time_s, stance.left_share);
  if (rise_.Advance(time_s, stance.load_n / weight_.n(), stance.forward_m, steps_.even_s())) {
    rose_s_ = time_s;
    push_ = 0;
  }
  BoardMotion motion{.stands = true};
  const auto lean = steps_.lean_right();  // Of steps after two whole ones.
  if (!steps_.stepping()) stands_until_s_ = time_s;
  // The first cycle and a late step have another rhythm than the rest and do not count.
  const double cycles = (time_s - stands_until_s_) * steps_.last_frequency_hz();
  motion.steps = steps_.stepping() && steps_.on_time() && lean && cycles >= 1;
  if (motion.steps) motion.foot_hz = steps_.last_frequency_hz();
  motion.leans_known = lean && (motion.steps || !steps_.stepping());
  motion.lean_right = lean.value_or(0);
  if (rose_s_ >= 0) {
    push_ = std::max(push_, rise_.overshoot());
    motion.rose = time_s - rose_s_ >= kPushS;
    motion.rise_share = push_;
  }
  if (motion.rose) rose_s_ = -1;
  return motion;
}

}  // namespace footing::study::ranges
