#include "common/virtual/people/driver.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/body/centre_line.h"

namespace footing::users {

using stream::TurnSource;
using stream::UserInterface;

Ability DirectAbility() { return {}; }

Ability AbilityWith(UserInterface interface, TurnSource turn_by) {
  // A demonstrator shows 0.2 to 1.4 m/s of walking and 1.5 to 4.5 m/s of running; a user keeps off
  // the ends.
  Ability ability{.walk_min_mps = 0.4,
                  .walk_max_mps = 1.2,
                  .run_min_mps = 1.9,
                  .run_max_mps = 3.5,
                  .jump_mps = 1,
                  .turns_by_degrees = false};
  switch (interface) {
    case UserInterface::kUnspecified:
    case UserInterface::kWrist:  // A cycle and a half at 2.5 Hz, and the change of the hands.
      ability.turn_delay_s = 0.35;
      ability.run_jump_s = 1.78;
      ability.jump_size = 1.45;
      ability.walk_jump_s = 1.3;
      break;
    case UserInterface::kArm:
      ability.turn_delay_s = 0.5;
      ability.run_jump_s = 1.72;
      ability.walk_jump_s = 1.45;
      break;
    case UserInterface::kLeg:  // Feet show their heights in a whole cycle of either.
      ability.turn_delay_s = turn_by == TurnSource::kFeet ? 0.7 : 0.35;
      ability.run_jump_s = 1.76;
      ability.walk_jump_s = 1.45;
      break;
    case UserInterface::kJoystick:
      ability.turn_delay_s = 0.1;
      ability.jumps_at_once = true;
      ability.run_jump_s = 0.79;
      ability.walk_jump_s = 0.85;
      break;
    case UserInterface::kBoards:  // Steps end, both feet stand, then the heels rise.
      ability.turn_delay_s = 0.6;
      ability.jumps_at_once = true;
      ability.run_jump_s = 1.2;
      ability.walk_jump_s = 1.25;
      break;
  }
  return ability;
}

namespace {

using stream::Gait;

/// Share of an error that people correct from one try to the next (van Beers 2009: 0.2 to
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
constexpr double kMostRatio = 1.5;
/// A motion at ease can be made so much larger: hands of an ordinary user then swing by 50 degrees
/// to either side, well within what wrists and elbows do.
constexpr double kLargest = 1.6;

}  // namespace

JumpHabit::JumpHabit(const Ability& ability, double error_s, std::uint64_t seed)
    : random_(seed),
      run_s_(ability.run_jump_s),
      walk_s_(ability.walk_jump_s),
      size_(ability.jump_size),
      wanted_m_(ability.jump_height_m),
      sd_s_(error_s) {
  error_s_ = sd_s_ * random_.Normal();
}

double JumpHabit::LeadS(Gait from) const {
  return std::max(0.0, (from == Gait::kRun ? run_s_ : walk_s_) + error_s_);
}

void JumpHabit::Begin(double time_s, Gait from, double speed_mps, double middle_m) {
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

void JumpHabit::See(double time_s, Gait gait, double along_m, double com_m) {
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

/// Who leapt too early begins later, and the other way round; who leapt too low moves more widely,
/// and no leap is too high for a pit.
void JumpHabit::Learn() {
  const bool seen = jumped_ && highest_m_ > from_m_ + kLeapM;
  const double late_s = seen ? (highest_at_m_ - middle_m_) / speed_mps_ : kLateS;
  HabitOf(from_run_) += kLearned * std::clamp(late_s, -kMostS, kMostS);
  if (seen) {
    const double ratio = std::clamp(wanted_m_ / (highest_m_ - from_m_), 1.0, kMostRatio);
    size_ = std::min(kLargest, size_ * (1 + kLearned * (ratio - 1)));
  }
  begun_s_ = -1;
}

void JumpHabit::Fail(Gait gait) {
  if (begun_s_ >= 0) {
    Learn();
  } else if (!tried_) {
    HabitOf(gait == Gait::kRun) += kLearned * kLateS;
  }
  tried_ = false;
}

void JumpHabit::End() {
  if (begun_s_ >= 0) Learn();
  tried_ = false;
}

namespace {

constexpr double kRememberedS = 2;
/// Share of the turning rate there is that a user plans with.
constexpr double kTurnShare = 0.85;
/// Steering by tilt begins and ends at these errors of direction.
constexpr double kSteerAboveRad = 0.07;
constexpr double kSteerBelowRad = 0.02;
/// Share of the error that one step is to take away, when it can be chosen.
constexpr double kSteerShare = 0.35;
/// The pit that was jumped at is nearer, any other one farther.
constexpr double kSamePitM = 5;
/// Nobody changes from walking to running again and again.
constexpr double kRunAgainS = 1;
/// Narrower pits are run across without a jump.
constexpr double kRunOverM = 0.25;
/// No character moves so far between two looks: it was put back.
constexpr double kPutBackM = 1.5;
/// No run-up is like the one before: in those of people without training the footfalls vary by up
/// to 0.58 m from try to try (Scott, Li & Davids 1997; standard deviation), over some 15 m.
constexpr double kRunUpSpread = 0.04;
/// The effort follows an error of the speed: a share a second, and at most.
constexpr double kCorrection = 0.25;
constexpr double kMostCorrection = 0.4;
/// Who sees the other gait than the one wanted for longer than this moves more clearly.
constexpr double kClearerAfterS = 2;

}  // namespace

Driver::Driver(const Ability& ability, const Style& style, std::uint64_t seed)
    : ability_(ability), style_(style), habit_(ability, style.timing_s, seed), random_(seed + 1) {}

void Driver::SeeTrack(const stream::Track& track) {
  const bool other = track.number != track_.number || track.name != track_.name;
  track_ = track;
  if (other) StartOver();
}

void Driver::StartOver() {
  seen_.clear();
  wanted_.clear();
  intention_ = {};
  steering_ = false;
  jump_until_m_ = -1;
  habit_.End();
  correction_ = 0;
  run_up_ = std::max(0.8, 1 + kRunUpSpread * random_.Normal());
}

/// Steps a second as seen; before there are any, a walk's.
double Driver::StepsPerSecond() const {
  const double time_s = seen_.back().time_s - seen_.front().time_s;
  const double steps = static_cast<double>(seen_.back().steps - seen_.front().steps);
  return time_s > 1 && steps > 1 ? steps / time_s : 2.5;
}

const Observation& Driver::Delayed(double now_s) const {
  for (auto seen = seen_.rbegin(); seen != seen_.rend(); ++seen) {
    if (seen->time_s <= now_s - style_.reaction_s) return *seen;
  }
  return seen_.front();
}

/// Where the character will be when a command given now takes effect: from the old sight, with the
/// turns wanted since.
Observation Driver::Reckon(double now_s) const {
  Observation old = Delayed(now_s);
  const double rate = StepsPerSecond();
  double time_s = old.time_s;
  const auto go_on = [&](double until_s, double turn_rad) {
    const double span_s = std::max(0.0, until_s - time_s);
    old.heading_rad += turn_rad * rate * span_s;
    old.p_W_m += old.speed_mps * span_s *
                 Eigen::Vector2d(std::cos(old.heading_rad), std::sin(old.heading_rad));
    time_s = std::max(time_s, until_s);
  };
  double turn_rad = 0;
  for (const Wanted& wanted : wanted_) {
    go_on(wanted.time_s + ability_.turn_delay_s, turn_rad);
    turn_rad = wanted.turn_rad;
  }
  go_on(now_s + ability_.turn_delay_s, turn_rad);
  return old;
}

/// The sharpest bend within what matters at this speed, rad/m. Up to a pit the run-up matters, and
/// the bend behind it later.
double Driver::CurvatureAhead(const Observation& now, double speed_mps) const {
  constexpr double kSpanM = 3;
  const track::TrackPlace place = track::Locate(track_, now.p_W_m);
  double pit_m = 0;
  const double edge_m = PitAhead(now, &pit_m);
  const double far_edge_m = edge_m + pit_m;
  const double sight_m = std::min(3 + 2.5 * std::max(0.0, speed_mps), far_edge_m);
  double sharpest = 0;
  for (double ahead_m = 0; ahead_m < sight_m; ahead_m += 0.5) {
    const double from_rad = track::CentreAhead(track_, place, ahead_m).heading_rad;
    const double to_m = std::min(ahead_m + kSpanM, far_edge_m);
    const double to_rad = track::CentreAhead(track_, place, to_m).heading_rad;
    sharpest = std::max(sharpest, std::fabs(WrapAngle(to_rad - from_rad)) / kSpanM);
  }
  return sharpest;
}

double Driver::Steer(const Observation& now) {
  const track::TrackPlace place = track::Locate(track_, now.p_W_m);
  const double ahead_m = std::clamp(1.5 + now.speed_mps, 2.0, 5.0);
  const Eigen::Vector3d target = track::CentreAhead(track_, place, ahead_m).p_W_m;
  const Eigen::Vector2d way = target.head<2>() - now.p_W_m;
  const double error_rad = WrapAngle(std::atan2(way.y(), way.x()) - now.heading_rad);
  const double most_rad = ability_.turn_per_step_rad;
  if (ability_.turns_by_degrees) return std::clamp(kSteerShare * error_rad, -most_rad, most_rad);
  steering_ = std::fabs(error_rad) > (steering_ ? kSteerBelowRad : kSteerAboveRad);
  return steering_ ? std::copysign(most_rad, error_rad) : 0;
}

/// Length to the near edge of the next pit that needs a jump; infinite: none within 12 m.
double Driver::PitAhead(const Observation& now, double* length_m) const {
  const track::TrackPlace place = track::Locate(track_, now.p_W_m);
  double edge_m = -place.along_m;
  for (auto i = static_cast<std::size_t>(place.segment); i < track_.segments.size(); ++i) {
    const stream::TrackSegment& segment = track_.segments[i];
    if (edge_m > 12) break;
    if (segment.pit && segment.length_m > kRunOverM && edge_m > 0) {
      *length_m = segment.length_m;
      return edge_m;
    }
    edge_m += segment.length_m;
  }
  return INFINITY;
}

/// True from a jump's command until the pit lies behind; with an interface of one jump for one
/// gesture until the character is seen to jump.
bool Driver::ChooseJump(const Observation& now) {
  // The place is that of a turn's delay from now.
  const double here_m = track::LengthTo(track_, track::Locate(track_, now.p_W_m));
  const double ahead_m = ability_.turn_delay_s * now.speed_mps;
  if (jump_until_m_ >= 0 && here_m - ahead_m > jump_until_m_ + 0.3) jump_until_m_ = -1;
  if (jump_until_m_ >= 0 && !ability_.jumps_at_once) return true;
  if (jump_until_m_ >= 0 && habit_.waits()) return true;
  double length_m = 0;
  const double edge_m = PitAhead(now, &length_m);
  // A single leap is under way, or it is over and the pit behind it; one that came down before the
  // pit is followed by another.
  if (jump_until_m_ >= 0 && (now.gait == Gait::kJump || edge_m > kSamePitM)) return false;
  const double lead_s = std::max(0.0, habit_.LeadS(now.gait) - ability_.turn_delay_s);
  const double middle_m = edge_m + length_m / 2;
  // A run-up gets faster on the way to the pit, and who wants that reckons with it.
  const double gain_mps = std::max(0.0, intention_.speed_mps - now.speed_mps);
  if (middle_m >= lead_s * std::max(0.5, now.speed_mps + gain_mps / 2)) return false;
  jump_until_m_ = here_m + edge_m + length_m;
  habit_.Begin(now_s_, now.gait, now.speed_mps, here_m + middle_m);
  return true;
}

void Driver::WantJump(Intention& wanted) const {
  wanted.gait = Gait::kJump;
  wanted.speed_mps = ability_.jump_mps;
  wanted.height_m = ability_.jump_height_m;
  wanted.size = habit_.size();
}

/// The gait of a straight track's task; false where the user may choose.
bool Driver::ChooseTask(const Observation& now, Intention& wanted) const {
  const auto index = static_cast<std::size_t>(now.trial.task);
  if (now.trial.task < 0 || index >= track_.tasks.size()) return false;
  if (now.trial.task_phase == stream::TaskPhase::kDone) return false;
  const bool crossed = now.trial.task_phase == stream::TaskPhase::kDue ||
                       track::LengthTo(track_, track::Locate(track_, now.p_W_m)) > track_.mark_m;
  const stream::TrackTask& task = track_.tasks[index];
  wanted.gait = crossed ? task.after : task.before;
  switch (wanted.gait) {
    case Gait::kUnspecified:
      return false;
    case Gait::kStep:
      return true;
    case Gait::kWalk:
      wanted.speed_mps = ability_.walk_max_mps;
      return true;
    case Gait::kRun:
      wanted.speed_mps = style_.favourite_mps;
      return true;
    case Gait::kJump:
      if (ability_.jumps_at_once && now.gait == Gait::kJump) return false;
      WantJump(wanted);
      return true;
  }
  return false;
}

void Driver::ChooseGait(const Observation& now, Intention& wanted) {
  if (ChooseTask(now, wanted)) return;
  if (ChooseJump(now)) {
    WantJump(wanted);
    return;
  }
  // Turning rate over curvature is the speed at which the curve can be followed.
  constexpr double kRunStepsPerS = 2.1, kWalkStepsPerS = 2.2;
  const double turn_rad = kTurnShare * ability_.turn_per_step_rad;
  const double bend = CurvatureAhead(now, std::max(now.speed_mps, ability_.run_min_mps));
  const double run_mps = std::min(std::min(run_up_ * style_.favourite_mps, ability_.run_max_mps),
                                  turn_rad * kRunStepsPerS / std::max(1e-3, bend));
  // A run that walks now, or the other way round, wants a reason.
  const double slack_mps = intention_.gait == Gait::kRun ? 0.0 : 0.2;
  const bool may_run = intention_.gait != Gait::kWalk || now.time_s - walked_s_ > kRunAgainS;
  if (run_mps >= ability_.run_min_mps + slack_mps && may_run) {
    wanted.gait = Gait::kRun;
    wanted.speed_mps = run_mps;
    return;
  }
  if (intention_.gait != Gait::kWalk) walked_s_ = now.time_s;
  wanted.gait = Gait::kWalk;
  const double near = std::max(1e-3, CurvatureAhead(now, now.speed_mps));
  wanted.speed_mps =
      std::clamp(turn_rad * kWalkStepsPerS / near, ability_.walk_min_mps, ability_.walk_max_mps);
}

/// Where between slow and fast the gait is to be: as practised, corrected by what is seen.
double Driver::EffortFor(const Intention& wanted, double elapsed_s) {
  const bool run = wanted.gait == Gait::kRun;
  const double min_mps = run ? ability_.run_min_mps : ability_.walk_min_mps;
  const double max_mps = run ? ability_.run_max_mps : ability_.walk_max_mps;
  const Observation& seen = Delayed(seen_.back().time_s);
  const double now_s = seen_.back().time_s;
  if (wanted.gait != intention_.gait) gait_since_s_ = now_s;
  const double most = kMostCorrection;
  if (seen.gait == wanted.gait) {
    const double error = (wanted.speed_mps - seen.speed_mps) / (max_mps - min_mps);
    correction_ = std::clamp(correction_ + kCorrection * elapsed_s * error, -most, most);
  } else if (now_s - gait_since_s_ > kClearerAfterS) {
    const double clearer = run ? kCorrection : -kCorrection;
    correction_ = std::clamp(correction_ + clearer * elapsed_s, -2 * most, 2 * most);
  } else {
    correction_ *= 0.98;
  }
  return std::clamp((wanted.speed_mps - min_mps) / (max_mps - min_mps) + correction_, 0.0, 1.0);
}

Intention Driver::Want(const Observation& seen) {
  if (!seen_.empty() && (seen.p_W_m - seen_.back().p_W_m).norm() > kPutBackM) StartOver();
  const double elapsed_s = seen_.empty() ? 0 : seen.time_s - seen_.back().time_s;
  seen_.push_back(seen);
  while (seen.time_s - seen_.front().time_s > kRememberedS) seen_.pop_front();
  while (!wanted_.empty() && seen.time_s - wanted_.front().time_s > kRememberedS) {
    wanted_.pop_front();
  }
  const Observation& delayed = Delayed(seen.time_s);
  if (!track_.segments.empty()) {
    habit_.See(delayed.time_s, delayed.gait,
               track::LengthTo(track_, track::Locate(track_, delayed.p_W_m)), delayed.com_m);
  }
  if (delayed.trial.failures.jump > pit_falls_) habit_.Fail(intention_.gait);
  pit_falls_ = delayed.trial.failures.jump;
  now_s_ = seen.time_s;
  // A character that has fallen is put back soon.
  const bool over = delayed.trial.phase == stream::TrialPhase::kFinished ||
                    delayed.trial.phase == stream::TrialPhase::kStopped ||
                    delayed.falls > seen_.front().falls;
  Intention wanted;
  if (over || track_.segments.empty()) {
    intention_ = wanted;
    return wanted;
  }
  const Observation now = Reckon(seen.time_s);
  ChooseGait(now, wanted);
  wanted.turn_rad = Steer(now);
  wanted.effort = EffortFor(wanted, elapsed_s);
  intention_ = wanted;
  wanted_.push_back({seen.time_s, wanted.turn_rad});
  return wanted;
}

}  // namespace footing::users
