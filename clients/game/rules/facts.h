#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/track.h"
#include "common/stream/trial.h"

/// What footing-sim publishes of a round: all that scores depend on. A recording holds the same.
namespace footing::game {

/// A failure as its event reports it.
struct Fault {
  std::uint64_t number = 0;
  stream::FailureCause cause = stream::FailureCause::kUnspecified;
  std::string trial;
  double distance_m = 0;  ///< Along the track.
  bool withdrawn = false;
};

/// A segment that the builder laid.
struct Stretch {
  double from_m = 0;  ///< Along the track.
  double length_m = 0;
  double slope_rad = 0;
  double curve_rad = 0;
  double step_m = 0;
  bool pit = false;
};

/// One trial of a track that grows.
struct RoundFacts {
  std::uint64_t trial_number = 0;
  stream::TrialPhase phase = stream::TrialPhase::kUnspecified;
  double start_m = 0;     ///< Of the start line.
  double end_m = 0;       ///< Of the track, so far.
  double farthest_m = 0;  ///< Along the track.
  double time_s = 0;
  std::vector<Stretch> laid;
  std::map<std::uint64_t, Fault> faults;  ///< By number, as they count now.
};

/// Collects the facts of every trial that has an id, from ticks in their order. The track of a new
/// trial comes with the tick of its first state, or before it. What happens after a trial was
/// stopped belongs to no round, but for corrections of its failures.
class Collector {
 public:
  void OnTrack(const stream::Track& track) { track_ = track; }
  void OnFault(const Fault& fault);
  /// After the track and the faults of its tick.
  void OnTrial(const stream::TrialState& trial);

  const stream::Track& track() const { return track_; }
  /// Null for a trial that has not been seen.
  const RoundFacts* Find(const std::string& trial) const;

 private:
  stream::Track track_;
  std::map<std::string, RoundFacts> facts_;  ///< By id of the trial.
};

}  // namespace footing::game
