#pragma once

#include <cstdint>

#include "common/stream/gait.h"
#include "common/virtual/devices/random.h"

namespace footing::users {

/// When a user has to begin the motion of a jump: the top of the character's leap is to be over the
/// middle of the pit. A habit per gait, that every leap seen corrects in the direction in which it
/// was off; and no moment is hit twice.
class JumpTiming {
 public:
  /// `run_s` and `walk_s`: what the user knows by practice from the begin of the motion to the top
  /// of the leap. `error_s` is the standard deviation of the own moment.
  JumpTiming(double run_s, double walk_s, double error_s, std::uint64_t seed);

  /// How long before the middle of the pit, at the present speed, the next jump has to be begun, s.
  double LeadS(stream::Gait from) const;
  /// The motion of a jump over the pit whose middle is at `middle_m` along the track begins.
  void Begin(double time_s, stream::Gait from, double speed_mps, double middle_m);
  /// What the character does, as the user sees it: its gait, its place along the track, and the
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
  double sd_s_;
  double error_s_ = 0;   ///< Of the next moment.
  double begun_s_ = -1;  ///< Negative: no jump under way, or it was learned from.
  bool tried_ = false;   ///< A jump over this pit was begun.
  bool from_run_ = false;
  double speed_mps_ = 1;  ///< When it began.
  double middle_m_ = 0;
  bool jumped_ = false;                      ///< The character was seen to jump,
  bool leapt_ = false;                       ///< and to come down from its first leap.
  double from_m_ = 0;                        ///< Height of the COM when it began to jump.
  double highest_m_ = 0, highest_at_m_ = 0;  ///< Of the first leap, and where.
};

}  // namespace footing::users
