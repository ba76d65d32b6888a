#include "common/net/lease.h"

#include <utility>

#include "common/base/result.h"
#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::lease {
namespace {

bool IsName(const std::string& holder) {
  return !holder.empty() && holder.size() <= Lease::kMaxHolder && text::IsPrintable(holder);
}

}  // namespace

Error Lease::HeldByError() const {
  const std::string of = server_ == "footing-sim" ? "" : " --of " + server_;
  return Failure(holder_ + " has the lease of this " + server_ +
                 "; wait until that ends, or take it over: footing-ctl lease" + of +
                 " --take-over");
}

bool Lease::HeldBy(std::uint64_t session, std::int64_t now_ns) const {
  return !holder_.empty() && now_ns < end_ns_ && session == session_ && !session_ended_;
}

bool Lease::HeldByOther(std::uint64_t session, std::int64_t now_ns) const {
  return !holder_.empty() && now_ns < end_ns_ && (session != session_ || session_ended_);
}

Result<void> Lease::Take(const Request& request, std::int64_t now_ns) {
  if (!IsName(request.holder)) {
    return UsageError("the holder must be 1 to 200 bytes without control characters");
  }
  if (!(request.seconds >= 0 && request.seconds <= kLongestS)) {
    return UsageError("seconds must be from 0 to 60");
  }
  Expire(now_ns);
  const bool mine = HeldBy(request.session, now_ns);
  // Nobody took it since its last holder, who was only late.
  const bool late = holder_.empty() && request.session == session_ && !session_ended_;
  if (request.renew_only && !mine && !late) {
    if (!holder_.empty()) return HeldByError();
    return Failure("this session does not have the lease any more: it ran out, or was taken over");
  }
  const bool goes_on = session_ended_ && request.holder == holder_;
  if (HeldByOther(request.session, now_ns) && !goes_on && !request.take_over) {
    return HeldByError();
  }
  if (holder_.empty()) {
    changes_.push_back("lease: " + request.holder + " takes it");
  } else if (!mine && !goes_on) {
    changes_.push_back("lease: " + request.holder + " takes it over from " + holder_);
  }
  holder_ = request.holder;
  session_ = request.session;
  session_ended_ = false;
  end_ns_ = now_ns + SecondsToNanoseconds(request.seconds > 0 ? request.seconds : kUsualS);
  return {};
}

Result<void> Lease::Release(std::uint64_t session, std::int64_t now_ns) {
  Expire(now_ns);
  if (HeldByOther(session, now_ns)) return HeldByError();
  if (holder_.empty()) return Failure("nobody has the lease of this " + server_);
  End("lease: " + holder_ + " releases it");
  session_ = 0;
  return {};
}

Result<void> Lease::Check(std::uint64_t session, std::int64_t now_ns) const {
  if (HeldByOther(session, now_ns)) return HeldByError();
  return {};
}

void Lease::EndSession(std::uint64_t session) {
  session_ended_ = session_ended_ || session == session_;
}

void Lease::Expire(std::int64_t now_ns) {
  if (!holder_.empty() && now_ns >= end_ns_) End("lease: that of " + holder_ + " ran out");
}

void Lease::End(const std::string& change) {
  changes_.push_back(change);
  holder_.clear();
}

std::vector<std::string> Lease::TakeChanges() { return std::exchange(changes_, {}); }

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
    case v1::Command::kSetPoseMode:
      return "set_pose_mode";
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
    case v1::Command::kMarker:
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
