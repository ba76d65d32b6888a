#include "common/net/lease_control.h"

#include "common/base/result.h"

namespace footing::lease {
namespace {

/// The name of a command that needs the lease while somebody has it; null: it needs none.
const char* Guarded(const v1::Command& command) {
  switch (command.action_case()) {
    case v1::Command::kSetRumble:
      return "set_rumble";
    case v1::Command::kSetLeds:
      return "set_leds";
    case v1::Command::kSetSphere:
      return "set_sphere";
    case v1::Command::kSetCamera:
      return "set_camera";
    case v1::Command::kAssignRole:
      return "assign_role";
    case v1::Command::kTare:
      return "tare";
    case v1::Command::kSolveMounting:
      return "solve_mounting";
    case v1::Command::kSetBoardLayout:
      return "set_board_layout";
    case v1::Command::kRecordSetup:
      return "record_setup";
    case v1::Command::kShowPrompt:
      return "show_prompt";
    case v1::Command::kPutBack:
      return "put_back";
    case v1::Command::kPush:
      return "push";
    case v1::Command::kDirectGait:
      return "direct_gait";
    case v1::Command::kAppendSegment:
      return "append_segment";
    case v1::Command::kCalibrateTPose:
      return "calibrate_t_pose";
    case v1::Command::kSetSubject:
      return "set_subject";
    case v1::Command::kStartTrial:
      return "start_trial";
    case v1::Command::kStopTrial:
      return "stop_trial";
    case v1::Command::kCorrectFailure:
      return "correct_failure";
    case v1::Command::kSetInterface:
      return "set_interface";
    case v1::Command::kSetStudy:
      return "set_study";
    case v1::Command::kSetGame:
      return "set_game";
    case v1::Command::kRequestDeviceStatus:
    case v1::Command::kTakeLease:
    case v1::Command::kReleaseLease:
    case v1::Command::kListSessions:
    case v1::Command::kEndSessions:
    case v1::Command::ACTION_NOT_SET:
      break;
  }
  return nullptr;
}

v1::CommandResult ToResult(const std::string& command, const Result<void>& done) {
  v1::CommandResult result;
  result.set_ok(done.ok());
  if (!done) result.set_message(command + ": " + done.error().message);
  return result;
}

}  // namespace

std::optional<v1::CommandResult> LeaseControl::Answer(const v1::Command& command,
                                                      std::uint64_t session, std::int64_t now_ns) {
  if (command.has_release_lease()) {
    return ToResult("release_lease", lease_.Release(session, now_ns));
  }
  if (command.has_take_lease()) {
    const v1::TakeLease& take = command.take_lease();
    return ToResult("take_lease", lease_.Take({.session = session,
                                               .holder = take.holder(),
                                               .seconds = take.seconds(),
                                               .take_over = take.take_over(),
                                               .renew_only = take.renew_only()},
                                              now_ns));
  }
  const char* const name = Guarded(command);
  if (name == nullptr) return std::nullopt;
  const Result<void> allowed = lease_.Check(session, now_ns);
  return allowed ? std::nullopt : std::optional(ToResult(name, allowed));
}

std::vector<std::string> LeaseControl::TakeChanges(std::int64_t now_ns) {
  lease_.Expire(now_ns);
  return lease_.TakeChanges();
}

}  // namespace footing::lease
