#include "clients/study/session/undo.h"

#include <utility>
#include <vector>

#include "clients/study/report/trials.h"

namespace footing::study {
namespace {

constexpr double kCorrectedWithinS = 2;

Result<void> Withdraw(Servers& servers, std::uint64_t number) {
  v1::Command command;
  command.mutable_correct_failure()->set_failure(number);
  command.mutable_correct_failure()->set_reason("undone by the experimenter");
  return servers.Call(std::move(command));
}

std::vector<records::Failure> FailuresOf(const SessionContext& context, const std::string& trial) {
  return records::FailuresOf(records::Collect(context.journal.events()), trial);
}

bool Counts(const SessionContext& context, const std::string& trial, std::uint64_t number) {
  for (const records::Failure& one : FailuresOf(context, trial)) {
    if (one.number == number) return !one.undone;
  }
  return false;
}

}  // namespace

Result<void> UndoFailure(SessionContext& context, Servers& servers, const std::string& trial,
                         std::uint64_t number) {
  const std::string text = "failure " + std::to_string(number);
  if (!Counts(context, trial, number)) {
    context.console.Print(trial + " has no " + text + " that counts");
    return {};
  }
  if (servers.frame().trial.trial != trial) {
    context.console.Print(text + " undone");
    return context.journal.Append(records::EventKind::kFailureUndone,
                                  {{"trial", trial}, {"failure", number}});
  }
  const auto sent = Withdraw(servers, number);
  if (context.console.interrupted()) return Interrupted();
  if (!sent) {
    context.console.Print(sent.error().message);
    return {};
  }
  const Waited waited =
      context.console.RunUntil([&] { return !Counts(context, trial, number); }, kCorrectedWithinS);
  if (waited == Waited::kInterrupted) return Interrupted();
  if (waited == Waited::kTimeUp) {
    context.console.Print("footing-sim has not confirmed the correction of " + text);
  }
  return {};
}

Result<void> UndoNewest(SessionContext& context, Servers& servers, const std::string& trial) {
  const std::vector<records::Failure> failures = FailuresOf(context, trial);
  for (auto one = failures.rbegin(); one != failures.rend(); ++one) {
    if (!one->undone) return UndoFailure(context, servers, trial, one->number);
  }
  context.console.Print("no failure to undo");
  return {};
}

}  // namespace footing::study
