#include "clients/view/app/play_summary.h"

#include <map>
#include <optional>

#include <nlohmann/json.hpp>

#include "clients/view/scene/text.h"
#include "clients/view/scene/timeline.h"
#include "common/runtime/clock.h"
#include "common/stream/trial.h"

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

Json Markers(const timeline::Timeline& line) {
  Json markers = Json::array();
  for (const timeline::MarkerMark& marker : line.markers) {
    markers.push_back({{"at_s", marker.at_s},
                       {"text", marker.text},
                       {"value", marker.value ? Json(*marker.value) : Json()}});
  }
  return markers;
}

Json Events(const timeline::Timeline& line) {
  Json events = Json::array();
  for (const timeline::EventMark& event : line.events) {
    events.push_back({{"at_s", event.at_s}, {"text", event.text}});
  }
  return events;
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
  playback["markers"] = Markers(side.timeline);
  playback["events"] = Events(side.timeline);
  return playback;
}

Json SideSummary(const PlaySession& session, const PlayedSide& side, double seconds,
                 const PictureTimes& times) {
  Json summary = Json::parse(Summary(side.show.model(), seconds, times));
  summary["playback"] = Playback(session, side);
  return summary;
}

}  // namespace

void PictureTimes::Add(std::int64_t begun_ns, std::int64_t shown_ns) {
  if (last_begun_ns != 0) interval.Add(begun_ns - last_begun_ns);
  drawing.Add(shown_ns - begun_ns);
  last_begun_ns = begun_ns;
}

