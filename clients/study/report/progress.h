#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "clients/study/plan/phases.h"
#include "clients/study/plan/survey_items.h"
#include "clients/study/report/event.h"

namespace footing::study::records {

/// The field of a note that says after how long in motion the participant had a long rest.
inline constexpr const char* kRestedAt = "rested_at_active_s";

/// Where a session stands after its events.
struct Progress {
  bool started = false;
  bool finished = false;
  bool withdrawn = false;
  std::size_t next_phase = 0;  ///< The first one that is not finished; as many as phases: none.
  std::size_t phases_finished = 0;
  std::map<std::string, std::size_t> attempts;  ///< Trials begun, by phase.
  /// The outcome of the last attempt that counts, by phase.
  std::map<std::string, std::string> outcomes;
  double active_s = 0;            ///< How long the participant has been moving.
  double rested_at_s = 0;         ///< The same when they last had a long rest (kRestedAt).
  std::string interrupted_trial;  ///< Without an end, or with kInterrupted; empty: none.
};

Progress Replay(const std::vector<plan::Phase>& phases, const std::vector<Event>& events);

/// The items of a survey that have no answer yet, in their order: an interrupted survey goes on
/// with them.
std::vector<plan::SurveyItem> Unanswered(const std::vector<plan::SurveyItem>& items,
                                         const std::vector<Event>& events);

/// The line for a person: "P07 stopped in wrist.test, attempt 2".
std::string Describe(const Progress& progress, const plan::Session& session);

}  // namespace footing::study::records
