#pragma once

#include "common/stream/character.h"

namespace footing::mapping {

/// Holds a change of gait back until it has lasted: while the person goes over from one motion to
/// another the features describe neither. A plain value.
class SettledGait {
 public:
  /// The settled gait, `seen` being what the features show at `time_s`; it settles once it,
  /// and no other, has been seen for `lasting_s`.
  stream::Gait Advance(double time_s, stream::Gait seen, double lasting_s);
  /// The features show nothing at `time_s`: the time until they do does not count.
  void Pause(double time_s);
  void Reset(stream::Gait gait);

  stream::Gait gait() const { return gait_; }
  /// What is seen and has not settled yet; kUnspecified: nothing.
  stream::Gait next() const { return next_; }
  /// The part of its time that is over, 0 to 1.
  double share() const { return next_ == stream::Gait::kUnspecified ? 0 : share_; }

 private:
  stream::Gait gait_ = stream::Gait::kStep;
  stream::Gait next_ = stream::Gait::kUnspecified;
  double time_s_ = 0;
  double lasted_s_ = 0;
  double share_ = 0;
};

}  // namespace footing::mapping
