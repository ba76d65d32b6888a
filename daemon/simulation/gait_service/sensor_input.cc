#include "daemon/simulation/gait_service/sensor_input.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/simulation/serving/messages.h"

namespace footing::gait_service {
namespace {

using serving::Answer;

constexpr double kMaxPushNs = 200;

}  // namespace

SensorInput::SensorInput(std::string rig, const mapping::InterfaceOptions& options,
                         exchange::Latest<Inputs>& out, Responses& responses)
    : collector_(std::move(rig), options), out_(out), responses_(responses) {
  inputs_.engine.interface.options = options;
}

void SensorInput::OnTick(const v1::Tick& tick, std::int64_t now_ns) {
  if (tick.refilled()) return;
  const bool taken = collector_.Take(tick, now_ns);
  if (!taken && tick.snapshot()) return;
  inputs_.engine.features = collector_.inputs();
  ++inputs_.engine.features_number;
  inputs_.sensor_epoch = tick.epoch();
  inputs_.sensor_sequence = tick.sequence();
  if (taken) {
    stamps_ = collector_.stamps();
    stamps_.received_ns = now_ns;
  }
  stamps_.number = inputs_.engine.features_number;
  responses_.Received(stamps_);
  Publish();
}

Result<void> SensorInput::SetInterface(const mapping::InterfaceOptions& options,
                                       const mapping::AnyInterface& made) {
  if (const auto fits = collector_.Use(options); !fits) return fits;
  engine::InterfaceInputs& interface = inputs_.engine.interface;
  interface = {interface.number + 1, options, made};
  inputs_.engine.features = collector_.inputs();
  Publish();
  return {};
}

/// The engine takes one segment a step, so those not yet taken wait in the inputs.
v1::CommandResult SensorInput::Append(const v1::AppendSegment& message) {
  const terrain::NewSegment segment{message.length_m(), message.slope_rad(), message.curve_rad(),
                                    message.step_m(), message.pit()};
  for (const double number :
       {segment.length_m, segment.slope_rad, segment.curve_rad, segment.step_m}) {
    if (!std::isfinite(number)) {
      return Answer(false, "append_segment: every number must be finite");
    }
  }
  engine::EngineInputs& engine = inputs_.engine;
  const auto waiting = static_cast<int>(engine.append_number - appends_taken_);
  if (waiting >= engine::kMaxAppends) {
    return Answer(false, "append_segment: 16 segments wait to be taken; try again in a moment");
  }
  std::move(engine.appends.begin() + engine.append_count - waiting,
            engine.appends.begin() + engine.append_count, engine.appends.begin());
  engine.append_count = waiting;
  engine.appends[static_cast<std::size_t>(engine.append_count++)] = segment;
  ++engine.append_number;
  Publish();
  return Answer(true, "");
}

void SensorInput::OnSessionEnd(std::uint64_t session) {
  if (!inputs_.engine.direct || session != direct_session_) return;
  inputs_.engine.direct = false;
  Publish();
}

v1::CommandResult SensorInput::OnCommand(const v1::Command& command, std::uint64_t session) {
  engine::EngineInputs& engine = inputs_.engine;
  switch (command.action_case()) {
    case v1::Command::kDirectGait: {
      const v1::DirectGait& direct = command.direct_gait();
      const double numbers[] = {direct.speed_mps(), direct.height_m(), direct.turn_rad()};
      for (const double number : numbers) {
        if (!std::isfinite(number))
          return Answer(false, "direct_gait: every number must be finite");
      }
      const stream::Gait gait = stream::GaitNumbered(direct.gait());
      if (!direct.release() && gait == stream::Gait::kUnspecified) {
        return Answer(false, "direct_gait: unknown gait; there are: " + stream::GaitNames());
      }
      engine.direct = !direct.release();
      direct_session_ = session;
      engine.direct_command = {gait, direct.speed_mps(), direct.height_m(), direct.turn_rad()};
      break;
    }
    case v1::Command::kPush: {
      const Eigen::Vector2d impulse(command.push().impulse_x_ns(), command.push().impulse_y_ns());
      if (!impulse.allFinite() || impulse.norm() > kMaxPushNs) {
        return Answer(false, "push: the impulse must be at most 200 N s");
      }
      engine.push_impulse_W_ns = impulse;
      ++engine.push_number;
      break;
    }
    case v1::Command::kPutBack:
      ++engine.put_back_number;
      break;
    case v1::Command::kAppendSegment:
      return Append(command.append_segment());
    case v1::Command::kCalibrateTPose:
    case v1::Command::kSetSubject:
      return Answer(false, "that is a command for footing-sim --engine pose; this one runs gait");
    default:
      return Answer(false,
                    "footing-sim --engine gait takes direct_gait, push, put_back, append_segment, "
                    "start_trial, "
                    "stop_trial, correct_failure, set_interface, set_study, set_game, take_lease "
                    "and release_lease");
  }
  Publish();
  return Answer(true, "");
}

}  // namespace footing::gait_service
