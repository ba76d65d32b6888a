#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "common/stream/gait.h"

namespace footing::stream {

/// A piece of ground; start is the middle of the top face's near edge.
struct TrackSegment {
  Eigen::Vector3d start_m = Eigen::Vector3d::Zero();
  double heading_rad = 0;
  double slope_rad = 0;
  double length_m = 0;
  double width_m = 0;
  bool pit = false;
};

/// A segment without length that begins where another ends and goes on as it does, level.
TrackSegment Following(const TrackSegment& last);

/// What a user has to do where a track has its mark (gait paper, section 8.1: when the biped
/// crosses the line it is to jump, to stop, or to change between walking and running).
struct TrackTask {
  std::string name;                  ///< "walk_run"
  Gait before = Gait::kUnspecified;  ///< Up to the mark.
  Gait after = Gait::kUnspecified;   ///< From the mark on; kStep is a stop.
  std::string instruction;           ///< For the screen: "walk to the line, then run".
};

/// "walk to the line, then run".
std::string InstructionFor(Gait before, Gait after);

/// A ribbon of segments. Lengths along the track are measured on its centre line, from the start of
/// the first segment that it ever had.
struct Track {
  std::string name;
  std::vector<TrackSegment> segments;
  std::uint64_t revision = 0;    ///< Counts up with every change.
  std::uint64_t number = 1;      ///< Of the tracks that a server has used, counted from 1.
  bool open = false;             ///< One may leave the ribbon; otherwise that is a failure.
  bool extendable = false;       ///< Segments may be added at the end while a character is on it.
  bool endless = false;          ///< Continues itself ahead of the character.
  bool help_over_pits = true;    ///< The gait controllers see pits and fit their steps to them.
  double first_m = 0;            ///< Length of the segments that were dropped from the start.
  double start_m = 0;            ///< A trial's clock starts here ...
  double finish_m = 0;           ///< ... and stops here; 0: no finish line.
  double mark_m = 0;             ///< A task begins here; 0: no mark.
  double task_within_m = 0;      ///< It must be done so far behind the mark.
  std::vector<TrackTask> tasks;  ///< A trial draws one of these; none without a mark.
};

}  // namespace footing::stream
