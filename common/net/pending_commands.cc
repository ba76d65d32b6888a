#include "common/net/pending_commands.h"

#include <utility>

#include "common/net/answers.h"
#include "common/base/time.h"

namespace footing::transport {
namespace {

constexpr std::size_t kMaxWaitingCommands = 64;

v1::CommandResult FailedCommand(std::uint64_t id, const std::string& why) {
  v1::CommandResult result;
  result.set_id(id);
  result.set_message(why);
  return result;
}

}  // namespace

std::optional<v1::Command> PendingCommands::Add(v1::Command command, const Done& done,
                                                std::int64_t now_ns) {
  command.set_id(++last_id_);
  if (waiting_.size() >= kMaxWaitingCommands) {
    done(FailedCommand(command.id(), "too many commands wait for their answers"));
    return std::nullopt;
  }
  const std::uint32_t deadline_ms =
      command.deadline_ms() == 0 ? kDefaultDeadlineMs : command.deadline_ms();
  waiting_[command.id()] = {done, now_ns + std::int64_t{deadline_ms} * kNanosecondsPerMillisecond};
  return command;
}

void PendingCommands::Refuse(const Done& done, const std::string& why) {
  done(FailedCommand(++last_id_, why));
}

void PendingCommands::TakeAnswer(const v1::CommandResult& answer) {
  const auto found = waiting_.find(answer.id());
  if (found == waiting_.end()) return;
  const Done done = std::move(found->second.done);
  waiting_.erase(found);
  done(answer);
}

void PendingCommands::Expire(std::int64_t now_ns) {
  for (auto next = waiting_.begin(); next != waiting_.end();) {
    const auto one = next++;
    if (now_ns < one->second.deadline_ns) continue;
    const Done done = std::move(one->second.done);
    const std::uint64_t id = one->first;
    waiting_.erase(one);
    done(FailedCommand(id, "no answer within its deadline; it may still be carried out"));
  }
}

void PendingCommands::Fail(const std::string& why) {
  const auto waiting = std::exchange(waiting_, {});
  for (const auto& [id, one] : waiting) one.done(FailedCommand(id, why));
}

}  // namespace footing::transport
