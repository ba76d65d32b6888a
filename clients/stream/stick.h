#pragma once

#include <vector>

#include "common/virtual/devices/hand_motion.h"

namespace footing::stream_client {

/// What a user of the joystick interface does: a Nunchuk's stick and a Wiimote's button.
struct StickState {
  double x = 0;  ///< -1 left to 1 right.
  double y = 0;  ///< -1 back to 1 front.
  bool jump = false;
};

/// The script of the wrists, performed with stick and button (gait paper, section 7, "Joystick
/// Interface" and figure 11): inside a radius of 0.6 of 1.0 the character walks, outside it runs;
/// to the side it turns; a button makes it jump. Hands that swing in phase become one press a
/// cycle, an inclination to the right (left side up) the stick pushed to the right.
class StickMotion {
 public:
  /// The stick needs `blend_s` to get to its new place. `segments` not empty.
  StickMotion(std::vector<wrists::Segment> segments, double blend_s);

  /// At t_s since the start; before it the first instant, after the end the last segment goes on.
  StickState At(double t_s) const;
  double DurationSeconds() const { return duration_s_; }

 private:
  std::vector<wrists::Segment> segments_;
  double blend_s_;
  double duration_s_ = 0;
};

}  // namespace footing::stream_client
