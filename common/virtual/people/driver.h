#pragma once

#include <cstdint>
#include <deque>

#include <Eigen/Core>

#include "common/stream/gait.h"
#include "common/stream/track.h"
#include "common/stream/user_interface.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/people/style.h"

namespace footing::users {

/// Ability of a user after the demonstration of an interface and five minutes' practice: what it
/// can command, and how long that takes.
struct Ability {
  double walk_min_mps = 0.3, walk_max_mps = 1.3;
  double run_min_mps = 1.6, run_max_mps = 4;
  double jump_mps = 1.5, jump_height_m = 0.35;
  double turn_per_step_rad = 0.0873;
  bool turns_by_degrees = true;  ///< False: none or all of turn_per_step_rad.
  bool jumps_at_once = false;    ///< One gesture is one jump; else it lasts as long as the jump.
  double turn_delay_s = 0.02;    ///< From the user's motion to a changed command.
  /// From the user's motion to the top of the character's first leap, out of a run and out of a
  /// walk, as practice with pits teaches (docs/evaluation/tracks.md): the way there, over the speed
  /// at its begin. The user corrects it by what it sees.
  double run_jump_s = 0.8;
  double walk_jump_s = 0.85;
  /// Size of the motion that jumps as high, as a share of one at ease; practice teaches it, too.
  double jump_size = 1;
};

/// Ability to command at once, without a body.
Ability DirectAbility();
/// The speeds are those of the demonstration (docs/interfaces.md), the delays what five minutes of
/// practice teach. `turn_by` is of the leg interface.
Ability AbilityWith(stream::UserInterface interface,
                    stream::TurnSource turn_by = stream::TurnSource::kHead);

/// When a user has to begin the motion of a jump, and how large it has to be: the top of the
/// character's leap is to be over the middle of the pit, and no lower than the user wants. A habit
/// per gait, that every leap seen corrects in the direction in which it was off; and no moment is
/// hit twice.
class JumpHabit {
 public:
  /// By practice the user knows the times from the begin of the motion to the top of the leap, and
  /// the size of the motion for `jump_height_m`. `error_s` is the standard deviation of the own
  /// moment.
  JumpHabit(const Ability& ability, double error_s, std::uint64_t seed);

  /// How long before the middle of the pit, at the present speed, the next jump has to be begun, s.
  double LeadS(stream::Gait from) const;
  /// Size of the motion, as a share of one at ease.
  double size() const { return size_; }
  /// The motion of a jump over the pit whose middle is at `middle_m` along the track begins.
  void Begin(double time_s, stream::Gait from, double speed_mps, double middle_m);
  /// Takes the character as the user sees it: its gait, its place along the track, and the
  /// height of its COM.
  void See(double time_s, stream::Gait gait, double along_m, double com_m);
  /// The pit was not crossed; `gait` is what the character ran. Who had not begun, or had seen no
  /// leap yet, was too late.
  void Fail(stream::Gait gait);
  /// The character stands somewhere else.
  void End();
  /// Whether a jump was begun that was not seen yet.
  bool waits() const { return begun_s_ >= 0 && !jumped_; }

 private:
  double& HabitOf(bool run) { return run ? run_s_ : walk_s_; }
  void Learn();

  noise::Random random_;
  double run_s_, walk_s_;
  double size_, wanted_m_;
  double sd_s_;
  double error_s_ = 0;   ///< Error of the next moment.
  double begun_s_ = -1;  ///< Negative: no jump under way, or it was learned from.
  bool tried_ = false;   ///< A jump over this pit was begun.
  bool from_run_ = false;
  double speed_mps_ = 1;  ///< When it began.
  double middle_m_ = 0;
  bool jumped_ = false;                      ///< The character was seen to jump,
  bool leapt_ = false;                       ///< and to come down from its first leap.
  double from_m_ = 0;                        ///< Height of the COM when it began to jump.
  double highest_m_ = 0, highest_at_m_ = 0;  ///< Height of the first leap's top, and its place.
};

/// A user who drives along a track: sees the track 3 to 12 m ahead and the character as it was a
/// reaction time ago, reckons with the turns wanted since, steers for the centre line, slows down
/// to what a curve allows, jumps before pits and does the task of a straight track. Stands while no
/// trial goes on. A character that was put back is a new start: what was wanted before is over.
class Driver {
 public:
  Driver(const Ability& ability, const Style& style, std::uint64_t seed);

  /// The track on the screen; a new one is a new start.
  void SeeTrack(const stream::Track& track);
  /// Present intention of the user; call about every 10 ms, times must not decrease.
  Intention Want(const Observation& seen);

  const Style& style() const { return style_; }

 private:
  struct Wanted {
    double time_s = 0;
    double turn_rad = 0;
  };

  const Observation& Delayed(double now_s) const;
  Observation Reckon(double now_s) const;
  double Steer(const Observation& now);
  double StepsPerSecond() const;
  double CurvatureAhead(const Observation& now, double speed_mps) const;
  double PitAhead(const Observation& now, double* length_m) const;
  void StartOver();
  void ChooseGait(const Observation& now, Intention& wanted);
  bool ChooseTask(const Observation& now, Intention& wanted) const;
  bool ChooseJump(const Observation& now);
  void WantJump(Intention& wanted) const;
  double EffortFor(const Intention& wanted, double elapsed_s);

  stream::Track track_;
  Ability ability_;
  Style style_;
  JumpHabit habit_;
  noise::Random random_;
  std::deque<Observation> seen_;  ///< The last moments, newest last.
  std::deque<Wanted> wanted_;     ///< The same of the own turns.
  Intention intention_;
  std::uint64_t pit_falls_ = 0;  ///< Jump failures seen so far.
  double now_s_ = 0;             ///< Time of the newest sight.
  bool steering_ = false;
  double walked_s_ = -1e9;    ///< When walking was last begun.
  double jump_until_m_ = -1;  ///< Along the track; negative: not jumping.
  double gait_since_s_ = 0;   ///< Since when this gait is wanted.
  double correction_ = 0;     ///< Correction of the effort, by the speed and the gait seen.
  double run_up_ = 1;         ///< Speed of this run-up, as a share of the favourite one.
};

}  // namespace footing::users
