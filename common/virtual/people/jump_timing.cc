#include "common/virtual/people/jump_timing.h"

#include <algorithm>

namespace footing::users {
namespace {

using stream::Gait;

/// Of what was off, the share that people correct from one try to the next (van Beers 2009: 0.2 to
/// 0.6 of a visible error).
constexpr double kLearned = 0.3;
/// How late who has seen no leap at all believes to have been.
constexpr double kLateS = 0.5;
/// Slower answers are taken for misses.
constexpr double kLongestS = 3;
/// A leap goes up and down by more; out of a walk a small hop comes before it.
constexpr double kLeapM = 0.06;
/// One look does not change a habit by more.
constexpr double kMostS = 0.6;

}  // namespace

JumpTiming::JumpTiming(double run_s, double walk_s, double error_s, std::uint64_t seed)
    : random_(seed), run_s_(run_s), walk_s_(walk_s), sd_s_(error_s) {
  error_s_ = sd_s_ * random_.Normal();
}

double JumpTiming::LeadS(Gait from) const {
  return std::max(0.0, (from == Gait::kRun ? run_s_ : walk_s_) + error_s_);
}

void JumpTiming::Begin(double time_s, Gait from, double speed_mps, double middle_m) {
  if (begun_s_ >= 0) Learn();
  begun_s_ = time_s;
  tried_ = true;
  from_run_ = from == Gait::kRun;
  speed_mps_ = std::max(0.5, speed_mps);
  middle_m_ = middle_m;
  jumped_ = leapt_ = false;
  highest_m_ = -1e9;
  error_s_ = sd_s_ * random_.Normal();
}

void JumpTiming::See(double time_s, Gait gait, double along_m, double com_m) {
  if (begun_s_ < 0) return;
  if (gait == Gait::kJump) {
    if (!jumped_) from_m_ = com_m;
    jumped_ = true;
    leapt_ = leapt_ || (highest_m_ > from_m_ + kLeapM && com_m < highest_m_ - kLeapM);
    if (!leapt_ && com_m > highest_m_) {
      highest_m_ = com_m;
      highest_at_m_ = along_m;
    }
  } else if (jumped_ || time_s - begun_s_ > kLongestS) {
    Learn();
  }
}

/// Who leapt too early begins later, and the other way round.
void JumpTiming::Learn() {
  const bool seen = jumped_ && highest_m_ > from_m_ + kLeapM;
  const double late_s = seen ? (highest_at_m_ - middle_m_) / speed_mps_ : kLateS;
  HabitOf(from_run_) += kLearned * std::clamp(late_s, -kMostS, kMostS);
  begun_s_ = -1;
}

void JumpTiming::Fail(Gait gait) {
  if (begun_s_ >= 0) {
    Learn();
  } else if (!tried_) {
    HabitOf(gait == Gait::kRun) += kLearned * kLateS;
  }
  tried_ = false;
}

void JumpTiming::End() {
  if (begun_s_ >= 0) Learn();
  tried_ = false;
}

}  // namespace footing::users
