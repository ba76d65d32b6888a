#include "clients/study/report/event.h"

#include "common/base/json_text.h"

#include <array>
#include <optional>

namespace footing::study::records {
namespace {

using nlohmann::ordered_json;

/// In the order of EventKind.
constexpr std::array kNames{
    "session_started",  "session_resumed", "session_finished", "withdrawn", "phase_started",
    "phase_finished",   "trial_started",   "trial_finished",   "failure",   "failure_undone",
    "failure_restored", "rating",          "answer",           "exertion",  "note",
    "response",         "ranges"};

std::optional<EventKind> KindNamed(const std::string& name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i]) return static_cast<EventKind>(i);
  }
  return std::nullopt;
}

/// The numbers that events have where they have them; null where one is not known.
constexpr std::array kNumbers{"active_s",
                              "anticipation_s",
                              "attempt",
                              "distance_m",
                              "failure",
                              "heading_oscillation_rad",
                              "rested_at_active_s",
                              "time_s",
                              "trial_time_s",
                              "wall_s"};

struct Required {
  EventKind kind;
  const char* key;
  bool is_number;
};
constexpr Required kRequired[] = {
    {EventKind::kTrialStarted, "trial", false}, {EventKind::kTrialFinished, "outcome", false},
    {EventKind::kFailure, "failure", true},     {EventKind::kFailure, "kind", false},
    {EventKind::kRating, "item", false},        {EventKind::kRating, "value", true},
    {EventKind::kExertion, "value", true}};

/// What of an event's fields is missing or of another type; a value that is read as 0 instead would
/// become a result.
std::string ProblemOf(const Event& event) {
  for (const char* key : kNumbers) {
    const auto found = event.fields.find(key);
    if (found == event.fields.end() || found->is_null() || found->is_number()) continue;
    return std::string(key) + " must be a number";
  }
  for (const Required& one : kRequired) {
    if (one.kind != event.kind) continue;
    const auto found = event.fields.find(one.key);
    if (found == event.fields.end()) return std::string("without ") + one.key;
    if (one.is_number ? !found->is_number() : !found->is_string()) {
      return std::string(one.key) + " must be a " + (one.is_number ? "number" : "text");
    }
  }
  const std::string outcome = event.kind == EventKind::kTrialFinished ? event.Text("outcome") : "";
  if (outcome != "finished" && outcome != "timed_out") return "";
  const auto time = event.fields.find("time_s");
  return time != event.fields.end() && time->is_number() ? "" : "without time_s";
}

}  // namespace

const char* Name(EventKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

std::string Event::Text(const char* key) const {
  const auto found = fields.find(key);
  return found != fields.end() && found->is_string() ? found->get<std::string>() : "";
}

double Event::Number(const char* key, double otherwise) const {
  const auto found = fields.find(key);
  return found != fields.end() && found->is_number() ? found->get<double>() : otherwise;
}

bool Event::Flag(const char* key) const {
  const auto found = fields.find(key);
  return found != fields.end() && found->is_boolean() && found->get<bool>();
}

std::string ToLine(const Event& event) {
  ordered_json line = {
      {"number", event.number}, {"wall_ns", event.wall_ns}, {"event", Name(event.kind)}};
  line.update(event.fields);
  return text::ToText(line);
}

Result<Event> ParseLine(std::string_view line) {
  ordered_json object = ordered_json::parse(line, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) return InvalidData("not a JSON object");
  for (const char* key : {"number", "wall_ns"}) {
    if (!object.contains(key) || !object[key].is_number_integer()) {
      return InvalidData(std::string("without ") + key);
    }
  }
  if (!object.contains("event") || !object["event"].is_string()) {
    return InvalidData("without event");
  }
  const std::string name = object["event"];
  const auto kind = KindNamed(name);
  if (!kind) return InvalidData("unknown event \"" + name + "\"");
  Event event;
  event.kind = *kind;
  event.number = object["number"];
  event.wall_ns = object["wall_ns"];
  for (const char* key : {"number", "wall_ns", "event"}) object.erase(key);
  event.fields = std::move(object);
  if (const std::string problem = ProblemOf(event); !problem.empty()) {
    return InvalidData(name + ": " + problem);
  }
  return event;
}

Result<JournalText> ParseJournal(std::string_view text, const std::string& file) {
  JournalText journal;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) {
      journal.torn_bytes = text.size();
      break;
    }
    const std::size_t number = journal.events.size() + 1;
    auto event = ParseLine(text.substr(0, end));
    const auto fault = [&](const std::string& what) {
      return InvalidData(file + ", line " + std::to_string(number) + ": " + what);
    };
    if (!event) return fault(event.error().message);
    if (event->number != number) return fault("its number is " + std::to_string(event->number));
    journal.events.push_back(std::move(event).value());
    journal.whole_bytes += end + 1;
    text.remove_prefix(end + 1);
  }
  return journal;
}

}  // namespace footing::study::records
