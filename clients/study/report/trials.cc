#include "clients/study/report/trials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "clients/study/report/event.h"

namespace footing::study::records {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::size_t Position(const Records& records, const std::string& interface) {
  const auto found = std::find(records.interfaces.begin(), records.interfaces.end(), interface);
  return found == records.interfaces.end()
             ? 0
             : static_cast<std::size_t>(found - records.interfaces.begin()) + 1;
}

Trial Begun(const Event& event, const Records& records) {
  Trial trial;
  trial.id = event.Text("trial");
  trial.participant = records.participant;
  trial.phase = event.Text("phase");
  trial.interface = event.Text("interface");
  trial.kind = event.Text("kind");
  trial.track = event.Text("track");
  trial.task = event.Text("task");
  trial.position = Position(records, trial.interface);
  trial.attempt = static_cast<std::size_t>(event.Number("attempt"));
  trial.started_wall_ns = event.wall_ns;
  trial.outcome = kInterrupted;  // Until its end.
  trial.heading_oscillation_rad = trial.anticipation_s = kUnknown;
  trial.recording = event.Text("recording");
  trial.synthetic = records.synthetic;
  return trial;
}

void Finish(const Event& event, Trial& trial) {
  trial.outcome = event.Text("outcome");
  trial.time_s = event.Number("time_s");
  trial.distance_m = event.Number("distance_m");
  trial.heading_oscillation_rad = event.Number("heading_oscillation_rad", kUnknown);
  trial.anticipation_s = event.Number("anticipation_s", kUnknown);
}

Failure ToFailure(const Event& event) {
  Failure failure;
  failure.number = static_cast<std::uint64_t>(event.Number("failure"));
  failure.kind = event.Text("kind");
  failure.trial_time_s = event.Number("trial_time_s");
  failure.distance_m = event.Number("distance_m");
  return failure;
}

void TakeResponse(const Event& event, Trial& trial) {
  const auto stages = event.fields.find("stages_ms");
  if (stages == event.fields.end() || !stages->is_object()) return;
  Response response;
  for (const auto& [stage, ms] : stages->items()) {
    if (ms.is_number()) response.push_back({stage, ms.get<double>()});
  }
  trial.responses.push_back(std::move(response));
}

/// Numbers start again with the server: without a trial the newest failure of that number is meant.
void MarkUndone(const Event& event, bool undone, Records& records) {
  const auto number = static_cast<std::uint64_t>(event.Number("failure"));
  const std::string of_trial = event.Text("trial");
  for (auto trial = records.trials.rbegin(); trial != records.trials.rend(); ++trial) {
    if (!of_trial.empty() && trial->id != of_trial) continue;
    for (auto failure = trial->failures.rbegin(); failure != trial->failures.rend(); ++failure) {
      if (failure->number != number) continue;
      failure->undone = undone;
      return;
    }
  }
}

/// An item without an interface is about the whole study, and so belongs to its end.
bool AtEnd(const Event& event) { return event.Flag("at_end") || event.Text("interface").empty(); }

void TakeRating(const Event& event, const std::string& item, Records& records) {
  Rating rating{records.participant,   event.Text("interface"), item,
                event.Number("value"), event.Flag("synthetic"), AtEnd(event)};
  for (Rating& earlier : records.ratings) {
    if (earlier.interface != rating.interface || earlier.item != rating.item ||
        earlier.at_end != rating.at_end) {
      continue;
    }
    earlier = rating;
    return;
  }
  records.ratings.push_back(rating);
}

void TakeAnswer(const Event& event, Records& records) {
  Answer answer{records.participant, event.Text("interface"), event.Text("question"),
                event.Text("text"),  event.Flag("synthetic"), AtEnd(event)};
  for (Answer& earlier : records.answers) {
    if (earlier.interface != answer.interface || earlier.question != answer.question ||
        earlier.at_end != answer.at_end) {
      continue;
    }
    earlier = answer;
    return;
  }
  records.answers.push_back(answer);
}

void TakeStart(const Event& event, Records& records) {
  records.participant = event.Text("participant");
  records.synthetic = event.Flag("synthetic");
  records.simulated_time = event.Flag("simulated_time");
  if (!event.fields.contains("interfaces") || !event.fields["interfaces"].is_array()) return;
  for (const auto& one : event.fields["interfaces"]) {
    if (one.is_string()) records.interfaces.push_back(one);
  }
}

}  // namespace

