#pragma once

#include <cstdint>

#include "common/stream/gait.h"
#include "common/virtual/noise/random.h"

namespace footing::users {

/// When a user has to begin the motion of a jump, so that the character leaves the ground where it
/// should: a habit that every jump seen corrects, and no moment is hit twice. What went wrong is
/// tried otherwise, what went well is kept.
class JumpTiming {
 public:
  /// `run_s` and `walk_s`: what the user expects from the begin of the motion to the jump.
  /// `error_s` is the standard deviation of the own moment.
  JumpTiming(double run_s, double walk_s, double error_s, std::uint64_t seed);

  /// How long before the edge the next jump has to be wanted, s.
  double LeadS(stream::Gait from) const;
  /// The motion of a jump begins.
  void Begin(double time_s, stream::Gait from);
  /// What the character does, as the user sees it.
  void See(double time_s, stream::Gait gait);
  /// The jump was given up.
  void End();
  /// It went wrong.
  void Fail();
  /// Whether a jump was begun that was not seen yet.
  bool waits() const { return begun_s_ >= 0; }

 private:
  noise::Random random_;
  double run_s_, walk_s_;
  double sd_s_;
  double aim_s_ = 0;     ///< Earlier than the habit, after failures.
  double error_s_ = 0;   ///< Of the next moment.
  double begun_s_ = -1;  ///< Negative: no jump under way, or it was seen.
  bool from_run_ = false;
};

}  // namespace footing::users
