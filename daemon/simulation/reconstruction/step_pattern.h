#pragma once

namespace footing::reconstruction {

/// How long a walking foot bears weight and how long it swings: what was assumed until it was seen,
/// then the newest steps of both feet. A plain value.
struct StepTimes {
  double stance_s = 0.65;
  double swing_s = 0.4;

  /// A foot bore weight, or swung, for that time. What is not a step does not count.
  void Bore(double lasted_s);
  void Swung(double lasted_s);
  /// Of somebody who walks ahead with such steps, by the walk ratio of step length over cadence,
  /// 0.0065 m min (Sekiya & Nagasaki 1998), which people keep at any speed.
  double UsualSpeedMps() const;
};

/// How much higher than on the ground a foot's ankle and ball are.
struct FootRise {
  double ankle_m = 0;
  double ball_m = 0;
};

/// Of a swinging foot, `share` (0 to 1) of its swing after it left the ground, in steps whose feet
/// come to be half a step ahead of the hips and behind. Backwards (a negative half step) it is the
/// same the other way round.
FootRise SwingRise(double share, double half_step_m);

/// Which part of the way from where it stood to where it will stand a foot has gone by then: it
/// rests at both ends.
double SwingWay(double share);

}  // namespace footing::reconstruction
