#include "daemon/simulation/gait_service/failure_record.h"

#include <utility>

#include "common/wire/scalar.h"
#include "common/wire/wire.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::gait_service {
namespace {

constexpr std::size_t kMaxReason = 200;

}  // namespace

v1::Failure FailureRecord::Add(const engine::EngineEvent& event, const std::string& trial) {
  v1::Failure failure;
  failure.set_number(event.failure_number);
  failure.set_cause(static_cast<v1::FailureCause>(event.cause));
  if (event.in_trial) failure.set_trial(trial);
  failure.set_trial_time_s(event.trial.time_s);
  failure.set_distance_m(event.trial.distance_m);
  failure.set_lateral_offset_m(event.trial.lateral_offset_m);
  failure.set_heading_error_rad(event.trial.heading_error_rad);
  *failure.mutable_position_m() = wire::ToProto(event.p_WC_m);
  entries_[event.failure_number] = {failure, event.trial_number, event.in_trial};
  return failure;
}

Result<void> FailureRecord::Correct(const v1::CorrectFailure& message) {
  const auto found = entries_.find(message.failure());
  if (found == entries_.end()) {
    return UsageError(
        "correct_failure: failure " + std::to_string(message.failure()) + " is unknown" +
        (entries_.empty() ? std::string("; none has happened")
                          : "; the last one is " + std::to_string(entries_.rbegin()->first)));
  }
  v1::Failure& failure = found->second.failure;
  if (failure.withdrawn() != message.restore()) {
    return UsageError("correct_failure: failure " + std::to_string(message.failure()) +
                      (message.restore() ? " counts already" : " is withdrawn already"));
  }
  failure.set_withdrawn(!message.restore());
  CountWithdrawn(found->second);
  std::string text = "failure " + std::to_string(failure.number()) + " (" +
                     stream::Name(static_cast<stream::FailureCause>(failure.cause())) + ") " +
                     (message.restore() ? "restored" : "withdrawn");
  if (!message.reason().empty()) {
    text += ": " + wire::Utf8(message.reason().substr(0, kMaxReason));
  }
  v1::Event event = serving::MakeEvent(v1::Event::KIND_CORRECTION, 0, text);
  event.set_failure_cause(failure.cause());
  *event.mutable_failure() = failure;
  corrections_.push_back(std::move(event));
  return {};
}

std::vector<v1::Event> FailureRecord::TakeCorrections() {
  std::vector<v1::Event> taken;
  taken.swap(corrections_);
  return taken;
}

stream::FailureCounts FailureRecord::WithdrawnOf(std::uint64_t trial_number) const {
  const auto found = withdrawn_of_.find(trial_number);
  return found == withdrawn_of_.end() ? stream::FailureCounts{} : found->second;
}

void FailureRecord::CountWithdrawn(const Entry& entry) {
  const auto cause = static_cast<stream::FailureCause>(entry.failure.cause());
  const auto count = [&](stream::FailureCounts& counts) {
    std::uint64_t* of_cause = stream::MutableCountOf(cause, counts);
    if (of_cause == nullptr) return;
    entry.failure.withdrawn() ? ++*of_cause : --*of_cause;
  };
  count(withdrawn_);
  if (entry.in_trial) count(withdrawn_of_[entry.trial_number]);
}

}  // namespace footing::gait_service
