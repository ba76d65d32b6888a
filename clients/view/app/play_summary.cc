#include "clients/view/app/play_summary.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "clients/view/app/summary.h"
#include "clients/view/scene/words.h"
#include "clients/view/scene/timeline_text.h"

namespace footing::view {
namespace {

using Json = nlohmann::ordered_json;

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json Counts(const stream::FailureCounts& counts) {
  Json json;
  for (const stream::FailureCause cause : stream::kFailureCauses) {
    json[stream::Name(cause)] = stream::CountOf(cause, counts);
  }
  return json;
}

Json Trials(const timeline::Timeline& line) {
  Json trials = Json::array();
  for (const timeline::TrialMark& trial : line.trials) {
    trials.push_back({{"trial", trial.id},
                      {"number", trial.number},
                      {"track", trial.track},
                      {"task", trial.task},
                      {"begin_s", trial.begin_s},
                      {"start_s", OrNull(trial.start_s)},
                      {"end_s", OrNull(trial.end_s)},
                      {"phase", stream::Name(trial.phase)},
                      {"time_s", trial.time_s},
                      {"failures", Counts(timeline::FailuresOf(line, trial, line.end_s))}});
  }
  return trials;
}

Json Failures(const timeline::Timeline& line) {
  Json failures = Json::array();
  for (const timeline::FailureMark& failure : line.failures) {
    failures.push_back({{"at_s", failure.at_s},
                        {"number", failure.number},
                        {"cause", stream::Name(failure.cause)},
                        {"trial", failure.trial},
                        {"trial_time_s", failure.trial_time_s},
                        {"distance_m", failure.distance_m},
                        {"withdrawn", failure.withdrawn}});
  }
  return failures;
}

Json Tasks(const timeline::Timeline& line) {
  Json tasks = Json::array();
  for (const timeline::TaskMark& task : line.tasks) {
    tasks.push_back({{"at_s", task.at_s}, {"task", task.task}});
  }
  return tasks;
}

Json Playback(const PlaySession& session, const PlayedSide& side) {
  const timeline::SideState state = session.StateOf(side);
  const timeline::TrialMark* const trial = timeline::TrialAt(side.timeline, state.at_s);
  Json playback{{"recording", side.show.recording().path()},
                {"position_s", session.head().at_s},
                {"begin_s", side.timeline.begin_s},
                {"end_s", side.timeline.end_s},
                {"speed", session.head().speed},
                {"ended", state.finished},
                {"limits", side.show.recording().Limits()},
                {"trial", trial == nullptr ? Json() : Json(timeline::NameOf(*trial))}};
  playback["trials"] = Trials(side.timeline);
  playback["failures"] = Failures(side.timeline);
  playback["tasks"] = Tasks(side.timeline);
  return playback;
}

Json SideSummary(const PlaySession& session, const PlayedSide& side, double seconds) {
  Json summary = Json::parse(Summary(side.show.model(), seconds));
  summary["playback"] = Playback(session, side);
  return summary;
}

}  // namespace

std::string PlaySummary(const PlaySession& session, double seconds) {
  Json summary = SideSummary(session, session.sides().front(), seconds);
  if (session.sides().size() > 1) {
    summary["beside"] = SideSummary(session, session.sides()[1], seconds);
  }
  return summary.dump();
}

std::vector<std::string> PlayScreenText(const PlaySession& session) {
  std::vector<std::string> lines{timeline::PositionText(session.head())};
  for (const PlayedSide& side : session.sides()) {
    const timeline::SideState state = session.StateOf(side);
    lines.push_back(side.name +
                    (session.sides().size() > 1 ? "   " + timeline::StateText(state) : ""));
    lines.push_back(timeline::TrialText(side.timeline, state.at_s));
    for (std::string& line : scene::StatusScreen(side.show.model(), session.ClockOf(side))) {
      lines.push_back("  " + std::move(line));
    }
  }
  return lines;
}

std::string PlayLine(const PlaySession& session) {
  std::string line = timeline::PositionText(session.head());
  for (const PlayedSide& side : session.sides()) {
    const timeline::SideState state = session.StateOf(side);
    if (session.sides().size() > 1) line += "   | " + side.name + " " + timeline::StateText(state);
    const std::string trial = timeline::TrialText(side.timeline, state.at_s);
    if (!trial.empty()) line += "   " + trial;
    line += "   " + scene::StatusLine(side.show.model(), session.ClockOf(side));
  }
  return line;
}

}  // namespace footing::view
