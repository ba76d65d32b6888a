#pragma once

#include <array>

namespace footing::timeline {

/// Paces of playback: recorded seconds a second.
inline constexpr std::array kSpeeds{0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};

/// Where playback stands on a timeline, and how it moves on.
struct PlayHead {
  double begin_s = 0;
  double end_s = 0;
  double at_s = 0;
  double speed = 1;
  bool paused = false;

  bool ended() const { return at_s >= end_s; }
};

/// From `begin_s` on.
PlayHead HeadAt(double begin_s, double end_s, double speed);

/// Moves to a position, or to the nearest end.
PlayHead Sought(PlayHead head, double at_s);
/// The position after `passed_s` of the viewer's time; it stops at the end.
PlayHead Advanced(PlayHead head, double passed_s);

/// The next pace of kSpeeds above or below the present one, which need not be among them; the last
/// one where there is no other.
double Faster(double speed);
double Slower(double speed);

}  // namespace footing::timeline
