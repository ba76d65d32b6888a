#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::wire {
namespace {

template <typename Phase>
Phase PhaseNumbered(int number, Phase last) {
  return number > 0 && number <= static_cast<int>(last) ? static_cast<Phase>(number)
                                                        : Phase::kUnspecified;
}

}  // namespace

v1::Track ToProto(const stream::Track& value) {
  v1::Track message;
  message.set_name(Utf8(value.name));
  for (const auto& segment : value.segments) {
    v1::TrackSegment& out = *message.add_segments();
    *out.mutable_start_m() = ToProto(segment.start_m);
    out.set_heading_rad(Finite(segment.heading_rad));
    out.set_slope_rad(Finite(segment.slope_rad));
    out.set_length_m(Finite(segment.length_m));
    out.set_width_m(Finite(segment.width_m));
    out.set_pit(segment.pit);
  }
  message.set_revision(value.revision);
  message.set_number(value.number);
  message.set_open(value.open);
  message.set_extendable(value.extendable);
  message.set_endless(value.endless);
  message.set_help_over_pits(value.help_over_pits);
  message.set_first_m(Finite(value.first_m));
  message.set_start_m(Finite(value.start_m));
  message.set_finish_m(Finite(value.finish_m));
  message.set_mark_m(Finite(value.mark_m));
  message.set_task_within_m(Finite(value.task_within_m));
  for (const stream::TrackTask& task : value.tasks) {
    v1::TrackTask& out = *message.add_tasks();
    out.set_name(Utf8(task.name));
    out.set_before(static_cast<v1::Gait>(task.before));
    out.set_after(static_cast<v1::Gait>(task.after));
    out.set_instruction(Utf8(task.instruction));
  }
  return message;
}

stream::Track FromProto(const v1::Track& message) {
  stream::Track value;
  value.name = message.name();
  for (const auto& segment : message.segments()) {
    value.segments.push_back({FromProto(segment.start_m()), Finite(segment.heading_rad()),
                              Finite(segment.slope_rad()), Finite(segment.length_m()),
                              Finite(segment.width_m()), segment.pit()});
  }
  value.revision = message.revision();
  value.number = message.number();
  value.open = message.open();
  value.extendable = message.extendable();
  value.endless = message.endless();
  value.help_over_pits = message.help_over_pits();
  value.first_m = Finite(message.first_m());
  value.start_m = Finite(message.start_m());
  value.finish_m = Finite(message.finish_m());
  value.mark_m = Finite(message.mark_m());
  value.task_within_m = Finite(message.task_within_m());
  for (const auto& task : message.tasks()) {
    value.tasks.push_back({task.name(), stream::GaitNumbered(task.before()),
                           stream::GaitNumbered(task.after()), task.instruction()});
  }
  return value;
}

v1::FailureCounts ToProto(const stream::FailureCounts& value) {
  v1::FailureCounts message;
  message.set_simulation(value.simulation);
  message.set_curve(value.curve);
  message.set_jump(value.jump);
  message.set_straightness(value.straightness);
  message.set_transition(value.transition);
  return message;
}

stream::FailureCounts FromProto(const v1::FailureCounts& message) {
  return {message.simulation(), message.curve(), message.jump(), message.straightness(),
          message.transition()};
}

v1::TrialState ToProto(const stream::TrialState& value) {
  const stream::TrialProgress& progress = value.progress;
  v1::TrialState message;
  message.set_trial(Utf8(value.trial));
  message.set_number(value.number);
  message.set_phase(static_cast<v1::TrialState::Phase>(progress.phase));
  message.set_track(Utf8(value.track));
  message.set_seed(value.seed);
  message.set_time_s(Finite(progress.time_s));
  message.set_distance_m(Finite(progress.distance_m));
  message.set_finish_m(Finite(value.finish_m));
  message.set_lateral_offset_m(Finite(progress.lateral_offset_m));
  message.set_heading_error_rad(Finite(progress.heading_error_rad));
  message.set_on_track(progress.on_track);
  *message.mutable_failures() = ToProto(progress.failures);
  message.set_failed_attempts(stream::Total(progress.failures));
  message.set_withdrawn_failures(value.withdrawn_failures);
  message.set_operator_put_backs(progress.operator_put_backs);
  message.set_task(Utf8(value.task));
  message.set_task_phase(static_cast<v1::TrialState::TaskPhase>(progress.task_phase));
  message.set_to_mark_m(Finite(value.to_mark_m));
  message.set_instruction(Utf8(value.instruction));
  return message;
}

stream::TrialState FromProto(const v1::TrialState& message) {
  stream::TrialState value;
  stream::TrialProgress& progress = value.progress;
  value.trial = message.trial();
  value.number = message.number();
  progress.phase = PhaseNumbered(message.phase(), stream::TrialPhase::kStopped);
  value.track = message.track();
  value.seed = message.seed();
  progress.time_s = Finite(message.time_s());
  progress.distance_m = Finite(message.distance_m());
  value.finish_m = Finite(message.finish_m());
  progress.lateral_offset_m = Finite(message.lateral_offset_m());
  progress.heading_error_rad = Finite(message.heading_error_rad());
  progress.on_track = message.on_track();
  progress.failures = FromProto(message.failures());
  value.withdrawn_failures = message.withdrawn_failures();
  progress.operator_put_backs = message.operator_put_backs();
  value.task = message.task();
  progress.task_phase = PhaseNumbered(message.task_phase(), stream::TaskPhase::kDone);
  value.to_mark_m = Finite(message.to_mark_m());
  value.instruction = message.instruction();
  return value;
}

}  // namespace footing::wire
