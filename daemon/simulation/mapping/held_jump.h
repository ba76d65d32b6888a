#pragma once

#include "common/stream/character.h"

namespace footing::mapping {

/// A jump that a short event commands: the command waits until the character has taken it over,
/// and goes on for long enough that the jump is made. A plain value.
class HeldJump {
 public:
  /// A character that has not taken a jump over within this time is spared it, s. From running it
  /// takes up to 1.25 s (docs/gait.md).
  static constexpr double kMostWaitS = 2.5;

  /// `after_s`: how long the command goes on once the character jumps.
  explicit HeldJump(double after_s) : after_s_(after_s) {}

  void Start(double time_s);
  /// Takes the event back.
  void Drop() { active_ = false; }
  /// Whether to command the jump; `running` is the character's gait, `held` the event goes on.
  bool Advance(double time_s, stream::Gait running, bool held);
  bool active() const { return active_; }

 private:
  double after_s_;
  bool active_ = false;
  bool jumps_ = false;  ///< The character has taken it over.
  double since_s_ = 0;  ///< The start, or the take-over.
};

}  // namespace footing::mapping
