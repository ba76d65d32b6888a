#include "common/wire/fields.h"

namespace footing::wire {

template <typename Way>
void Fields(Way way, const stream::TrackSegment&) {
  FOOTING_MESSAGE(start_m);
  FOOTING_FIELD(heading_rad);
  FOOTING_FIELD(slope_rad);
  FOOTING_FIELD(length_m);
  FOOTING_FIELD(width_m);
  FOOTING_FIELD(pit);
}
FOOTING_BOTH_WAYS(TrackSegment)

template <typename Way>
void Fields(Way way, const stream::TrackTask&) {
  FOOTING_FIELD(name);
  FOOTING_ENUM(Gait, before);
  FOOTING_ENUM(Gait, after);
  FOOTING_FIELD(instruction);
}
FOOTING_BOTH_WAYS(TrackTask)

template <typename Way>
void Fields(Way way, const stream::Track&) {
  FOOTING_FIELD(name);
  FOOTING_REPEATED(segments);
  FOOTING_FIELD(revision);
  FOOTING_FIELD(number);
  FOOTING_FIELD(open);
  FOOTING_FIELD(extendable);
  FOOTING_FIELD(endless);
  FOOTING_FIELD(help_over_pits);
  FOOTING_FIELD(first_m);
  FOOTING_FIELD(start_m);
  FOOTING_FIELD(finish_m);
  FOOTING_FIELD(mark_m);
  FOOTING_FIELD(task_within_m);
  FOOTING_REPEATED(tasks);
}
FOOTING_BOTH_WAYS(Track)

template <typename Way>
void Fields(Way way, const stream::FailureCounts&) {
  FOOTING_FIELD(simulation);
  FOOTING_FIELD(curve);
  FOOTING_FIELD(jump);
  FOOTING_FIELD(straightness);
  FOOTING_FIELD(transition);
}
FOOTING_BOTH_WAYS(FailureCounts)

template <typename Way>
void Fields(Way way, const stream::TrialProgress&) {
  FOOTING_ENUM_AS(TrialState_Phase, TrialPhase, phase, phase);
  FOOTING_FIELD(time_s);
  FOOTING_FIELD(distance_m);
  FOOTING_FIELD(lateral_offset_m);
  FOOTING_FIELD(heading_error_rad);
  FOOTING_FIELD(on_track);
  FOOTING_MESSAGE(failures);
  FOOTING_FIELD(operator_put_backs);
  FOOTING_ENUM_AS(TrialState_TaskPhase, TaskPhase, task_phase, task_phase);
}

template <typename Way>
void Fields(Way way, const stream::TrialState&) {
  FOOTING_FIELD(trial);
  FOOTING_FIELD(number);
  FOOTING_FIELD(track);
  FOOTING_FIELD(seed);
  FOOTING_PART(progress);
  FOOTING_FIELD(finish_m);
  // The sum goes along for clients that do not count.
  if constexpr (Way::kOut) {
    way.message.set_failed_attempts(stream::Total(way.value.progress.failures));
  }
  FOOTING_FIELD(withdrawn_failures);
  FOOTING_FIELD(task);
  FOOTING_FIELD(to_mark_m);
  FOOTING_FIELD(instruction);
}
FOOTING_BOTH_WAYS(TrialState)

}  // namespace footing::wire
