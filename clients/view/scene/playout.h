#pragma once

#include <cstdint>
#include <deque>

#include "clients/view/scene/update.h"

namespace footing::scene {

/// A character whose COM moved further than this between two frames was put back, m.
inline constexpr double kPutBackM = 0.5;

/// The frame between two others: `share` 0 gives a, 1 gives b. Positions on the line, orientations
/// on the arc between; what is not a number (gait, phase, touching) is that of a until b is
/// reached. A character that moved more than 0.5 m between them was put back: it stays at a.
WorldFrame Between(const WorldFrame& a, const WorldFrame& b, double share);

/// Smooths the arrival of frames: shows the stream one frame interval late, so that there is nearly
/// always a frame on either side to draw between.
///
/// Simulation time runs beside the viewer's clock at the pace of the frame that came with the least
/// delay within the last 1.5 s; if frames stop, the newest one stands.
class Playout {
 public:
  /// A frame that the socket gave at `received_ns`. A step back in simulation time means a
  /// restarted server: what was kept is dropped.
  void Push(WorldFrame frame, std::int64_t received_ns);

  bool empty() const { return frames_.empty(); }
  const WorldFrame& Newest() const { return frames_.back().frame; }
  /// When the newest frame came, on the viewer's clock; 0 without one.
  std::int64_t newest_ns() const { return frames_.empty() ? 0 : frames_.back().received_ns; }
  /// What to show at `now_ns`. Not to be called while empty.
  WorldFrame At(std::int64_t now_ns) const;

 private:
  struct Timed {
    WorldFrame frame;
    std::int64_t received_ns = 0;
  };
  double ShownTime(std::int64_t now_ns) const;

  std::deque<Timed> frames_;
};

}  // namespace footing::scene
