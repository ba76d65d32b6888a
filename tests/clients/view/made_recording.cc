#include "tests/clients/view/made_recording.h"

#include <algorithm>
#include <utility>

#include "common/base/units.h"
#include "common/recording/recording_writer.h"
#include "common/wire/wire.h"
#include "tests/clients/view/made_stream.h"

namespace footing::view::made {
namespace {

using stream::FailureCause;
using stream::TrialPhase;
using wire::ToProto;

constexpr double kWalkFromS = 20, kFallS = 30, kPutBackS = 30.3, kPutBackM = 5, kJumpFallS = 42;

struct Writer {
  recording::RecordingWriter file;
  std::int64_t host_ns = 0;
  std::uint32_t sequence = 0;

  void Write(const std::string& topic, const google::protobuf::Message& message) {
    // The recorder gets it 2 ms later.
    FOOTING_CHECK(file.Write(topic, message, {host_ns, host_ns + 2'000'000, sequence}));
  }
};

stream::TrialState TrialAtTime(double time_s) {
  stream::TrialState state;
  const bool second = time_s >= 55;
  state.trial = time_s < 5 ? "" : second ? "p07-2" : "p07-1";
  state.number = time_s < 5 ? 0 : second ? 2 : 1;
  state.track = "straight";
  state.task = "run_walk";
  state.instruction = "run to the line, then walk";
  state.progress.phase = time_s < 6 || second ? TrialPhase::kReady
                         : time_s < 50        ? TrialPhase::kRunning
                                              : TrialPhase::kFinished;
  state.progress.time_s = second ? 0 : std::clamp(time_s - 6, 0.0, 44.0);
  state.progress.on_track = true;
  if (!second && time_s >= kFallS) state.progress.failures.curve = 1;
  if (!second && time_s >= kJumpFallS && time_s < 43) state.progress.failures.jump = 1;
  if (!second && time_s >= 43) state.withdrawn_failures = 1;
  if (time_s >= 5) state.finish_m = 60;
  return state;
}

v1::CharacterFrame FrameOf(scene::CharacterPose pose, double time_s, bool trials) {
  if (time_s >= kPutBackS) {
    for (stream::LinkPose& link : pose.links) link.position_m.x() -= kPutBackM;
    for (stream::Contact& contact : pose.contacts) contact.position_m.x() -= kPutBackM;
    pose.com_m.x() -= kPutBackM;
  }
  pose.gait.falls = (time_s >= kFallS ? 1 : 0) + (time_s >= kJumpFallS ? 1 : 0);
  v1::CharacterFrame frame;
  frame.set_time_s(time_s);
  v1::Character& character = *frame.add_characters();
  character.set_character(pose.character);
  character.set_valid(pose.valid);
  for (const auto& link : pose.links) *character.add_links() = ToProto(link);
  for (const auto& contact : pose.contacts) *character.add_contacts() = ToProto(contact);
  *character.mutable_com_m() = ToProto(pose.com_m);
  *character.mutable_com_velocity_mps() = ToProto(pose.com_velocity_mps);
  *character.mutable_gait() = ToProto(pose.gait);
  character.mutable_gait()->set_phase(pose.phase);
  character.set_simulated_input(pose.simulated_input);
  if (trials) *character.mutable_trial() = ToProto(TrialAtTime(time_s));
  return frame;
}

v1::Event EventOf(v1::Event::Kind kind, const std::string& text, double time_s) {
  v1::Event event;
  event.set_kind(kind);
  event.set_host_ns(kFirstNs + RoundToNanoseconds(time_s));
  event.set_text(text);
  if (kind == v1::Event::KIND_TRIAL || kind == v1::Event::KIND_TASK) {
    *event.mutable_trial() = ToProto(TrialAtTime(time_s));
  }
  return event;
}

v1::Event FailureOf(v1::Event::Kind kind, int number, v1::FailureCause cause, double time_s) {
  v1::Event event = EventOf(kind, "failure", time_s);
  event.set_failure_cause(cause);
  event.mutable_failure()->set_number(number);
  event.mutable_failure()->set_cause(cause);
  event.mutable_failure()->set_trial("p07-1");
  event.mutable_failure()->set_trial_time_s(time_s - 6);
  event.mutable_failure()->set_distance_m(2 * time_s);
  event.mutable_failure()->set_withdrawn(kind == v1::Event::KIND_CORRECTION);
  return event;
}

v1::Event ResponseAt(double time_s) {
  v1::Event event = EventOf(v1::Event::KIND_RESPONSE, "response", time_s);
  v1::ResponseStages& stages = *event.mutable_response();
  stages.set_from(v1::GAIT_RUN);
  stages.set_to(v1::GAIT_WALK);
  std::int64_t at_ns = event.host_ns() - 7'000'000;
  for (auto set :
       {&v1::ResponseStages::set_report_received_ns, &v1::ResponseStages::set_decoded_ns,
        &v1::ResponseStages::set_features_computed_ns,
        &v1::ResponseStages::set_features_received_ns, &v1::ResponseStages::set_command_ns,
        &v1::ResponseStages::set_contact_ns, &v1::ResponseStages::set_first_frame_ns}) {
    (stages.*set)(at_ns += 1'000'000);
  }
  return event;
}

/// Events in the hundredth of a second of that number.
v1::Events EventsAt(int tick, bool trials) {
  const double time_s = 0.01 * tick;
  v1::Events events;
  if (tick == 2000) {
    *events.add_events() =
        EventOf(v1::Event::KIND_GAIT_CHANGED, "gait changed: run to walk", time_s);
    *events.add_events() = ResponseAt(time_s);
  }
  if (!trials) return events;
  if (tick == 500 || tick == 600 || tick == 5000 || tick == 5500) {
    *events.add_events() = EventOf(v1::Event::KIND_TRIAL, "trial", time_s);
  }
  if (tick == 3500) *events.add_events() = EventOf(v1::Event::KIND_TASK, "task done", time_s);
  const auto fall = v1::Event::KIND_FALL;
  if (tick == 3000) *events.add_events() = FailureOf(fall, 1, v1::FAILURE_CAUSE_CURVE, time_s);
  if (tick == 4200) *events.add_events() = FailureOf(fall, 2, v1::FAILURE_CAUSE_JUMP, time_s);
  if (tick == 4300) {
    *events.add_events() = FailureOf(v1::Event::KIND_CORRECTION, 2, v1::FAILURE_CAUSE_JUMP, time_s);
  }
  return events;
}

void WriteSensors(const scene::Update& update, Writer& writer) {
  if (update.devices) {
    v1::DeviceStatusList status;
    for (const auto& device : *update.devices) *status.add_devices() = ToProto(device);
    writer.Write("/footingd/status", status);
  }
  v1::MotionSamples motion;
  for (stream::MotionSample sample : update.motion) {
    sample.received_ns += writer.host_ns - update.host_ns;
    *motion.add_samples() = ToProto(sample);
  }
  writer.Write("/footingd/motion", motion);
  v1::FeatureFrame features;
  for (stream::RigFeatures rig : update.features) {
    const std::int64_t at_ns = writer.host_ns - kFirstNs;
    const bool unknown = at_ns >= 40'000'000'000 && at_ns < 57'000'000'000;
    if (unknown) rig.pairs[0].phase_valid = false;
    *features.add_rigs() = ToProto(rig);
  }
  writer.Write("/footingd/features", features);
  v1::BoardSamples boards;
  for (const auto& sample : update.boards) *boards.add_samples() = ToProto(sample);
  writer.Write("/footingd/boards", boards);
}

void WriteSimulation(const scene::Update& update, int tick, bool trials, Writer& writer) {
  if (update.skeletons) {
    v1::Skeletons skeletons;
    for (const auto& one : *update.skeletons) *skeletons.add_skeletons() = ToProto(one);
    writer.Write("/footing-sim/skeletons", skeletons);
    writer.Write("/footing-sim/track", ToProto(*update.track));
  }
  writer.Write("/footing-sim/characters",
               FrameOf(update.frame->characters[0], 0.01 * tick, trials));
  const v1::Events events = EventsAt(tick, trials);
  if (events.events_size() > 0) writer.Write("/footing-sim/events", events);
}

}  // namespace

void WriteRecording(const std::string& path, const RecordingWish& wish) {
  auto file = recording::RecordingWriter::Create(path, {"test", true, {}});
  FOOTING_CHECK(file.ok());
  Writer writer{std::move(*file), kFirstNs, 0};
  for (const char* server : {"footing-sim", "footingd"}) {
    const std::string first = std::to_string(kFirstNs);
    FOOTING_CHECK(
        writer.file.AddMetadata("session", {{"server", server},
                                            {"address", "unix:/made"},
                                            {"server_host_ns", first},
                                            {"recorder_host_ns", first},
                                            {"server_wall_time_ns", "1700000000000000000"}}));
  }
  const auto ticks = static_cast<int>(100 * wish.seconds);
  for (int tick = 0; tick <= ticks; ++tick) {
    const double time_s = 0.01 * tick;
    scene::made::Wish gait;
    gait.gait = time_s < kWalkFromS ? stream::Gait::kRun : stream::Gait::kWalk;
    const scene::Update update = scene::made::TickAt(time_s, gait);
    writer.host_ns = kFirstNs + RoundToNanoseconds(time_s);
    writer.sequence = static_cast<std::uint32_t>(tick + 1);
    if (time_s < wish.sensors_until_s) WriteSensors(update, writer);
    if (time_s < wish.frames_until_s) WriteSimulation(update, tick, wish.trials, writer);
  }
  FOOTING_CHECK(writer.file.Finish());
}

}  // namespace footing::view::made
