#include "daemon/simulation/gait_service/failure_record.h"

#include <algorithm>

#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::gait_service {
namespace {

constexpr std::size_t kMaxReason = 200;

void SubtractOne(v1::FailureCause cause, v1::FailureCounts& message) {
  stream::FailureCounts counts = wire::FromProto(message);
  std::uint64_t* count = stream::MutableCountOf(static_cast<stream::FailureCause>(cause), counts);
  if (count != nullptr && *count > 0) --*count;
  message = wire::ToProto(counts);
}

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
    return UsageError("correct_failure: there is no failure " + std::to_string(message.failure()) +
                      (entries_.empty()
                           ? std::string("; none has happened")
                           : "; the last one is " + std::to_string(entries_.rbegin()->first)));
  }
  v1::Failure& failure = found->second.failure;
  if (failure.withdrawn() != message.restore()) {
    return UsageError("correct_failure: failure " + std::to_string(message.failure()) +
                      (message.restore() ? " counts already" : " is withdrawn already"));
  }
  failure.set_withdrawn(!message.restore());
  v1::Event event;
  event.set_kind(v1::Event::KIND_CORRECTION);
  event.set_failure_cause(failure.cause());
  *event.mutable_failure() = failure;
  std::string text = "failure " + std::to_string(failure.number()) + " (" +
                     stream::Name(static_cast<stream::FailureCause>(failure.cause())) + ") " +
                     (message.restore() ? "restored" : "withdrawn");
  if (!message.reason().empty()) {
    text += ": " + wire::Utf8(message.reason().substr(0, kMaxReason));
  }
  event.set_text(text);
  corrections_.push_back(event);
  return {};
}

std::vector<v1::Event> FailureRecord::TakeCorrections() {
  std::vector<v1::Event> taken;
  taken.swap(corrections_);
  return taken;
}

void FailureRecord::Subtract(v1::FailureCounts& counts) const {
  for (const auto& [number, entry] : entries_) {
    if (entry.failure.withdrawn()) SubtractOne(entry.failure.cause(), counts);
  }
}

void FailureRecord::Subtract(std::uint64_t trial_number, v1::FailureCounts& counts) const {
  for (const auto& [number, entry] : entries_) {
    const bool counted = entry.in_trial && entry.trial_number == trial_number;
    if (counted && entry.failure.withdrawn()) SubtractOne(entry.failure.cause(), counts);
  }
}

std::uint64_t FailureRecord::Withdrawn(std::uint64_t trial_number) const {
  return static_cast<std::uint64_t>(
      std::count_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
        return entry.second.in_trial && entry.second.trial_number == trial_number &&
               entry.second.failure.withdrawn();
      }));
}

}  // namespace footing::gait_service
