#include "daemon/simulation/gait_service/input_collector.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/stream/roles.h"
#include "common/wire/wire.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::gait_service {
namespace {

using stream::DeviceRole;
using stream::DeviceStatus;
using stream::Extension;
using stream::UserInterface;

/// Bit in a Wiimote's two button bytes, as MotionSample has them.
constexpr std::uint32_t kButtonA = 0x0008;

/// Whether the device can have what the interface reads: a stick of its own, or that of a Nunchuk.
/// One that has not said yet what is plugged in may have it.
bool MayServe(const DeviceStatus& device, UserInterface interface) {
  return interface != UserInterface::kJoystick || device.extension == Extension::kUnspecified ||
         stream::HasStick(device);
}

/// A sample that is used as it is: decoded when it arrived, it then waited for its tick.
FeatureStamps OfSample(std::int64_t received_ns, const rig::Tick& tick) {
  return {0, received_ns, received_ns, tick.host_ns, 0};
}

}  // namespace

Result<std::string> InputCollector::RigFor(const mapping::InterfaceOptions& options) const {
  std::map<std::string, std::uint32_t> roles;  // Roles in each rig.
  const std::string& followed = sensors_.rig();
  if (!followed.empty()) roles[followed] = 0;
  for (const DeviceStatus& device : sensors_.devices()) {
    const bool usable = device.state != stream::DeviceState::kLost;
    if (usable && MayServe(device, options.interface) &&
        (sensors_.wanted_rig().empty() || device.rig == sensors_.wanted_rig())) {
      roles[device.rig] |= stream::RoleBit(device.role);
    }
  }
  const std::uint32_t missing =
      mapping::MissingRoles(options, followed.empty() ? 0 : roles[followed]);
  if (missing == 0) return followed;
  for (const auto& [rig, present] : roles) {
    if (mapping::MissingRoles(options, present) == 0) return rig;
  }
  if (options.interface == UserInterface::kJoystick) {
    return Failure(
        (followed.empty() ? "there is no" : "the rig " + followed + " has no") +
        std::string(" Joy-Con, nor Wiimote with a Nunchuk plugged in, in a hand; connect one, or "
                    "give it the role left_hand or right_hand (footing-ctl assign)"));
  }
  return Failure((followed.empty() ? "there is no " : "the rig " + followed + " lacks ") +
                 stream::RoleNames(missing) +
                 "; connect the devices, or give them these roles (footing-ctl assign)");
}

Result<void> InputCollector::Use(const mapping::InterfaceOptions& options) {
  const Result<std::string> rig = RigFor(options);
  if (!rig) return rig.error();
  options_ = options;
  sensors_.GoTo(*rig, stream::DrivingRoles(options.interface));
  inputs_ = {};
  stamps_ = {};
  if (options_.interface == UserInterface::kJoystick) inputs_.stick.role = StickRole();
  return {};
}

DeviceRole InputCollector::StickRole() const {
  DeviceRole role = sensors_.RoleOf(stick_device_);
  if (role != DeviceRole::kUnspecified) return role;
  int hands = 0;
  for (const DeviceStatus& device : sensors_.devices()) {
    const DeviceRole hand = sensors_.RoleOf(device.device);
    if (hand == DeviceRole::kUnspecified || !MayServe(device, options_.interface)) continue;
    if (stream::HasStick(device)) return hand;
    role = hand;
    ++hands;
  }
  return hands == 1 ? role : DeviceRole::kUnspecified;
}

bool InputCollector::TakeFeatures(const rig::Tick& tick) {
  const stream::RigFeatures* rig = sensors_.FeaturesIn(tick);
  if (rig == nullptr) return false;
  mapping::TakeFeatures(*rig, sensors_.MountedRoles(), inputs_);
  stamps_ = {0, rig->newest_received_ns, rig->decoded_ns, rig->computed_ns, 0};
  return true;
}

