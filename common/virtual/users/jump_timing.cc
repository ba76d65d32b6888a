#include "common/virtual/users/jump_timing.h"

#include <algorithm>

namespace footing::users {
namespace {

using stream::Gait;

/// Of a surprise, what the user takes over into the habit.
constexpr double kLearned = 0.4;
/// How far off the habit another moment is tried.
constexpr double kTriesS = 0.3;
/// Slower answers are taken for misses.
constexpr double kLongestS = 3;

}  // namespace

JumpTiming::JumpTiming(double run_s, double walk_s, double error_s, std::uint64_t seed)
    : random_(seed), run_s_(run_s), walk_s_(walk_s), sd_s_(error_s) {
  error_s_ = sd_s_ * random_.Normal();
}

double JumpTiming::LeadS(Gait from) const {
  return std::max(0.0, (from == Gait::kRun ? run_s_ : walk_s_) + aim_s_ + error_s_);
}

void JumpTiming::Begin(double time_s, Gait from) {
  begun_s_ = time_s;
  from_run_ = from == Gait::kRun;
  error_s_ = sd_s_ * random_.Normal();
}

void JumpTiming::See(double time_s, Gait gait) {
  if (begun_s_ < 0) return;
  const double took_s = time_s - begun_s_;
  if (gait == Gait::kJump) {
    double& expected_s = from_run_ ? run_s_ : walk_s_;
    expected_s += kLearned * (took_s - expected_s);
  }
  if (gait == Gait::kJump || took_s > kLongestS) begun_s_ = -1;
}

void JumpTiming::End() { begun_s_ = -1; }

void JumpTiming::Fail() {
  End();
  aim_s_ = random_.Uniform(-kTriesS, kTriesS);
}

}  // namespace footing::users
