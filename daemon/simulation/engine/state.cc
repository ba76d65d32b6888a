#include "daemon/simulation/engine/state.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/base/units.h"
#include "common/stream/gait.h"
#include "common/stream/trial.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/model.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/style.h"

namespace footing::engine {

Result<std::unique_ptr<TrackWorld>> MakeTrackWorld(stream::Track track,
                                                   const biped::BipedParameters& biped,
                                                   double step_s) {
  std::vector<std::string> boxes;
  const terrain::GroundWindow window = terrain::WindowOf(track);
  for (int i = 0; i < window.boxes; ++i) {
    boxes.push_back(terrain::GroundBoxName(i));
  }
  const terrain::GroundText ground = terrain::GroundMjcf(track);
  Result<physics::World> world = physics::World::FromMjcf(
      biped::WriteMjcf(biped, ground.mjcf, ground.names, step_s), biped::Names(boxes));
  if (!world) return world.error();
  physics::World twin = world->Twin();
  auto made = std::make_unique<TrackWorld>(TrackWorld{.track = std::move(track),
                                                      .sight = {},
                                                      .sees_ground = false,
                                                      .first_segments = {},
                                                      .window = window,
                                                      .world = std::move(*world),
                                                      .twin = std::move(twin)});
  if (!made->track.help_over_pits) made->sight = terrain::WithPitsFilled(made->track);
  made->sees_ground = !terrain::IsLevel(made->track.help_over_pits ? made->track : made->sight);
  if (terrain::Grows(made->track)) {
    made->first_segments = made->track.segments;
    made->track.segments.reserve(terrain::kMostSegments);
  }
  return made;
}

namespace {

constexpr double kPushDurationS = 0.1;
constexpr double kLargestPushNs = 1000;
constexpr double kLargestTowN = 1000;

}  // namespace

void GaitEngine::Parts::AddEvent(const EngineEvent& event) {
  FOOTING_CHECK(output.event_count < kMaxEvents);
  EngineEvent& added = output.events[static_cast<std::size_t>(output.event_count++)];
  added = event;
  added.trial_number = state.inputs.trial_number;
}

void GaitEngine::Parts::Stand(const Eigen::Vector3d& p_W_m, double heading_rad) {
  const double leg_m = gait::StandingLength(biped, tables.plain.At(stream::Gait::kStep, 0));
  const double height_m = biped.foot_radius_m + leg_m + biped.hip_below_body_com_m;
  std::array<double, physics::kJoints> joints{};
  joints[3] = joints[7] = leg_m - biped.leg_length_m;
  on.world.Reset(p_W_m + Eigen::Vector3d(0, 0, height_m), heading_rad, joints);
  const std::uint64_t steps = state.gait.steps;
  state.gait = gait::Standing(heading_rad, TimeS());
  state.gait.steps = steps;
  state.interface.StartAgain();
  state.fallen = false;
  state.missed_pit_s = -1e9;
  state.foresight = {};
  state.inputs.push_steps_left = 0;
  ReadBody();
}

void GaitEngine::Parts::ReadBody() {
  body = biped::Read(biped, on.world.Observe(), TimeS());
  place = terrain::Locate(on.track, body.p_WB.head<2>());
}

void GaitEngine::Parts::PutBack(const char* why, double to_m, bool by_operator) {
  const terrain::CentrePoint point =
      terrain::CentreBehind(on.track, terrain::PlaceAt(on.track, to_m), 0);
  Stand(point.p_W_m, point.heading_rad);
  trial::TakePutBack(on.track, DistanceAlong(), state.trial);
  AddEvent({.kind = EventKind::kPutBack, .text = why, .by_operator = by_operator});
}

void GaitEngine::Parts::TakePutBack(const EngineInputs& inputs) {
  if (state.inputs.put_back_number != inputs.put_back_number) {
    state.inputs.put_back_number = inputs.put_back_number;
    // For a character that lies there it is only the end of its failure, a moment earlier.
    if (!state.fallen) {
      ++state.operator_put_backs;
      if (trial::GoesOn(state.trial)) ++state.trial.operator_put_backs;
    }
    const double behind_m = DistanceAlong() - config.put_back_distance_m;
    PutBack("by a command", state.fallen ? state.put_back_to_m : behind_m, true);
  } else if (state.fallen && TimeS() - state.fallen_time_s >= config.fall_shown_s) {
    PutBack("after a failure", state.put_back_to_m, false);
  }
}

void GaitEngine::Parts::TakeFeatures(const EngineInputs& inputs) {
  InputMemory& taken = state.inputs;
  const bool fresh = taken.features_number != inputs.features_number;
  if (fresh) {
    taken.features_number = inputs.features_number;
    taken.features_time_s = TimeS();
    if (!taken.fed) AddEvent({.kind = EventKind::kStreamBack});
    taken.fed = true;
    state.simulated_input = inputs.features.simulated;
  } else if (taken.fed && TimeS() - taken.features_time_s > config.features_timeout_s) {
    taken.fed = false;
    AddEvent({.kind = EventKind::kStreamLost});
  }
}

void GaitEngine::Parts::TakeInterface(const EngineInputs& inputs) {
  const InterfaceInputs& wanted = inputs.interface;
  if (state.inputs.interface_number == wanted.number || !wanted.made) return;
  state.inputs.interface_number = wanted.number;
  state.interface = *wanted.made;
}

void GaitEngine::Parts::TakePush(const EngineInputs& inputs) {
  InputMemory& taken = state.inputs;
  if (taken.push_number == inputs.push_number) return;
  taken.push_number = inputs.push_number;
  const Eigen::Vector2d& impulse_ns = inputs.push_impulse_W_ns;
  if (!impulse_ns.allFinite() || impulse_ns.norm() > kLargestPushNs) return;
  taken.push_steps_left = static_cast<int>(std::lround(kPushDurationS / config.step_s));
  const double duration_s = taken.push_steps_left * config.step_s;
  taken.push_W_n << impulse_ns / duration_s, 0;
}

void GaitEngine::Parts::TakeTow(const EngineInputs& inputs) {
  const Eigen::Vector2d& tow_n = inputs.tow_W_n;
  const bool taken = tow_n.allFinite() && tow_n.norm() <= kLargestTowN;
  state.inputs.tow_W_n << (taken ? tow_n : Eigen::Vector2d::Zero()), 0;
}

void GaitEngine::Parts::Command(const EngineInputs& inputs) {
  const stream::Gait before = state.command.gait;
  mapping::Inputs person = state.inputs.fed ? inputs.features : mapping::Inputs{};
  person.running = state.gait.gait;
  biped::GaitCommand command = state.interface.Advance(TimeS(), person);
  if (inputs.direct) command = inputs.direct_command;
  state.command = biped::Limited(command);
  if (state.command.gait == before) return;
  state.response = {
      .waiting = true,
      .steps = {.commanded = state.step + 1, .features_number = inputs.features_number}};
  AddEvent({.kind = EventKind::kGaitCommanded, .from = before, .to = state.command.gait});
}

void GaitEngine::Parts::StepWorld() {
  const int phase_before = PhaseOf(state.gait);
  const bool pushed = state.inputs.push_steps_left > 0;
  output.joint_efforts = {};
  if (!state.fallen) {  // A fallen character is limp.
    const gait::Gains& now = gains.At(tables, state.foresight.chosen, state.gait);
    output.joint_efforts =
        gait::Advance(body, biped, now, state.command, Sight(), config.step_s, state.gait);
  }
  output.push_W_n = state.inputs.tow_W_n;
  if (state.inputs.push_steps_left > 0) {
    --state.inputs.push_steps_left;
    output.push_W_n += state.inputs.push_W_n;
  }
  const Eigen::Vector3d p_WC = body.p_WC;
  on.world.Step(output.joint_efforts, output.push_W_n);
  ++state.step;
  ReadBody();
  const double c = std::cos(state.gait.heading_rad), s = std::sin(state.gait.heading_rad);
  const Eigen::Vector3d moved = body.p_WC - p_WC;
  if (on.track.endless) terrain::FollowCourse(moved.head<2>(), state.track.course);
  state.distance_m += c * moved.x() + s * moved.y();
  LookAhead(phase_before, pushed && state.inputs.push_steps_left == 0);
}

void GaitEngine::Parts::LookAhead(int phase_before, bool push_ended) {
  const bool any = !tables.choices[stream::IndexOf(GaitOf(state.gait))].empty();
  if (!any || state.fallen) {
    state.foresight = {};
    return;
  }
  if (state.inputs.push_steps_left > 0) return;
  if (!push_ended && PhaseOf(state.gait) == phase_before) return;
  const gait::Context context{.body = body,
                              .biped = biped,
                              .gains = gains.At(tables, state.foresight.chosen, state.gait),
                              .goal = state.command,
                              .seen_ground = Sight(),
                              .step_s = config.step_s};
  // Rollouts are exact: until halfway through what they have seen, there is nothing new to see.
  const std::uint64_t ahead = static_cast<std::uint64_t>(kHorizonS / config.step_s) / 2;
  const bool certain = state.foresight.stands_until > state.step + ahead;
  const bool calm =
      state.foresight.chosen.number == 0 && (certain || gait::IsRegular(context, state.gait));
  if (calm && !push_ended) return;
  state.foresight =
      ChooseAhead({on.world.Save(), state.gait, state.step}, {.biped = biped,
                                                              .tables = tables,
                                                              .track = on.track,
                                                              .sight = Sight(),
                                                              .command = state.command,
                                                              .tow_W_n = state.inputs.tow_W_n,
                                                              .step_s = config.step_s,
                                                              .twin = on.twin,
                                                              .gains = gains_ahead});
}

void GaitEngine::Parts::NoteGait(stream::Gait before) {
  const stream::Gait now = state.gait.gait;
  if (now != before) AddEvent({.kind = EventKind::kGaitChanged, .from = before, .to = now});
  if (state.response.waiting && now == state.command.gait) {
    state.response.waiting = false;
    state.response.steps.taken_over = state.step;
    AddEvent({.kind = EventKind::kGaitTakenOver, .from = before, .to = now});
  }
}

void GaitEngine::Parts::FillOutput() {
  output.step = state.step;
  output.time_s = TimeS();
  for (int i = 0; i < kLinkCount; ++i) {
    stream::LinkPose& pose = output.links[static_cast<std::size_t>(i)];
    on.world.LinkPose(i, pose.position_m, pose.orientation);
  }
  for (std::size_t i = 0; i < kContactCount; ++i) {
    const biped::LegState& leg = body.legs[i];
    output.contacts[i] = {.touching = leg.touching,
                          .position_m = leg.p_WF - Eigen::Vector3d(0, 0, biped.foot_radius_m),
                          .normal_force_n = leg.normal_force_n};
  }
  output.p_WC_m = body.p_WC;
  output.v_WC_mps = body.v_WC;
  output.gait = gait::Describe(body, state.command, state.gait);
  output.gait.failures = state.failures;
  output.gait.operator_put_backs = state.operator_put_backs;
  output.gait.falls = stream::Total(state.failures);
  output.gait.distance_m = state.distance_m;
  output.gait.commanded_by_stream = state.inputs.fed;
  output.interface = state.interface.state();
  output.trial = Progress();
  output.trial_number = state.inputs.trial_number;
  output.track_number = on.track.number;
  output.simulated_input = state.simulated_input;
  output.root_force_max_n = on.world.root_force_max_n();
  output.state_hash = on.world.StateHash();
  output.response = state.response.steps;
  output.append.number = state.track.append_number;
}

void GaitEngine::Parts::TakeAppend(const EngineInputs& inputs) {
  std::uint64_t& taken = state.track.append_number;
  if (taken == inputs.append_number) return;
  const auto listed = static_cast<std::uint64_t>(std::clamp(inputs.append_count, 0, kMaxAppends));
  const std::uint64_t oldest = inputs.append_number - std::min(listed, inputs.append_number) + 1;
  if (taken + 1 < oldest || taken > inputs.append_number) {
    taken = std::min(oldest - 1, inputs.append_number);
    AddEvent({.kind = EventKind::kAppendRefused, .text = "segments were lost on the way"});
    return;
  }
  const terrain::NewSegment& segment = inputs.appends[static_cast<std::size_t>(taken + 1 - oldest)];
  ++taken;
  if (const char* why = terrain::WhyNotAppended(on.track, segment, place.segment); why != nullptr) {
    AddEvent({.kind = EventKind::kAppendRefused, .text = why});
    return;
  }
  // The segment that was last may have to reach under the new one.
  const std::uint64_t last = state.track.first_segment + on.track.segments.size() - 1;
  box_holds[static_cast<std::size_t>(last) % static_cast<std::size_t>(on.window.boxes)] = 0;
  const std::size_t before = on.track.segments.size();
  terrain::Append(segment, on.track);
  if (on.track.segments.size() == before) ++state.track.first_segment;
  place = terrain::Locate(on.track, body.p_WB.head<2>());
  output.append.added = true;
}

void GaitEngine::Parts::ExtendEndless() {
  if (!on.track.endless) return;
  const auto next =
      terrain::EndlessSegment(on.track, place, body.p_WB.head<2>(), state.track.course);
  if (!next) return;
  const std::size_t before = on.track.segments.size();
  terrain::Add(*next, on.track);
  if (on.track.segments.size() == before) ++state.track.first_segment;
  place = terrain::Locate(on.track, body.p_WB.head<2>());
  output.append.added = true;
}

void GaitEngine::Parts::PlaceGround() {
  if (on.window.boxes == 0) return;
  const int from = std::max(0, place.segment - on.window.behind);
  const int to = std::min(static_cast<int>(on.track.segments.size()),
                          place.segment - on.window.behind + on.window.boxes);
  for (int i = from; i < to; ++i) {
    const std::uint64_t number = state.track.first_segment + static_cast<std::uint64_t>(i);
    const auto slot =
        static_cast<std::size_t>(number % static_cast<std::uint64_t>(on.window.boxes));
    if (box_holds[slot] == number + 1) continue;
    box_holds[slot] = number + 1;
    const int index = static_cast<int>(slot);
    const auto index_on_track = static_cast<std::size_t>(i);
    const terrain::GroundBox box = on.track.segments[index_on_track].pit
                                       ? terrain::WaitingBox(index)
                                       : terrain::BoxOf(on.track, index_on_track);
    on.world.PlaceBox(index, box.centre_W_m, box.q_WS, box.half_size_m);
  }
}

void GaitEngine::Parts::SaveTrack(TrackMemory& memory) const {
  memory = state.track;
  if (!terrain::Grows(on.track)) return;
  memory.first_m = on.track.first_m;
  memory.revision = on.track.revision;
  memory.count = on.track.segments.size();
  std::copy(on.track.segments.begin(), on.track.segments.end(), memory.segments.begin());
}

void GaitEngine::Parts::RestoreTrack() {
  if (!terrain::Grows(on.track)) return;
  const TrackMemory& memory = state.track;
  if (memory.count == 0) {
    on.track.segments.assign(on.first_segments.begin(), on.first_segments.end());
    on.track.revision = 1;
    on.track.first_m = 0;
  } else {
    on.track.segments.assign(memory.segments.begin(),
                             memory.segments.begin() + static_cast<std::ptrdiff_t>(memory.count));
    on.track.revision = memory.revision;
    on.track.first_m = memory.first_m;
  }
  if (!on.track.extendable) return;
  // Boxes of another course may be left anywhere: all wait, then those that are needed come.
  for (int i = 0; i < on.window.boxes; ++i) {
    const terrain::GroundBox box = terrain::WaitingBox(i);
    on.world.PlaceBox(i, box.centre_W_m, box.q_WS, box.half_size_m);
  }
  box_holds = {};
}

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