/// The stick of the rig's first hand that has one; its Wiimote's buttons come as samples of their
/// own, and each press counts, also when it is over within one tick.
bool InputCollector::TakeStick(const rig::Tick& tick, std::int64_t now_ns) {
  mapping::StickInput& stick = inputs_.stick;
  bool taken = false;
  for (const stream::NunchukSample& sample : tick.nunchuks) {
    const DeviceRole role = sensors_.RoleOf(sample.device);
    if (role == DeviceRole::kUnspecified || (stick.present && sample.device != stick_device_))
      continue;
    stick_device_ = sample.device;
    stick.present = true;
    stick.role = role;
    stick.x = sample.stick_x;
    stick.y = sample.stick_y;
    stick_ = {true, now_ns, sample.simulated};
    stamps_ = OfSample(sample.received_ns, tick);
    taken = true;
  }
  for (const stream::MotionSample& sample : tick.motion) {
    if (!stick.present || sample.device != stick_device_) continue;
    const bool pressed = (sample.buttons & kButtonA) != 0;
    if (pressed && !stick.pressed) ++stick.presses;
    stick.pressed = pressed;
    taken = true;
  }
  return taken;
}

bool InputCollector::TakeBoards(const rig::Tick& tick, std::int64_t now_ns) {
  bool taken = false;
  for (const stream::BoardSample& sample : tick.boards) {
    const DeviceRole role = sensors_.RoleOf(sample.device);
    if (role == DeviceRole::kUnspecified) continue;
    const stream::BoardLayout layout = sensors_.Layout();
    const bool left = role == DeviceRole::kLeftBoard;
    const Eigen::Vector2d cop_W_m =
        board::InWorld(left ? layout.left : layout.right, sample.cop_x_m, sample.cop_y_m);
    (left ? inputs_.left_board : inputs_.right_board) = {
        .present = true,
        .corners_n = {sample.top_left_n, sample.top_right_n, sample.bottom_left_n,
                      sample.bottom_right_n},
        .cop_valid = sample.cop_valid,
        .cop_x_m = cop_W_m.x(),
        .cop_y_m = cop_W_m.y()};
    (left ? left_board_ : right_board_) = {true, now_ns, sample.simulated};
    stamps_ = OfSample(sample.received_ns, tick);
    taken = true;
  }
  return taken;
}

bool InputCollector::Expire(std::int64_t now_ns) {
  bool ended = false;
  const auto expire = [&](const rig::LastHeard& heard, auto& input) {
    if (!input.present || heard.IsLive(now_ns, kTimeoutS)) return;
    input = {};
    ended = true;
  };
  const std::uint64_t presses = inputs_.stick.presses;
  const DeviceRole role = inputs_.stick.role;
  expire(stick_, inputs_.stick);
  inputs_.stick.presses = presses;
  inputs_.stick.role = role;
  expire(left_board_, inputs_.left_board);
  expire(right_board_, inputs_.right_board);
  return ended;
}

bool InputCollector::Take(const v1::Tick& message, std::int64_t now_ns) {
  const rig::Tick tick = wire::SensorTick(message);
  const rig::Changes changes = sensors_.Take(tick);
  if (changes.restarted) stick_device_ = 0;
  if (changes.devices && options_.interface == UserInterface::kJoystick) {
    inputs_.stick.role = StickRole();
  }
  if (tick.snapshot) return false;
  switch (options_.interface) {
    case UserInterface::kUnspecified:
    case UserInterface::kWrist:
    case UserInterface::kArm:
    case UserInterface::kLeg:
      if (TakeFeatures(tick)) {
        features_ = {true, now_ns, false};
        return true;
      }
      if (!features_.IsLive(now_ns, kFeaturesTimeoutS)) inputs_ = {};
      return false;
    case UserInterface::kJoystick:
    case UserInterface::kBoards:
      break;
  }
  const bool taken = options_.interface == UserInterface::kJoystick ? TakeStick(tick, now_ns)
                                                                    : TakeBoards(tick, now_ns);
  const bool ended = Expire(now_ns);
  inputs_.simulated = (inputs_.stick.present && stick_.simulated) ||
                      (inputs_.left_board.present && left_board_.simulated) ||
                      (inputs_.right_board.present && right_board_.simulated);
  return taken || ended;
}

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
    case v1::Command::kSetPoseMode:
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
