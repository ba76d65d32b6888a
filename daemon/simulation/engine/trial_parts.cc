#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/engine/failure.h"
#include "daemon/simulation/engine/parts.h"

namespace footing::engine {

using stream::FailureCause;

void GaitEngine::Parts::BeginOnTrack() {
  const std::uint64_t appends = state.track.append_number;
  state.track = {};
  state.track.append_number = appends;
  const stream::TrackSegment start = on.track.segments.front();
  box_holds = {};
  place = {};
  PlaceGround();
  Stand(start.start_m, start.heading_rad);
}

void GaitEngine::Parts::TakeTrial(const EngineInputs& inputs) {
  InputMemory& taken = state.inputs;
  if (taken.trial_number != inputs.trial.number) {
    taken.trial_number = inputs.trial.number;
    state.trial = trial::Begin(on.track, inputs.trial.task);
    const stream::TrackSegment start = on.track.segments.front();
    Stand(start.start_m, start.heading_rad);
    state.interface.RenewGrip();
    AddEvent({.kind = EventKind::kTrialReady, .trial = Progress()});
  }
  if (taken.trial_number < inputs.trial.stopped_below && trial::GoesOn(state.trial)) {
    trial::Stop(TimeS(), state.trial);
    AddEvent({.kind = EventKind::kTrialStopped, .trial = Progress()});
  }
}

stream::TrialProgress GaitEngine::Parts::Progress() const {
  const stream::TrackSegment& segment = on.track.segments[static_cast<std::size_t>(place.segment)];
  const double yaw_rad = std::atan2(body.R_WB(1, 0), body.R_WB(0, 0));
  stream::TrialProgress progress;
  progress.phase = state.trial.phase;
  progress.time_s = trial::TimeOf(state.trial, TimeS());
  progress.distance_m = DistanceAlong();
  progress.lateral_offset_m = std::copysign(place.distance_m, place.sideways_m);
  progress.heading_error_rad = WrapAngle(yaw_rad - segment.heading_rad);
  progress.on_track = !terrain::IsOffRibbon(on.track, place);
  progress.failures = state.trial.failures;
  progress.operator_put_backs = state.trial.operator_put_backs;
  progress.task = state.trial.task;
  progress.task_phase = state.trial.task_phase;
  return progress;
}

void GaitEngine::Parts::NoteTrial() {
  if (state.fallen) return;
  const trial::TrialCues cues{.time_s = TimeS(),
                              .distance_m = DistanceAlong(),
                              .gait = state.gait.gait,
                              .speed_mps = body.v_WC.head<2>().norm()};
  const trial::TrialNews news = trial::Advance(on.track, cues, state.trial);
  if (news.started) AddEvent({.kind = EventKind::kTrialRunning, .trial = Progress()});
  if (news.task_done) AddEvent({.kind = EventKind::kTaskDone, .trial = Progress()});
  if (news.finished) AddEvent({.kind = EventKind::kTrialFinished, .trial = Progress()});
  if (news.failed != nullptr) Fail(FailureCause::kTransition, news.failed);
}

void GaitEngine::Parts::NoteFall() {
  if (state.fallen) return;
  if (MissesPit(on.track, place, body)) state.missed_pit_s = TimeS();
  Failure failure = FindFailure(on.track, place, body, on.world.Observe());
  if (failure.why == nullptr) return;
  const bool stumbles = TimeS() - state.missed_pit_s < kStumbleS;
  if (failure.cause == FailureCause::kSimulation && stumbles) failure.cause = FailureCause::kJump;
  // Behind the finish line a character may slow down as it can.
  const bool over =
      !trial::GoesOn(state.trial) && on.track.finish_m > 0 && DistanceAlong() >= on.track.finish_m;
  if (over) {
    state.fallen = true;
    state.fallen_time_s = TimeS();
    state.put_back_to_m = DistanceAlong() - config.put_back_distance_m;
    return;
  }
  Fail(trial::Attribute(on.track, state.trial, failure.cause), failure.why);
}

void GaitEngine::Parts::Fail(FailureCause cause, const char* why) {
  state.fallen = true;
  state.fallen_time_s = TimeS();
  const double at_m = DistanceAlong();
  state.put_back_to_m =
      at_m - trial::PutBackDistance(on.track, cause, at_m, config.put_back_distance_m);
  ++*stream::MutableCountOf(cause, state.failures);
  const bool in_trial = trial::GoesOn(state.trial);
  if (in_trial) ++*stream::MutableCountOf(cause, state.trial.failures);
  AddEvent({.kind = EventKind::kFall,
            .from = state.gait.gait,
            .to = stream::Gait::kUnspecified,
            .text = why,
            .cause = cause,
            .failure_number = stream::Total(state.failures),
            .in_trial = in_trial,
            .trial = Progress(),
            .p_WC_m = body.p_WC});
}

}  // namespace footing::engine
