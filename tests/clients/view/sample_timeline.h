#pragma once

#include "clients/view/scene/timeline.h"

namespace footing::timeline {

/// Two trials in 100 s: p07-1 from 10 s, start line at 12 s, finish at 40 s, failures at 20 s
/// (curve) and 30 s (jump, withdrawn); another without an id from 50 s, never started, a failure of
/// the simulation at 60 s.
inline Timeline SampleTimeline() {
  Timeline line;
  line.end_s = 100;
  TrialMark first;
  first.id = "p07-1";
  first.number = 1;
  first.track = "straight";
  first.begin_s = 10;
  first.start_s = 12;
  first.end_s = 40;
  first.phase = stream::TrialPhase::kFinished;
  first.time_s = 28;
  TrialMark second;
  second.number = 2;
  second.begin_s = 50;
  line.trials = {first, second};
  const auto failure = [](double at_s, stream::FailureCause cause, bool withdrawn) {
    FailureMark mark;
    mark.at_s = at_s;
    mark.cause = cause;
    mark.withdrawn = withdrawn;
    return mark;
  };
  line.failures = {failure(20, stream::FailureCause::kCurve, false),
                   failure(30, stream::FailureCause::kJump, true),
                   failure(60, stream::FailureCause::kSimulation, false)};
  line.tasks = {{35, "run_walk"}};
  return line;
}

}  // namespace footing::timeline
