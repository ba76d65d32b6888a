#include "daemon/simulation/engine/parts.h"

#include <algorithm>
#include <cmath>

#include "daemon/simulation/biped/limits.h"
#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/biped/endless.h"
#include "daemon/simulation/biped/track.h"

namespace footing::engine {
namespace {

constexpr double kPushDurationS = 0.1;
constexpr double kLargestPushNs = 1000;

}  // namespace

void GaitEngine::Parts::AddEvent(const EngineEvent& event) {
  FOOTING_CHECK(output.event_count < kMaxEvents);
  EngineEvent& added = output.events[static_cast<std::size_t>(output.event_count++)];
  added = event;
  added.trial_number = state.inputs.trial_number;
}

void GaitEngine::Parts::Stand(const Eigen::Vector3d& p_W_m, double heading_rad) {
  const double leg_m = gait::StandingLength(biped, gain_table.At(stream::Gait::kStep, 0));
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
    // Of a character that lies there it is only the end of its failure, a moment earlier.
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

void GaitEngine::Parts::ChooseGains() {
  const stream::Gait gait = state.gait.transition.thrusting ? stream::Gait::kRun : state.gait.gait;
  const double speed_mps = state.gait.speed.desired_mps;
  if (gait == gains_gait && speed_mps == gains_speed_mps) return;
  gains = gain_table.At(gait, speed_mps);
  gains_gait = gait;
  gains_speed_mps = speed_mps;
}

void GaitEngine::Parts::StepWorld() {
  ChooseGains();
  output.joint_efforts = {};
  if (!state.fallen) {  // A fallen character is limp.
    output.joint_efforts =
        gait::Advance(body, biped, gains, state.command, Sight(), config.step_s, state.gait);
  }
  output.push_W_n.setZero();
  if (state.inputs.push_steps_left > 0) {
    --state.inputs.push_steps_left;
    output.push_W_n = state.inputs.push_W_n;
  }
  const Eigen::Vector3d p_WC = body.p_WC;
  on.world.Step(output.joint_efforts, output.push_W_n);
  ++state.step;
  ReadBody();
  const double c = std::cos(state.gait.heading_rad), s = std::sin(state.gait.heading_rad);
  const Eigen::Vector3d moved = body.p_WC - p_WC;
  if (on.track.endless) terrain::FollowCourse(moved.head<2>(), state.track.course);
  state.distance_m += c * moved.x() + s * moved.y();
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

}  // namespace footing::engine
