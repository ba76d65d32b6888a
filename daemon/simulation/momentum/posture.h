#pragma once

namespace footing::momentum {

/// How a posture that hands and feet alone make likely is wrong about the centre of mass, along one
/// axis: it shows `share` of the way, beside an error that is a first-order process and a white
/// one. A filter has the former as a state, so that no number of looks makes it smaller.
struct PostureError {
  double share = 1;
  double spread_m = 0;  ///< Of the slow error; 0: postures are not asked.
  double time_s = 1;    ///< Its correlation time.
  double white_m = 0.01;
  /// Share of looks in which it is right to `right_m`; in the others, as in squats, to `spread_m`.
  /// It then is the anchor of the height, in place of what upright bodies have, and no state. 0: it
  /// is a first-order process.
  double right_share = 0;
  double right_m = 0.03;
};

}  // namespace footing::momentum
