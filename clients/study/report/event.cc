#include "clients/study/report/event.h"

#include <array>
#include <optional>
#include <set>

#include "clients/study/report/trials.h"
#include "common/base/json_text.h"

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

/// Fields of an event that are missing or of another type; a value that is read as 0 instead would
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

void ActiveTally::Add(const Event& event) {
  if (event.kind == EventKind::kPhaseStarted) {
    by_interface_ = by_interface();
    interface_ = event.Text("interface");
    of_trials_s_ = 0;
  } else if (event.kind == EventKind::kTrialFinished) {
    of_trials_s_ += event.Number("active_s");
  } else if (event.kind == EventKind::kPhaseFinished) {
    by_interface_[event.Text("interface")] += event.Number("active_s");
    of_trials_s_ = 0;
  }
}

std::map<std::string, double> ActiveTally::by_interface() const {
  std::map<std::string, double> all = by_interface_;
  if (of_trials_s_ > 0) all[interface_] += of_trials_s_;
  return all;
}

double ActiveTally::total_s() const {
  double total_s = 0;
  for (const auto& [interface, active_s] : by_interface()) total_s += active_s;
  return total_s;
}

namespace {

/// Scale of a survey's event; nothing for any other event.
std::optional<plan::SurveyScale> ScaleOf(EventKind kind) {
  if (kind == EventKind::kRating) return plan::SurveyScale::kRating;
  if (kind == EventKind::kExertion) return plan::SurveyScale::kExertion;
  if (kind == EventKind::kAnswer) return plan::SurveyScale::kText;
  return std::nullopt;
}

}  // namespace

Progress Replay(const std::vector<plan::Phase>& phases, const std::vector<Event>& events) {
  Progress progress;
  std::set<std::string> finished;
  std::string phase_of_trial;
  ActiveTally active;
  for (const Event& event : events) {
    active.Add(event);
    switch (event.kind) {
      case EventKind::kSessionStarted:
        progress.started = true;
        break;
      case EventKind::kSessionFinished:
        progress.finished = true;
        break;
      case EventKind::kWithdrawn:
        progress.withdrawn = true;
        break;
      case EventKind::kPhaseFinished:
        finished.insert(event.Text("phase"));
        break;
      case EventKind::kTrialStarted:
        phase_of_trial = event.Text("phase");
        ++progress.attempts[phase_of_trial];
        progress.interrupted_trial = event.Text("trial");
        break;
      case EventKind::kTrialFinished: {
        const std::string outcome = event.Text("outcome");
        if (outcome != kInterrupted) progress.interrupted_trial.clear();
        if (EndedInOrder(outcome)) progress.outcomes[phase_of_trial] = outcome;
        break;
      }
      case EventKind::kNote:
        progress.rested_at_s = event.Number(kRestedAt, progress.rested_at_s);
        break;
      case EventKind::kSessionResumed:
      case EventKind::kPhaseStarted:
      case EventKind::kFailure:
      case EventKind::kFailureUndone:
      case EventKind::kFailureRestored:
      case EventKind::kRating:
      case EventKind::kAnswer:
      case EventKind::kExertion:
      case EventKind::kResponse:
      case EventKind::kRanges:
        break;
    }
  }
  progress.active_s = active.total_s();
  while (progress.next_phase < phases.size() &&
         finished.count(phases[progress.next_phase].id) != 0) {
    ++progress.next_phase;
  }
  return progress;
}

std::vector<plan::SurveyItem> Unanswered(const std::vector<plan::SurveyItem>& items,
                                         const std::vector<Event>& events) {
  std::vector<plan::SurveyItem> left = items;
  for (const Event& event : events) {
    const auto scale = ScaleOf(event.kind);
    if (!scale) continue;
    const std::string asked = event.Text(*scale == plan::SurveyScale::kText ? "question" : "item");
    std::erase_if(left, [&](const plan::SurveyItem& item) {
      // The journal has a choice as an answer in text.
      const bool choice = item.scale == plan::SurveyScale::kChoice;
      return (choice ? plan::SurveyScale::kText : item.scale) == *scale && item.item == asked &&
             item.interface == event.Text("interface") && item.at_end == event.Flag("at_end");
    });
  }
  return left;
}

std::string Describe(const Progress& progress, const plan::SessionPlan& session) {
  if (progress.withdrawn) return session.participant + " has withdrawn";
  if (progress.finished) return session.participant + " has finished";
  if (!progress.started) return session.participant + " has not begun";
  if (progress.next_phase >= session.phases.size()) return session.participant + " is at the end";
  const plan::Phase& phase = session.phases[progress.next_phase];
  const auto attempts = progress.attempts.find(phase.id);
  std::string text = session.participant + " stopped in " + phase.id;
  if (attempts != progress.attempts.end()) {
    text += ", attempt " + std::to_string(attempts->second);
  }
  return text;
}

}  // namespace footing::study::records
