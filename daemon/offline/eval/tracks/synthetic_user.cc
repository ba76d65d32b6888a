#include "daemon/offline/eval/tracks/synthetic_user.h"

#include <algorithm>
#include <cmath>

#include "common/units/units.h"
#include "daemon/simulation/terrain/track.h"

namespace footing::eval {
namespace {

using stream::Gait;

constexpr double kRememberedS = 1.5;
/// Of the turning rate there is, what a user plans with.
constexpr double kTurnShare = 0.85;
/// Steering by tilt begins and ends at these errors of direction.
constexpr double kSteerAboveRad = 0.07;
constexpr double kSteerBelowRad = 0.02;
/// Share of the error that one step is to take away, when it can be chosen.
constexpr double kSteerShare = 0.35;
/// Commanded to jump, a run leaves the ground after this long, a walk after the other, at most.
constexpr double kRunLeadS = 0.7;
constexpr double kWalkLeadS = 0.35;
/// Nobody hits the same moment twice: each jump's lead is a share of those, drawn between these.
constexpr double kLeastLead = 0.3, kMostLead = 1.0;
/// Narrower pits are run across without a jump.
constexpr double kRunOverM = 0.25;

}  // namespace

SyntheticUser::SyntheticUser(const stream::Track& track, const Skill& skill, Random random)
    : track_(track),
      skill_(skill),
      random_(random),
      reaction_s_(random_.Uniform(0.2, 0.35)),
      favourite_mps_(std::min(skill.run_max_mps, random_.Uniform(2.2, 3.0))),
      lead_(random_.Uniform(kLeastLead, kMostLead)) {}

/// Steps a second as seen; before there are any, a walk's.
double SyntheticUser::StepsPerSecond() const {
  const double time_s = seen_.back().time_s - seen_.front().time_s;
  const auto steps = static_cast<double>(seen_.back().steps - seen_.front().steps);
  return time_s > 1 && steps > 1 ? steps / time_s : 2.5;
}

/// Where the character will be when a command given now takes effect: from the old sight, with the
/// turns wanted since.
Sight SyntheticUser::Reckon(double now_s) const {
  Sight old = seen_.front();
  for (const Sight& sight : seen_) {
    if (sight.time_s <= now_s - reaction_s_) old = sight;
  }
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
    go_on(wanted.time_s + skill_.delay_s, turn_rad);
    turn_rad = wanted.turn_per_step_rad;
  }
  go_on(now_s + skill_.delay_s, turn_rad);
  return old;
}

double SyntheticUser::CurvatureAhead(const Sight& now) const {
  constexpr double kSpanM = 3;
  const terrain::TrackPlace place = terrain::Locate(track_, now.p_W_m);
  const double sight_m = 3 + 2.5 * std::max(0.0, now.speed_mps);
  double sharpest = 0;
  for (double ahead_m = 0; ahead_m < sight_m; ahead_m += 0.5) {
    const double from_rad = terrain::CentreAhead(track_, place, ahead_m).heading_rad;
    const double to_rad = terrain::CentreAhead(track_, place, ahead_m + kSpanM).heading_rad;
    sharpest = std::max(sharpest, std::fabs(WrapAngle(to_rad - from_rad)) / kSpanM);
  }
  return sharpest;
}

double SyntheticUser::Steer(const Sight& now) {
  const terrain::TrackPlace place = terrain::Locate(track_, now.p_W_m);
  const double ahead_m = std::clamp(1.5 + now.speed_mps, 2.0, 5.0);
  const Eigen::Vector3d target = terrain::CentreAhead(track_, place, ahead_m).p_W_m;
  const Eigen::Vector2d way = target.head<2>() - now.p_W_m;
  const double error_rad = WrapAngle(std::atan2(way.y(), way.x()) - now.heading_rad);
  const double most_rad = skill_.turn_per_step_rad;
  if (skill_.turns_by_degrees) {
    return std::clamp(kSteerShare * error_rad, -most_rad, most_rad);
  }
  steering_ = std::fabs(error_rad) > (steering_ ? kSteerBelowRad : kSteerAboveRad);
  return steering_ ? std::copysign(most_rad, error_rad) : 0;
}

