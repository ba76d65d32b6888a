#pragma once

#include <string>
#include <utility>

#include "common/stream/trial.h"

namespace footing::study {

/// How one trial stands, from the frames of footing-sim, whoever ends it.
class TrialTracker {
 public:
  explicit TrialTracker(std::string trial) : trial_(std::move(trial)) {}

  /// From each frame, in their order; whether the frame belongs to the trial.
  bool Add(const stream::TrialState& frame);

  /// As of the newest frame of the trial.
  const stream::TrialState& state() const { return state_; }
  bool begun() const { return state_.trial == trial_; }
  bool finished() const { return state_.progress.phase == stream::TrialPhase::kFinished; }
  /// Finished, stopped, or another trial has taken its place.
  bool over() const;
  /// Of a trial that ends now: "finished" if the character reached the finish line, else `reason`.
  std::string Outcome(const std::string& reason) const;

 private:
  std::string trial_;
  stream::TrialState state_;
  bool replaced_ = false;
};

}  // namespace footing::study
