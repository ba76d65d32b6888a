#pragma once

#include <deque>

#include "common/stream/character.h"
#include "daemon/offline/eval/gait/trial.h"
#include "daemon/simulation/biped/command.h"

namespace footing::eval {

/// What an interface asks of its user: what it can command, and how long that takes.
struct Skill {
  double walk_min_mps = 0.3, walk_max_mps = 1.3;
  double run_min_mps = 1.6, run_max_mps = 4;
  double jump_mps = 1.5, jump_height_m = 0.35;
  double turn_per_step_rad = 0.0873;
  bool turns_by_degrees = true;  ///< False: none or all of turn_per_step_rad.
  double delay_s = 0.02;         ///< From the user's motion to a changed command.
};

/// What a person in front of the picture sees of the character.
struct Sight {
  double time_s = 0;
  Eigen::Vector2d p_W_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  double speed_mps = 0;
  std::uint64_t steps = 0;
  stream::Gait gait = stream::Gait::kStep;
  std::uint64_t put_backs = 0;  ///< How often the character was put back so far.
  /// Of the trial's task, as announced on the screen.
  int task = -1;
  stream::TaskPhase task_phase = stream::TaskPhase::kUnspecified;
};

/// A user who drives along a track: sees the track 3 to 12 m ahead and the character as it was a
/// reaction time ago, reckons with the commands given since, steers for the centre line, slows
/// down to what a curve allows at 5 degrees a step, jumps before pits and does the task of a
/// straight track. A character that was put back is a new start: what was wanted before is over.
class SyntheticUser {
 public:
  /// Draws reaction time (0.2 to 0.35 s) and favourite speed (2.2 to 3 m/s). `track` is borrowed.
  SyntheticUser(const stream::Track& track, const Skill& skill, Random random);

  /// What the user now wants; call every 10 ms.
  biped::GaitCommand Want(const Sight& sight);

  double reaction_s() const { return reaction_s_; }

 private:
  struct Wanted {
    double time_s = 0;
    double turn_per_step_rad = 0;
  };

  Sight Reckon(double now_s) const;
  double Steer(const Sight& now);
  double StepsPerSecond() const;
  double CurvatureAhead(const Sight& now) const;
  void StartOver(const Sight& sight);
  void ChooseGait(const Sight& now, biped::GaitCommand& command);
  bool ChooseTask(const Sight& now, biped::GaitCommand& command) const;
  bool ChooseJump(const Sight& now);

  const stream::Track& track_;
  Skill skill_;
  Random random_;
  double reaction_s_;
  double favourite_mps_;
  double lead_;                ///< Of the next jump, as a share of the longest.
  std::deque<Sight> seen_;     ///< The last second, newest last.
  std::deque<Wanted> wanted_;  ///< The same of the own commands.
  biped::GaitCommand command_;
  bool steering_ = false;
  std::uint64_t put_backs_ = 0;
  double jump_until_m_ = -1;  ///< Along the track; negative: not jumping.
};

}  // namespace footing::eval