/// True from a jump's command until the pit lies behind.
bool SyntheticUser::ChooseJump(const Sight& now) {
  const terrain::TrackPlace place = terrain::Locate(track_, now.p_W_m);
  const double here_m = terrain::LengthTo(track_, place);
  if (jump_until_m_ >= 0 && here_m > jump_until_m_ + 0.3) jump_until_m_ = -1;
  if (jump_until_m_ >= 0) return true;
  const double lead_s = lead_ * (now.gait == Gait::kRun ? kRunLeadS : kWalkLeadS);
  double edge_m = -place.along_m;
  for (std::size_t i = static_cast<std::size_t>(place.segment); i < track_.segments.size(); ++i) {
    const stream::TrackSegment& segment = track_.segments[i];
    if (edge_m > 12) break;
    if (segment.pit && segment.length_m > kRunOverM && edge_m > 0 &&
        edge_m < lead_s * std::max(0.5, now.speed_mps)) {
      jump_until_m_ = here_m + edge_m + segment.length_m;
      lead_ = random_.Uniform(kLeastLead, kMostLead);
      return true;
    }
    edge_m += segment.length_m;
  }
  return false;
}

/// The gait of a straight track's task; false where the user may choose.
bool SyntheticUser::ChooseTask(const Sight& now, biped::GaitCommand& command) const {
  const auto index = static_cast<std::size_t>(now.task);
  if (now.task < 0 || index >= track_.tasks.size()) return false;
  if (now.task_phase == stream::TaskPhase::kDone) return false;
  const bool crossed =
      now.task_phase == stream::TaskPhase::kDue ||
      terrain::LengthTo(track_, terrain::Locate(track_, now.p_W_m)) > track_.mark_m;
  const stream::TrackTask& task = track_.tasks[index];
  command.gait = crossed ? task.after : task.before;
  switch (command.gait) {
    case Gait::kUnspecified:
      return false;
    case Gait::kStep:
      command.speed_mps = 0;
      return true;
    case Gait::kWalk:
      command.speed_mps = skill_.walk_max_mps;
      return true;
    case Gait::kRun:
      command.speed_mps = favourite_mps_;
      return true;
    case Gait::kJump:
      command.speed_mps = skill_.jump_mps;
      command.height_m = skill_.jump_height_m;
      return true;
  }
  return false;
}

void SyntheticUser::StartOver(const Sight& sight) {
  seen_.clear();
  wanted_.clear();
  command_ = {};
  steering_ = false;
  jump_until_m_ = -1;
  put_backs_ = sight.put_backs;
}

void SyntheticUser::ChooseGait(const Sight& now, biped::GaitCommand& command) {
  if (ChooseTask(now, command)) return;
  if (ChooseJump(now)) {
    command.gait = Gait::kJump;
    command.speed_mps = skill_.jump_mps;
    command.height_m = skill_.jump_height_m;
    return;
  }
  // Turning rate over curvature is the speed at which the curve can be followed.
  const double curvature = std::max(1e-3, CurvatureAhead(now));
  constexpr double kRunStepsPerS = 2.1, kWalkStepsPerS = 2.7;
  const double turn_rad = kTurnShare * skill_.turn_per_step_rad;
  const double run_mps = std::min(favourite_mps_, turn_rad * kRunStepsPerS / curvature);
  // A run that walks now, or the other way round, wants a reason.
  const double slack_mps = command_.gait == Gait::kRun ? 0.0 : 0.15;
  if (run_mps >= skill_.run_min_mps + slack_mps) {
    command.gait = Gait::kRun;
    command.speed_mps = run_mps;
    return;
  }
  command.gait = Gait::kWalk;
  command.speed_mps =
      std::clamp(turn_rad * kWalkStepsPerS / curvature, skill_.walk_min_mps, skill_.walk_max_mps);
}

biped::GaitCommand SyntheticUser::Want(const Sight& sight) {
  if (sight.put_backs != put_backs_) StartOver(sight);
  seen_.push_back(sight);
  while (sight.time_s - seen_.front().time_s > kRememberedS) seen_.pop_front();
  while (!wanted_.empty() && sight.time_s - wanted_.front().time_s > kRememberedS) {
    wanted_.pop_front();
  }
  const Sight now = Reckon(sight.time_s);
  biped::GaitCommand command;
  ChooseGait(now, command);
  command.turn_per_step_rad = Steer(now);
  command_ = command;
  wanted_.push_back({sight.time_s, command.turn_per_step_rad});
  return command;
}

}  // namespace footing::eval
