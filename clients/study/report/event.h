#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/study/plan/phases.h"
#include "clients/study/plan/protocol.h"
#include "common/base/result.h"

/// Events of a session's journal: one JSON object a line, in the order in which they happened. A
/// wrong event is never changed but corrected by a further one; the state of a session is what its
/// events add up to.
namespace footing::study::records {

/// Kinds of a journal's events.
enum class EventKind {
  kSessionStarted,
  kSessionResumed,
  kSessionFinished,
  kWithdrawn,
  kPhaseStarted,
  kPhaseFinished,
  kTrialStarted,
  kTrialFinished,
  kFailure,
  kFailureUndone,
  kFailureRestored,
  kRating,
  kAnswer,
  kExertion,
  kNote,
  kResponse,
  kRanges,  ///< The mapping table that an interface has from here on.
};

const char* Name(EventKind kind);

/// One line. `fields` are those of its kind; docs/studies.md lists them.
struct Event {
  EventKind kind = EventKind::kNote;
  std::uint64_t number = 0;  ///< From 1, without gaps.
  std::int64_t wall_ns = 0;  ///< UNIX time.
  nlohmann::ordered_json fields = nlohmann::ordered_json::object();

  /// A field, or the default where it is missing or of another type.
  std::string Text(const char* key) const;
  double Number(const char* key, double otherwise = 0) const;
  bool Flag(const char* key) const;
};

/// JSON line of an event, without the end of the line.
std::string ToLine(const Event& event);
/// InvalidData when the line is not an event.
Result<Event> ParseLine(std::string_view line);

/// A journal as read from its file.
struct JournalText {
  std::vector<Event> events;
  std::size_t whole_bytes = 0;  ///< Size of the whole lines; a torn line may follow.
  std::size_t torn_bytes = 0;
};

/// All events of a journal. A last line without its end is torn: the program was killed while it
/// wrote. It is dropped and counted. Any other line that is not an event, or whose number is not
/// the next one, is InvalidData with `file` and line.
Result<JournalText> ParseJournal(std::string_view text, const std::string& file);

/// Time that a participant has been moving, from a journal. A phase's time holds that of its
/// trials; of a phase that was interrupted the trials that ended count.
class ActiveTally {
 public:
  /// Every event, in their order.
  void Add(const Event& event);

  /// Time in motion by interface, s; phases without an interface have an empty name.
  std::map<std::string, double> by_interface() const;
  double total_s() const;

 private:
  std::map<std::string, double> by_interface_;
  std::string interface_;   ///< Interface of the current phase.
  double of_trials_s_ = 0;  ///< Duration of the trials that ended in it.
};

/// The field of a note that says after how long in motion the participant had a long rest.
inline constexpr const char* kRestedAt = "rested_at_active_s";

/// Progress of a session after its events.
struct Progress {
  bool started = false;
  bool finished = false;
  bool withdrawn = false;
  std::size_t next_phase = 0;  ///< The first one that is not finished; as many as phases: none.
  std::map<std::string, std::size_t> attempts;  ///< Trials begun, by phase.
  /// The outcome of the last attempt that counts, by phase.
  std::map<std::string, std::string> outcomes;
  double active_s = 0;            ///< How long the participant has been moving.
  double rested_at_s = 0;         ///< The same when they last had a long rest (kRestedAt).
  std::string interrupted_trial;  ///< Trial without an end, or kInterrupted; empty: none.
};

/// Progress after all events of a session with these phases.
Progress Replay(const std::vector<plan::Phase>& phases, const std::vector<Event>& events);

/// The items of a survey that have no answer yet, in their order: an interrupted survey goes on
/// with them.
std::vector<plan::SurveyItem> Unanswered(const std::vector<plan::SurveyItem>& items,
                                         const std::vector<Event>& events);

/// The line for a person: "P07 stopped in wrist.test, attempt 2".
std::string Describe(const Progress& progress, const plan::SessionPlan& session);

}  // namespace footing::study::records