std::string PlaySummary(const PlaySession& session, double seconds, const PictureTimes& times) {
  Json summary = SideSummary(session, session.sides().front(), seconds, times);
  if (session.sides().size() > 1) {
    summary["beside"] = SideSummary(session, session.sides()[1], seconds, times);
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

namespace {

void AddPose(const scene::PoseTally& tally, nlohmann::ordered_json& summary) {
  summary["calibrated"] = tally.calibrated();
  summary["calibrations"] = tally.calibrations();
  summary["calibrated_frames"] = tally.calibrated_frames();
  summary["resets"] = tally.resets();
  summary["mass_kg"] = tally.mass_kg();
  summary["hands"] = tally.hands_source().empty() ? "none" : tally.hands_source();
  summary["contact_source"] = tally.contact_source();
  summary["compared_frames"] = tally.compared();
  summary["invalid_frames"] = tally.invalid();
  if (tally.compared() == 0) return;
  summary["mpjpe_cm"] = tally.mpjpe_cm();
  summary["mpjpe_root_relative_cm"] = tally.mpjpe_root_relative_cm();
  summary["wrists_cm"] = tally.wrists_cm();
  summary["ankles_cm"] = tally.ankles_cm();
}

nlohmann::ordered_json Failures(const stream::FailureCounts& counts) {
  nlohmann::ordered_json failures;
  for (const stream::FailureCause cause : stream::kFailureCauses) {
    failures[stream::Name(cause)] = stream::CountOf(cause, counts);
  }
  return failures;
}

/// The trial of the first character as of the last frame.
void AddTrial(const scene::Model& model, nlohmann::ordered_json& summary) {
  if (model.playout.empty() || model.playout.Newest().characters.empty()) return;
  const auto& trial = model.playout.Newest().characters.front().trial;
  if (!trial) return;
  summary["trial"] = {{"trial", trial->trial},
                      {"track", trial->track},
                      {"phase", stream::Name(trial->progress.phase)},
                      {"time_s", trial->progress.time_s},
                      {"distance_m", trial->progress.distance_m},
                      {"failures", Failures(trial->progress.failures)},
                      {"withdrawn_failures", trial->withdrawn_failures},
                      {"operator_put_backs", trial->progress.operator_put_backs}};
}

/// The terrain game as published last.
void AddGame(const stream::GameState& game, nlohmann::ordered_json& summary) {
  if (game.phase == stream::GamePhase::kUnspecified) return;
  nlohmann::ordered_json players = nlohmann::ordered_json::array();
  for (const stream::GamePlayer& player : game.players) {
    players.push_back({{"name", player.name}, {"points", player.points}});
  }
  std::uint64_t laid = 0, passed = 0;
  for (const stream::GameRound& round : game.results) {
    laid += round.segments_laid;
    passed += round.segments_passed;
  }
  summary["game"] = {{"host", game.host},         {"phase", stream::Name(game.phase)},
                     {"rounds", game.rounds},     {"rounds_begun", game.results.size()},
                     {"players", players},        {"segments_laid", laid},
                     {"segments_passed", passed}, {"segments_refused", game.refused}};
}

/// Adds the camera's last state to the summary.
void AddCamera(const scene::CameraPreview& camera, nlohmann::ordered_json& summary) {
  static const std::map<preview::Sight, const char*> kSights{
      {preview::Sight::kNothing, "nothing"},
      {preview::Sight::kOther, "other"},
      {preview::Sight::kChecking, "checking"},
      {preview::Sight::kSeen, "seen"}};
  if (camera.state == scene::CameraPreview::State::kNone) return;
  const std::int64_t now_ns = clock::MonotonicNs();
  nlohmann::ordered_json spheres = nlohmann::ordered_json::array();
  if (camera.picture)
    for (const preview::Sphere& sphere : camera.picture->spheres)
      spheres.push_back({{"role", stream::Name(sphere.role)},
                         {"sight", kSights.at(sphere.sight)},
                         {"confidence", sphere.confidence}});
  summary["camera"] = {{"frame", camera.picture ? camera.picture->number : 0},
                       {"age_s", scene::PreviewAgeS(camera, now_ns)},
                       {"trouble", scene::PreviewTrouble(camera, now_ns)},
                       {"spheres", spheres}};
}

/// Pictures a second, by their median, and times of drawing.
void AddTimes(const PictureTimes& times, nlohmann::ordered_json& summary) {
  const double median_ms = times.interval.QuantileMs(0.5);
  if (median_ms <= 0) return;
  summary["frames_per_second"] = 1e3 / median_ms;
  summary["frame_interval_p99_ms"] = times.interval.QuantileMs(0.99);
  summary["drawing_p50_ms"] = times.drawing.QuantileMs(0.5);
}

}  // namespace

std::string Summary(const scene::Model& model, double seconds, const PictureTimes& times) {
  nlohmann::ordered_json gaits = nlohmann::ordered_json::array();
  for (const stream::Gait gait : model.tally.GaitsSeen()) gaits.push_back(stream::Name(gait));
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const auto& [name, latencies] : model.tally.response_stages) {
    stages[name] = latencies.QuantileMs(0.95);
  }
  nlohmann::ordered_json summary{
      {"seconds", seconds},
      {"frames_published", model.tally.frames_published()},
      {"frames_received", model.tally.frames()},
      {"frames_drawn", model.tally.frames_drawn},
      {"publish_to_view_p50_ms", model.tally.publish_to_view.QuantileMs(0.5)},
      {"publish_to_view_p99_ms", model.tally.publish_to_view.QuantileMs(0.99)},
      {"gaits_seen", gaits},
      {"falls", model.tally.falls()},
      {"failures", Failures(model.tally.failures())},
      {"operator_put_backs", model.tally.operator_put_backs()},
      {"off_track_s", model.tally.off_track_s()},
      {"distance_m", model.tally.distance_m()},
      {"responses", model.tally.response_without_contact.count()},
      {"response_stages_p95_ms", stages},
      {"response_without_contact_p95_ms", model.tally.response_without_contact.QuantileMs(0.95)},
      {"simulated", scene::IsSimulated(model)}};
  AddTimes(times, summary);
  AddTrial(model, summary);
  AddGame(model.game, summary);
  AddCamera(model.observed.camera, summary);
  if (model.pose_tally.any()) AddPose(model.pose_tally, summary);
  return summary.dump();
}

}  // namespace footing::view
