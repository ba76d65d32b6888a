#include "daemon/simulation/gait_service/lease_control.h"

#include "common/result/result.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::gait_service {
namespace {

/// The name of a command that needs the lease; null: it needs none.
const char* Forbidden(const v1::Command& command) {
  if (command.has_start_trial()) return "start_trial";
  if (command.has_stop_trial()) return "stop_trial";
  if (command.has_correct_failure()) return "correct_failure";
  if (command.has_set_interface()) return "set_interface";
  if (command.has_set_study()) return "set_study";
  if (command.has_put_back()) return "put_back";
  return nullptr;
}

v1::CommandResult ToResult(const std::string& command, const Result<void>& done) {
  return serving::Answer(done.ok(), done ? "" : command + ": " + done.error().message);
}

}  // namespace

bool LeaseControl::Takes(const v1::Command& command) {
  return command.has_take_lease() || command.has_release_lease();
}

v1::CommandResult LeaseControl::OnCommand(const v1::Command& command, std::uint64_t session,
                                          std::int64_t now_ns) {
  if (command.has_release_lease()) {
    return ToResult("release_lease", lease_.Release(session, now_ns));
  }
  const v1::TakeLease& take = command.take_lease();
  return ToResult("take_lease", lease_.Take({.session = session,
                                             .holder = take.holder(),
                                             .seconds = take.seconds(),
                                             .take_over = take.take_over(),
                                             .renew_only = take.renew_only()},
                                            now_ns));
}

std::optional<v1::CommandResult> LeaseControl::Refusal(const v1::Command& command,
                                                       std::uint64_t session,
                                                       std::int64_t now_ns) const {
  const char* name = Forbidden(command);
  if (name == nullptr) return std::nullopt;
  const Result<void> allowed = lease_.Check(session, now_ns);
  if (allowed) return std::nullopt;
  return ToResult(name, allowed);
}

std::vector<v1::Event> LeaseControl::TakeEvents(std::int64_t now_ns) {
  lease_.Expire(now_ns);
  std::vector<v1::Event> events;
  for (const std::string& change : lease_.TakeChanges()) {
    events.push_back(serving::MakeEvent(v1::Event::KIND_LEASE, now_ns, change));
  }
  return events;
}

}  // namespace footing::gait_service
