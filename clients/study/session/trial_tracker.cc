#include "clients/study/session/trial_tracker.h"

namespace footing::study {

bool TrialTracker::Add(const stream::TrialState& frame) {
  if (frame.trial != trial_) {
    replaced_ = replaced_ || begun();  // Before the first frame of its own it is that of another.
    return false;
  }
  state_ = frame;
  return true;
}

bool TrialTracker::over() const {
  return finished() || replaced_ || state_.progress.phase == stream::TrialPhase::kStopped;
}

std::string TrialTracker::Outcome(const std::string& reason) const {
  return finished() ? "finished" : reason;
}

}  // namespace footing::study
