#include "clients/game/rules/facts.h"

#include <algorithm>
#include <cmath>

#include "clients/game/rules/piece.h"
#include "common/body/centre_line.h"
#include "common/base/units.h"

namespace footing::game {
namespace {

/// A game has at most 20 rounds; more trials than this are not kept.
constexpr std::size_t kMostTrials = 64;
constexpr std::size_t kMostFaults = 1000;
constexpr double kSlackM = 1e-6;

/// The segments behind `end_m`.
void AddNew(const stream::Track& track, RoundFacts& facts) {
  double from_m = track.first_m;
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    const stream::TrackSegment& segment = track.segments[i];
    if (i > 0 && from_m > facts.end_m - kSlackM) {
      const stream::TrackSegment& before = track.segments[i - 1];
      facts.laid.push_back({from_m, segment.length_m, segment.slope_rad,
                            WrapAngle(segment.heading_rad - before.heading_rad),
                            segment.start_m.z() - stream::Following(before).start_m.z(),
                            segment.pit});
      facts.end_m = from_m + segment.length_m;
    }
    from_m += segment.length_m;
  }
}

}  // namespace

void Collector::OnFault(const Fault& fault) {
  const auto found = facts_.find(fault.trial);
  if (found == facts_.end()) return;
  auto& faults = found->second.faults;
  // One that is known may be withdrawn or restored at any time.
  const bool more = found->second.phase != stream::TrialPhase::kStopped;
  if (faults.contains(fault.number) || (more && faults.size() < kMostFaults)) {
    faults[fault.number] = fault;
  }
}

void Collector::OnTrial(const stream::TrialState& trial) {
  if (trial.trial.empty() || track_.segments.empty()) return;
  if (facts_.size() >= kMostTrials && !facts_.contains(trial.trial)) facts_.clear();
  RoundFacts& facts = facts_[trial.trial];
  if (facts.trial_number != trial.number || facts.end_m == 0) {
    facts = {};
    facts.trial_number = trial.number;
    facts.start_m = track_.start_m;
    facts.end_m = track::LengthOf(track_);
  }
  if (facts.phase == stream::TrialPhase::kStopped) return;
  AddNew(track_, facts);
  facts.phase = trial.progress.phase;
  facts.time_s = trial.progress.time_s;
  facts.farthest_m = std::max(facts.farthest_m, trial.progress.distance_m);
}

const RoundFacts* Collector::Find(const std::string& trial) const {
  const auto found = facts_.find(trial);
  return found == facts_.end() ? nullptr : &found->second;
}

}  // namespace footing::game
