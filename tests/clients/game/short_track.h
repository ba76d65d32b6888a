#pragma once

#include "clients/game/rules/director.h"
#include "common/stream/trial.h"

namespace footing::game {

/// Level ground of 4 m segments along x, as the track "build" begins.
inline stream::Track ShortTrack(double length_m = 16) {
  stream::Track track;
  track.name = "build";
  track.extendable = true;
  track.start_m = 1;
  track.revision = 1;
  for (double from_m = 0; from_m < length_m; from_m += 4) {
    stream::TrackSegment segment;
    segment.start_m.x() = from_m;
    segment.length_m = 4;
    segment.width_m = 4;
    track.segments.push_back(segment);
  }
  return track;
}

inline void Lay(const Piece& piece, stream::Track& track) {
  track.segments.push_back(track::Placed(piece, track.segments.back()));
  ++track.revision;
}

inline stream::TrialState TrialAt(const std::string& id, double distance_m, double time_s = 1) {
  stream::TrialState trial;
  trial.trial = id;
  trial.number = 1;
  trial.progress.phase = stream::TrialPhase::kRunning;
  trial.progress.distance_m = distance_m;
  trial.progress.time_s = time_s;
  return trial;
}

}  // namespace footing::game
