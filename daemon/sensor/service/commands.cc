#include "daemon/sensor/service/commands.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "common/base/units.h"
#include "common/wire/wire.h"
#include "daemon/sensor/service/hub.h"

namespace footing::sensor {
namespace {

v1::CommandResult CarryOutSetup(Hub& hub, std::uint64_t session, const v1::Command& command) {
  if (command.has_tare()) {
    const v1::Tare& tare = command.tare();
    return AnswerMeasured(command, hub.Tare(tare.serial(), tare.window_s(), tare.clear()));
  }
  if (command.has_solve_mounting()) {
    const v1::SolveMounting& solve = command.solve_mounting();
    if (solve.clear()) return AnswerMeasured(command, hub.ClearMounting(solve.serial()));
    return AnswerMeasured(
        command, hub.SolveMounting(solve.serial(), {solve.still_from_ns(), solve.still_to_ns(),
                                                    solve.steps_from_ns(), solve.steps_to_ns()}));
  }
  if (command.has_set_board_layout()) {
    return AnswerMeasured(command,
                          hub.SetBoardLayout(wire::FromProto(command.set_board_layout().layout())));
  }
  if (command.has_show_prompt()) {
    const v1::ShowPrompt& show = command.show_prompt();
    return Answer(command,
                  hub.ShowPrompt(session, show.rig(),
                                 show.has_prompt() ? std::optional(wire::FromProto(show.prompt()))
                                                   : std::nullopt));
  }
  const v1::RecordSetup& record = command.record_setup();
  return Answer(command,
                hub.RecordSetup(record.rig(), wire::FromProto(record.item()), record.forget()));
}

Result<void> AssignRole(Hub& hub, const Config& config, const v1::AssignRole& assign) {
  if (!v1::DeviceRole_IsValid(assign.role())) {
    return UsageError("assign_role has the unknown role " + std::to_string(assign.role()) +
                      "; there are " + stream::RoleNames());
  }
  return hub.AssignRole(assign.serial(), {assign.rig().empty() ? config.default_rig : assign.rig(),
                                          static_cast<stream::DeviceRole>(assign.role())});
}

v1::CommandResult CarryOutAllowed(Hub& hub, const Config& config, std::uint64_t session,
                                  const v1::Command& command) {
  switch (command.action_case()) {
    case v1::Command::kSetRumble: {
      const v1::SetRumble& rumble = command.set_rumble();
      return Answer(command,
                    hub.SetRumble(session, rumble.device(), rumble.on(), rumble.lease_ms() * 1e-3));
    }
    case v1::Command::kSetLeds:
      return Answer(command, hub.SetLeds(command.set_leds().device(),
                                         static_cast<std::uint8_t>(command.set_leds().leds())));
    case v1::Command::kAssignRole:
      return Answer(command, AssignRole(hub, config, command.assign_role()));
    case v1::Command::kSetSphere:
      return Answer(command,
                    hub.SetSphere(command.set_sphere().device(), command.set_sphere().rgb()));
    case v1::Command::kSetCamera:
      return Answer(command,
                    hub.SetCamera(command.set_camera().device(), command.set_camera().on()));
    case v1::Command::kRequestDeviceStatus:
      return Answer(command, hub.RequestDeviceStatus(command.request_device_status().device()));
    case v1::Command::kPutBack:
    case v1::Command::kPush:
    case v1::Command::kDirectGait:
    case v1::Command::kAppendSegment:
    case v1::Command::kCalibrateTPose:
    case v1::Command::kSetSubject:
    case v1::Command::kStartTrial:
    case v1::Command::kStopTrial:
    case v1::Command::kCorrectFailure:
    case v1::Command::kSetInterface:
    case v1::Command::kSetStudy:
    case v1::Command::kSetGame:
      return Answer(command, UsageError("that is a command for footing-sim"));
    case v1::Command::kTare:
    case v1::Command::kSolveMounting:
    case v1::Command::kSetBoardLayout:
    case v1::Command::kRecordSetup:
    case v1::Command::kShowPrompt:
      return CarryOutSetup(hub, session, command);
    case v1::Command::kTakeLease:
    case v1::Command::kReleaseLease:
    case v1::Command::kListSessions:  // The server answers these two itself.
    case v1::Command::kEndSessions:
    case v1::Command::ACTION_NOT_SET:
      return Answer(command, UsageError("the command has no action that footingd knows"));
  }
  return Answer(command, UsageError("the command has no action that footingd knows"));
}

}  // namespace

v1::CommandResult CarryOut(Hub& hub, lease::LeaseControl& lease, const Config& config,
                           std::uint64_t session, const v1::Command& command, std::int64_t now_ns) {
  if (auto answer = lease.Answer(command, session, now_ns)) {
    answer->set_id(command.id());
    return std::move(*answer);
  }
  return CarryOutAllowed(hub, config, session, command);
}

// Commands to one device, and the leases of motors.
namespace {

constexpr double kDefaultLeaseS = 1;
constexpr double kMaxLeaseS = 10;

}  // namespace

void Hub::EndLeases(std::int64_t now_ns) {
  for (auto it = leases_.begin(); it != leases_.end();) {
    if (now_ns < it->second.until_ns) {
      ++it;
      continue;
    }
    if (Device* device = Numbered(it->first)) device->outbox().SetRumble(false);
    it = leases_.erase(it);
  }
}

Result<Device*> Hub::Attached(std::uint32_t number) {
  Device* found = Numbered(number);
  if (found == nullptr || !found->attached()) {
    return NoDevice("device " + std::to_string(number) + " is not attached");
  }
  return found;
}

Result<void> Hub::SetRumble(std::uint64_t session, std::uint32_t device, bool on, double lease_s) {
  const auto attached = Attached(device);
  if (!attached) return attached.error();
  Device* const found = *attached;
  found->outbox().SetRumble(on);
  status_due_ = true;
  if (!on) {
    leases_.erase(device);
  } else {
    const double granted_s = lease_s > 0 ? std::min(lease_s, kMaxLeaseS) : kDefaultLeaseS;
    leases_[device] = {session, ports_.now_ns() + SecondsToNanoseconds(granted_s)};
  }
  Flush(*found);
  return {};
}

Result<void> Hub::SetLeds(std::uint32_t device, std::uint8_t leds) {
  const auto found = Attached(device);
  if (!found) return found.error();
  (*found)->SetLeds(leds);
  status_due_ = true;
  Flush(**found);
  return {};
}

Result<void> Hub::SetSphere(std::uint32_t device, std::uint32_t rgb) {
  const auto found = Attached(device);
  if (!found) return found.error();
  if (!(*found)->SetSphere(rgb)) {
    return UsageError("device " + std::to_string(device) + " has no sphere");
  }
  status_due_ = true;
  Flush(**found);
  return {};
}

Result<void> Hub::SetCamera(std::uint32_t device, bool on) {
  const auto found = Attached(device);
  if (!found) return found.error();
  if (!(*found)->SetCamera(on)) {
    return UsageError("device " + std::to_string(device) + " has no camera");
  }
  return {};
}

Result<void> Hub::RequestDeviceStatus(std::uint32_t device) {
  const auto found = Attached(device);
  if (!found) return found.error();
  if (!(*found)->RequestStatus(ports_.now_ns())) {
    return UsageError("device " + std::to_string(device) +
                      " was asked less than a second ago, or has no status report");
  }
  return {};
}

void Hub::EndSession(std::uint64_t session) {
  const auto is_its = [session](const auto& one) { return one.second.session == session; };
  if (std::erase_if(prompts_, is_its) > 0) content_.has_setup = true;
  for (auto it = leases_.begin(); it != leases_.end();) {
    if (it->second.session != session) {
      ++it;
      continue;
    }
    if (Device* device = Numbered(it->first)) device->outbox().SetRumble(false);
    it = leases_.erase(it);
  }
}

void Hub::StopMotors() {
  for (const auto& device : devices_) {
    if (!device->attached() || !device->outbox().rumble()) continue;
    device->outbox().SetRumble(false);
    ports_.send(device->handle(), device->MotorOff());
  }
}

}  // namespace footing::sensor
