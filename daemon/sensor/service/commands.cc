#include "daemon/sensor/service/commands.h"

#include <optional>
#include <string>
#include <utility>

#include "common/wire/wire.h"
#include "daemon/sensor/service/hub.h"

namespace footing::sensor {
namespace {

v1::CommandResult CarryOutSetup(Hub& hub, std::uint64_t session, const v1::Command& command) {
  if (command.has_tare()) {
    const v1::Tare& tare = command.tare();
    return AnswerMeasured(command, hub.setup().Tare(tare.serial(), tare.window_s(), tare.clear()));
  }
  if (command.has_solve_mounting()) {
    const v1::SolveMounting& solve = command.solve_mounting();
    if (solve.clear()) return AnswerMeasured(command, hub.setup().ClearMounting(solve.serial()));
    return AnswerMeasured(
        command,
        hub.setup().SolveMounting(solve.serial(), {solve.still_from_ns(), solve.still_to_ns(),
                                                   solve.steps_from_ns(), solve.steps_to_ns()}));
  }
  if (command.has_set_board_layout()) {
    return AnswerMeasured(
        command, hub.setup().SetBoardLayout(wire::FromProto(command.set_board_layout().layout())));
  }
  if (command.has_show_prompt()) {
    const v1::ShowPrompt& show = command.show_prompt();
    return Answer(command, hub.setup().ShowPrompt(
                               session, show.rig(),
                               show.has_prompt() ? std::optional(wire::FromProto(show.prompt()))
                                                 : std::nullopt));
  }
  const v1::RecordSetup& record = command.record_setup();
  return Answer(command, hub.setup().RecordSetup(record.rig(), wire::FromProto(record.item()),
                                                 record.forget()));
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
    case v1::Command::kSetPoseMode:
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
    case v1::Command::kListSessions:  // The server answers these three itself.
    case v1::Command::kEndSessions:
    case v1::Command::kMarker:
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

}  // namespace footing::sensor