std::size_t Trial::Count(const std::string& kind_named) const {
  return static_cast<std::size_t>(std::count_if(
      failures.begin(), failures.end(),
      [&](const Failure& failure) { return !failure.undone && failure.kind == kind_named; }));
}

std::size_t Trial::failure_count() const {
  return static_cast<std::size_t>(std::count_if(failures.begin(), failures.end(),
                                                [](const Failure& one) { return !one.undone; }));
}

double Trial::time_to_first_failure_s() const {
  for (const Failure& failure : failures) {
    if (!failure.undone) return failure.trial_time_s;
  }
  return kUnknown;
}

Records Collect(const std::vector<Event>& events) {
  Records records;
  ActiveTally active;
  for (const Event& event : events) {
    active.Add(event);
    const bool in_trial = !records.trials.empty();
    switch (event.kind) {
      case EventKind::kSessionStarted:
        TakeStart(event, records);
        break;
      case EventKind::kSessionFinished:
        records.finished = true;
        break;
      case EventKind::kWithdrawn:
        records.withdrawn = true;
        break;
      case EventKind::kTrialStarted:
        records.synthetic = records.synthetic || event.Flag("synthetic");
        records.trials.push_back(Begun(event, records));
        break;
      case EventKind::kTrialFinished:
        if (in_trial) Finish(event, records.trials.back());
        break;
      case EventKind::kFailure:
        if (in_trial) records.trials.back().failures.push_back(ToFailure(event));
        break;
      case EventKind::kFailureUndone:
      case EventKind::kFailureRestored:
        MarkUndone(event, event.kind == EventKind::kFailureUndone, records);
        break;
      case EventKind::kResponse:
        if (in_trial) TakeResponse(event, records.trials.back());
        break;
      case EventKind::kRating:
        TakeRating(event, event.Text("item"), records);
        break;
      case EventKind::kExertion:
        TakeRating(event, "exertion", records);
        break;
      case EventKind::kAnswer:
        TakeAnswer(event, records);
        break;
      case EventKind::kSessionResumed:
        // One synthetic part makes the whole session one.
        records.synthetic = records.synthetic || event.Flag("synthetic");
        break;
      case EventKind::kPhaseStarted:
      case EventKind::kPhaseFinished:
      case EventKind::kNote:
      case EventKind::kRanges:
        break;
    }
  }
  records.active_s = active.by_interface();
  records.active_s.erase("");
  return records;
}

bool EndedInOrder(const std::string& outcome) {
  return outcome != kInterrupted && outcome != kDeviceLost && outcome != kBrokenOff;
}

std::vector<Failure> FailuresOf(const Records& records, const std::string& trial) {
  for (const Trial& one : records.trials) {
    if (one.id == trial) return one.failures;
  }
  return {};
}

const Trial* WithFailure(const Records& records, std::uint64_t number) {
  for (auto trial = records.trials.rbegin(); trial != records.trials.rend(); ++trial) {
    for (const Failure& failure : trial->failures) {
      if (failure.number == number) return &*trial;
    }
  }
  return nullptr;
}

std::vector<const Trial*> Counting(const Records& records) {
  std::map<std::string, const Trial*> last;
  for (const Trial& trial : records.trials) {
    if (EndedInOrder(trial.outcome)) last[trial.phase] = &trial;
  }
  std::vector<const Trial*> counting;
  for (const Trial& trial : records.trials) {
    const auto found = last.find(trial.phase);
    if (found != last.end() && found->second == &trial) counting.push_back(&trial);
  }
  return counting;
}

}  // namespace footing::study::records
