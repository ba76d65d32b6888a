#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

/// What a session's journal says: one JSON object a line, in the order in which it happened. What
/// is wrong is never changed but corrected by a further event; the state of a session is what its
/// events add up to.
namespace footing::study::records {

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

/// Without the end of the line.
std::string ToLine(const Event& event);
/// InvalidData when the line is not an event.
Result<Event> ParseLine(std::string_view line);

struct JournalText {
  std::vector<Event> events;
  std::size_t whole_bytes = 0;  ///< Of the lines read: what follows is a torn line.
  std::size_t torn_bytes = 0;
};

/// All events of a journal. A last line without its end is torn: the program was killed while it
/// wrote. It is dropped and counted. Any other line that is not an event, or whose number is not
/// the next one, is InvalidData with `file` and line.
Result<JournalText> ParseJournal(std::string_view text, const std::string& file);

}  // namespace footing::study::records
