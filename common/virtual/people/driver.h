#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>

#include "common/stream/track.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/people/ability.h"
#include "common/virtual/people/jump_timing.h"
#include "common/virtual/people/sight.h"
#include "common/virtual/people/style.h"

namespace footing::users {

/// A user who drives along a track: sees the track 3 to 12 m ahead and the character as it was a
/// reaction time ago, reckons with the turns wanted since, steers for the centre line, slows down
/// to what a curve allows, jumps before pits and does the task of a straight track. Stands while no
/// trial goes on. A character that was put back is a new start: what was wanted before is over.
class Driver {
 public:
  Driver(const Ability& ability, const Style& style, std::uint64_t seed);

  /// The track on the screen; a new one is a new start.
  void SeeTrack(const stream::Track& track);
  /// What the user now wants; call about every 10 ms, times must not decrease.
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
  void TakeJump(Intention& wanted) const;
  double EffortFor(const Intention& wanted, double elapsed_s);

  stream::Track track_;
  Ability ability_;
  Style style_;
  JumpTiming timing_;
  std::deque<Observation> seen_;  ///< The last moments, newest last.
  std::deque<Wanted> wanted_;     ///< The same of the own turns.
  Intention intention_;
  std::uint64_t pit_falls_ = 0;  ///< Jump failures seen so far.
  double now_s_ = 0;             ///< Of the newest sight.
  bool steering_ = false;
  double walked_s_ = -1e9;    ///< When walking was last begun.
  double jump_until_m_ = -1;  ///< Along the track; negative: not jumping.
  double gait_since_s_ = 0;   ///< Since when this gait is wanted.
  double correction_ = 0;     ///< Of the effort, by the speed and the gait seen.
};

}  // namespace footing::users
