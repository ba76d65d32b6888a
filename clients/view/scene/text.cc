#include "clients/view/scene/text.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/stream/trial.h"
#include "common/stream/user_interface.h"

namespace footing::scene {
namespace {

bool Names(const std::string& address, const char* word) {
  return address.find(word) != std::string::npos;
}

std::string Padded(std::string text, std::size_t width) {
  if (text.size() < width) text.append(width - text.size(), ' ');
  return text;
}

const char* StateName(LinkState state) {
  switch (state) {
    case LinkState::kConnecting:
      return "connecting";
    case LinkState::kLive:
      return "live";
    case LinkState::kStale:
      return "stale";
    case LinkState::kRefused:
      return "refused";
  }
  return "";
}

std::string DeviceLine(const stream::DeviceStatus& device, bool current) {
  std::string line = "  " + Padded(device.rig + "/" + stream::Name(device.role), 20) +
                     Padded(device.serial, 20) +
                     Padded(current ? stream::Name(device.state) : "unknown", 12) +
                     Padded(current ? Fixed(device.report_rate_hz, 1) + " Hz" : "- Hz", 10);
  line += device.battery_fraction < 0
              ? Padded("battery ?", 14)
              : Padded("battery " + Fixed(100 * device.battery_fraction, 0) + " %", 14);
  if (device.simulated) line += "SIMULATED";
  if (!device.note.empty()) line += "  " + device.note;
  return line;
}

std::string FootText(const BodyFoot& foot) {
  if (!foot.valid) return "unknown";
  const double spread_m = 2 * std::sqrt(std::max(0.0, foot.variance_m2.head<2>().maxCoeff()));
  const std::string spread = " +-" + Fixed(100 * spread_m, 1) + " cm";
  return (foot.contact ? Fixed(foot.load_n, 0) + " N" : "off " + Fixed(foot.airborne_s, 1) + " s") +
         spread;
}

std::vector<std::string> BodyLines(const CharacterPose& pose) {
  const BodyState& body = *pose.body;
  std::vector<std::string> lines{
      "  " + (body.subject.empty() ? std::string("no subject file") : body.subject) + "   " +
      ModeText(body) + "   lag " + Fixed(1e3 * body.lag_s, 0) + " ms   resets " +
      std::to_string(body.resets) + "   solved in " + Fixed(1e-3 * body.solve_us, 2) + " ms"};
  if (body.calibrated) {
    lines.push_back("  " + Fixed(body.mass_kg, 1) + " kg   COM height " + Fixed(pose.com_m.z(), 2) +
                    " m   left foot " + FootText(body.feet[0]) + "   right foot " +
                    FootText(body.feet[1]));
  } else {
    lines.push_back("  T-pose " + Fixed(100 * body.calibration_progress, 0) + " %   broken off " +
                    std::to_string(body.calibration_restarts) + " times");
  }
  std::string hands = "  hands: left ";
  hands += body.hands_seen[0] ? "seen" : "not seen";
  hands += body.hands_seen[1] ? ", right seen" : ", right not seen";
  if (!body.hands_source.empty()) hands += " by " + body.hands_source;
  if (!body.contact_source.empty()) hands += "   on " + body.contact_source;
  if (pose.simulated_input) hands += "   SIMULATED input";
  lines.push_back(hands);
  if (!body.note.empty()) lines.push_back("  " + body.note);
  return lines;
}

/// One line of a log.
std::string BodyText(const CharacterPose& pose) {
  const BodyState& body = *pose.body;
  std::string words = body.calibrated
                          ? Fixed(body.mass_kg, 1) + " kg  COM " + Fixed(pose.com_m.z(), 2) +
                                " m  feet " + FootText(body.feet[0]) + ", " + FootText(body.feet[1])
                          : "T-pose " + Fixed(100 * body.calibration_progress, 0) + " %";
  if (!body.contact_source.empty()) words += "  on " + body.contact_source;
  words += "  hands " + (body.hands_source.empty() ? std::string("none") : body.hands_source);
  if (!body.note.empty()) words += "  (" + body.note + ")";
  return words;
}

std::vector<std::string> CharacterLines(const CharacterPose& pose, const Model& model) {
  if (pose.body) return BodyLines(pose);
  const stream::GaitState& gait = pose.gait;
  std::string first = "  " + Padded(GaitTitle(gait.gait), 6) + Padded(PhaseTitle(pose.phase), 18) +
                      Fixed(gait.speed_mps, 2) + " m/s of " + Fixed(gait.commanded_speed_mps, 2) +
                      "   turn " + Fixed(RadiansToDegrees(gait.commanded_turn_rad), 1) +
                      " deg/step";
  if (gait.pending) first += "   next: " + GaitTitle(gait.commanded_gait);
  std::string second = "  distance " + Fixed(gait.distance_m, 1) + " m   " + FallText(gait) +
                       "   steps " + std::to_string(gait.steps);
  if (!gait.commanded_by_stream) second += "   no features arrive: stepping in place";
  if (pose.simulated_input) second += "   SIMULATED input";
  std::vector<std::string> lines{first, second};
  if (const std::string third = InterfaceText(pose.interface); !third.empty()) {
    lines.push_back("  " + third);
  }
  const stream::TrialState* trial = ShownTrial(pose, model.study.state);
  if (trial == nullptr) return lines;
  for (const std::string& line : TrialLines(*trial, model.track)) lines.push_back("  " + line);
  return lines;
}

const stream::TrialState* FirstTrial(const Model& model) {
  if (!HasPicture(model) || model.playout.Newest().characters.empty()) return nullptr;
  const auto& trial = model.playout.Newest().characters.front().trial;
  return trial ? &*trial : nullptr;
}

/// Old data must not look like a number among others.
std::string AgeText(double age_ms) {
  constexpr double kNoDataMs = 3000;  // As a link is called stale.
  if (age_ms < kNoDataMs) return "age " + Fixed(age_ms, 0) + " ms";
  return "no data for " + Fixed(age_ms * 1e-3, 0) + " s";
}

}  // namespace

std::string Fixed(double value, int decimals) {
  const double shown = std::isfinite(value) ? std::clamp(value, -1e12, 1e12) : 0;
  return text::Fixed(shown, std::clamp(decimals, 0, 9));
}

std::string CauseText(const stream::FailureCounts& failures) {
  std::string text;
  for (const stream::FailureCause cause : stream::kFailureCauses) {
    const std::uint64_t count = stream::CountOf(cause, failures);
    if (count == 0) continue;
    text += (text.empty() ? " (" : ", ") + std::string(stream::Name(cause)) + " " +
            std::to_string(count);
  }
  return text.empty() ? text : text + ")";
}

std::string FallText(const stream::GaitState& gait) {
  std::string text = "falls " + std::to_string(gait.falls) + CauseText(gait.failures);
  if (gait.operator_put_backs > 0) {
    text += ", put back by the operator " + std::to_string(gait.operator_put_backs);
  }
  return text;
}

std::string PhaseTitle(const std::string& phase) { return phase == "fall" ? "descend" : phase; }

std::string GaitTitle(stream::Gait gait) {
  switch (gait) {
    case stream::Gait::kUnspecified:
      return "-";
    case stream::Gait::kStep:
      return "STEP";
    case stream::Gait::kWalk:
      return "WALK";
    case stream::Gait::kRun:
      return "RUN";
    case stream::Gait::kJump:
      return "JUMP";
  }
  return "-";
}

std::string ReplayLine(double from_fall_s) {
  return "slow motion: " + Fixed(std::abs(from_fall_s), 1) +
         (from_fall_s < 0 ? " s before the fall" : " s after the fall");
}

std::vector<std::string> WaitingLines(const LinkReport& link) {
  switch (link.state) {
    case LinkState::kLive:
      return {};
    case LinkState::kStale:
      return {"Nothing from " + link.address + " for 3 s.", link.why};
    case LinkState::kRefused:
      return {"No connection to the server", link.why};
    case LinkState::kConnecting:
      break;
  }
  // It was there: why it is not any more, in its own words where it gave some.
  if (!link.server_id.empty()) return {"Lost " + link.address, link.why};
  // Where this user may not open the socket, to start another server would not help.
  if (Names(link.why, "join the group")) return {"No access to " + link.address, link.why};
  if (Names(link.address, "simulation")) {
    return {"Waiting for a simulation server on " + link.address,
            "Start one with:  footing-sim --engine gait --listen " + link.address};
  }
  if (Names(link.address, "sensor")) {
    return {"Waiting for a sensor daemon on " + link.address,
            "Start one with:  footingd --listen " + link.address};
  }
  return {"Waiting for a server on " + link.address,
          "Start one with:  footing-sim --listen " + link.address + "   (or footingd)"};
}

std::vector<std::string> StatusScreen(const Model& model, std::int64_t now_ns) {
  std::vector<std::string> lines{std::string("Footing") +
                                 (IsSimulated(model) ? "   [SIMULATED input]" : "")};
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const LinkReport& link = model.links[i];
    const std::string server = link.server_id.empty() ? "server" : link.server_id;
    lines.push_back(Padded(server, 14) + Padded(StateName(link.state), 12) + link.address);
    for (const std::string& line : WaitingLines(link)) lines.push_back("  " + line);
    const std::string notice = NoticeText(model, static_cast<int>(i), now_ns);
    if (!notice.empty()) lines.push_back("  NOTICE: " + notice);
  }
  if (HasPicture(model)) {
    for (const CharacterPose& pose : model.playout.Newest().characters) {
      if (std::string lost = LostLine(pose); !lost.empty()) lines.push_back("!! " + lost);
    }
    lines.push_back("Character");
    for (const CharacterPose& pose : model.playout.Newest().characters) {
      for (std::string& line : CharacterLines(pose, model)) lines.push_back(std::move(line));
    }
  }
  if (ShowsStudy(model.study.state)) {
    lines.push_back("Study       " + model.study.state.study);
    const double passed_s = NanosecondsToSeconds(now_ns - model.study.received_ns);
    for (const std::string& line : StudyLines(model.study.state, passed_s))
      lines.push_back("  " + line);
  }
  if (ShowsGame(model.game, FirstTrial(model))) {
    for (std::string& line : GameLines(model.game)) lines.push_back(std::move(line));
  }
  AddPreviewLines(model.observed.camera, now_ns, lines);
  if (!model.devices.empty()) lines.push_back("Devices");
  for (const Device& device : model.devices)
    lines.push_back(DeviceLine(device.status, IsCurrent(model, device)));
  const Stance stance = StanceOf(model);
  if (stance.valid) {
    lines.push_back("Boards      " + Fixed(NewtonsToKilograms(stance.total_n), 1) + " kg   left " +
                    Fixed(100 * stance.left_share, 0) + " %   right " +
                    Fixed(100 - 100 * stance.left_share, 0) + " %");
  }
  if (!IsWaiting(model)) {
    const Latencies& latency = model.tally.publish_to_view;
    lines.push_back("Latency     " + AgeText(AgeMs(model, now_ns)) + "   publish to view p50 " +
                    Fixed(latency.QuantileMs(0.5), 2) + " ms  p99 " +
                    Fixed(latency.QuantileMs(0.99), 2) + " ms");
  }
  if (model.last.response) {
    std::string line = "Response   ";
    for (const stream::ResponseStage& stage :
         stream::ResponseTimes(model.last.response->response)) {
      line += std::string(" ") + stage.name + " " + Fixed(stage.ms, 1);
    }
    lines.push_back(line + " ms");
  }
  if (model.last.note) lines.push_back("Last event  " + model.last.note->text);
  return lines;
}

std::string StatusLine(const Model& model, std::int64_t now_ns) {
  if (!HasPicture(model)) {
    for (const LinkReport& link : model.links) {
      const auto lines = WaitingLines(link);
      if (!lines.empty()) return lines[0] + ". " + lines[1];
    }
    return "devices " + std::to_string(model.devices.size()) + "  " +
           AgeText(AgeMs(model, now_ns)) + (IsSimulated(model) ? "  SIMULATED" : "") +
           NoticesOfLogLine(model, now_ns);
  }
  const WorldFrame& frame = model.playout.Newest();
  std::string line = "t " + Fixed(frame.time_s, 1) + " s";
  for (const CharacterPose& pose : frame.characters) {
    if (pose.body) {
      line += "  " + BodyText(pose);
      continue;
    }
    line += "  " + GaitTitle(pose.gait.gait) + "  " + Fixed(pose.gait.speed_mps, 2) + "/" +
            Fixed(pose.gait.commanded_speed_mps, 2) + " m/s  " + Fixed(pose.gait.distance_m, 1) +
            " m  " + FallText(pose.gait);
    if (const auto lost = LostSignalOf(pose)) line += "  !! " + lost->what;
    const std::string interface = InterfaceText(pose.interface);
    if (!interface.empty()) line += "  " + interface;
    const stream::TrialState* trial = ShownTrial(pose, model.study.state);
    if (trial == nullptr) continue;
    const std::string task = TaskText(*trial, model.track);
    line += "  " + TrialTitle(*trial) + (task.empty() ? "" : "  " + task);
  }
  if (ShowsGame(model.game, FirstTrial(model))) line += "  " + GameLine(model.game);
  line +=
      "  devices " + std::to_string(model.devices.size()) + "  " + AgeText(AgeMs(model, now_ns));
  return line + (IsSimulated(model) ? "  SIMULATED" : "") + NoticesOfLogLine(model, now_ns);
}

namespace {

using stream::UserInterface;

std::string AdviceFor(UserInterface interface) {
  const std::string which = interface == UserInterface::kBoards ? "board" : "controller";
  return "Stand still and press a button of each silent " + which +
         ". If no light comes on, change its batteries. The character continues by itself.";
}

}  // namespace

std::optional<LostSignal> LostSignalOf(const CharacterPose& pose) {
  const stream::InterfaceState& state = pose.interface;
  if (state.interface == UserInterface::kUnspecified) return std::nullopt;
  const bool absent = state.activity == stream::Activity::kAbsent;
  if (!absent && state.missing_roles == 0) return std::nullopt;
  // Without its devices an interface commands stepping: another command comes from elsewhere.
  if (absent && pose.gait.commanded_gait != stream::Gait::kStep) return std::nullopt;
  LostSignal lost;
  lost.effect = absent ? "The character stops and steps in place."
                       : "The character continues, but does not turn.";
  if (!pose.gait.commanded_by_stream) {
    lost.what = "No signal from any device";
    lost.advice =
        "Stand still. The sensor daemon footingd does not answer: start it again, or "
        "check the cable to it. The character continues by itself.";
    return lost;
  }
  lost.what = "No signal from " + stream::DevicesText(state.interface, state.missing_roles);
  lost.advice = AdviceFor(state.interface);
  return lost;
}

std::string LostLine(const CharacterPose& pose) {
  const auto lost = LostSignalOf(pose);
  return lost ? lost->what + ". " + lost->effect + " " + lost->advice : "";
}

namespace {

constexpr double kScreenS = 30;
constexpr double kLogLineS = 3;

std::string NewerThan(double seconds, const Note& note, std::int64_t now_ns) {
  return NanosecondsToSeconds(now_ns - note.received_ns) < seconds ? note.text : "";
}

}  // namespace

std::string NoticeText(const Model& model, int source, std::int64_t now_ns) {
  const auto found = model.last.server.find(source);
  return found == model.last.server.end() ? "" : NewerThan(kScreenS, found->second, now_ns);
}

std::string NoticesOfLogLine(const Model& model, std::int64_t now_ns) {
  std::string text;
  for (const auto& [source, note] : model.last.server) {
    const std::string notice = NewerThan(kLogLineS, note, now_ns);
    if (!notice.empty()) text += "  NOTICE: " + notice;
  }
  return text;
}

namespace {

/// The gait from the mark on, as a command.
std::string AfterMark(const stream::TrialState& trial, const stream::Track& track) {
  for (const stream::TrackTask& task : track.tasks) {
    if (task.name != trial.task) continue;
    return task.after == stream::Gait::kStep ? "stop" : stream::Name(task.after);
  }
  return trial.task;
}

std::string PlaceText(const stream::TrialState& trial) {
  const stream::TrialProgress& progress = trial.progress;
  std::string text = Fixed(progress.distance_m, 1);
  if (trial.finish_m > 0) text += " of " + Fixed(trial.finish_m, 1);
  text += " m   " + Fixed(std::abs(progress.lateral_offset_m), 2) + " m " +
          (progress.lateral_offset_m < 0 ? "right" : "left") + " of the line   heading " +
          Fixed(RadiansToDegrees(progress.heading_error_rad), 0) + " deg";
  return progress.on_track ? text : text + "   OFF THE TRACK";
}

}  // namespace

bool ShowsTrial(const stream::TrialState& trial) {
  return !trial.trial.empty() || trial.finish_m > 0;
}

const stream::TrialState* ShownTrial(const CharacterPose& pose, const stream::StudyState& study) {
  if (!pose.trial || !ShowsTrial(*pose.trial)) return nullptr;
  if (study.participant.empty()) return &*pose.trial;
  std::string own = study.participant + "." + study.phase;
  if (study.attempt > 0) own += "." + std::to_string(study.attempt);
  return pose.trial->trial == own ? &*pose.trial : nullptr;
}

std::string TrialTitle(const stream::TrialState& trial) {
  std::string text = "trial ";
  if (!trial.trial.empty()) text += trial.trial + " ";
  text += stream::Name(trial.progress.phase);
  if (trial.progress.phase == stream::TrialPhase::kReady) return text;
  return text + " " + Fixed(trial.progress.time_s, 1) + " s";
}

std::string TaskText(const stream::TrialState& trial, const stream::Track& track) {
  switch (trial.progress.task_phase) {
    case stream::TaskPhase::kAhead:
      return trial.instruction + ": " + Fixed(std::max(0.0, trial.to_mark_m), 0) + " m";
    case stream::TaskPhase::kDue:
      return "now " + AfterMark(trial, track);
    case stream::TaskPhase::kDone:
      return AfterMark(trial, track) + ": done";
    case stream::TaskPhase::kUnspecified:
      break;
  }
  return "";
}

std::string AttemptText(const stream::TrialState& trial) {
  const stream::FailureCounts& failures = trial.progress.failures;
  std::string text =
      "failed attempts " + std::to_string(stream::Total(failures)) + CauseText(failures);
  if (trial.withdrawn_failures > 0) {
    text += ", withdrawn " + std::to_string(trial.withdrawn_failures);
  }
  if (trial.progress.operator_put_backs > 0) {
    text += ", put back by the operator " + std::to_string(trial.progress.operator_put_backs);
  }
  return text;
}

std::vector<std::string> TrialLines(const stream::TrialState& trial, const stream::Track& track) {
  std::vector<std::string> lines{TrialTitle(trial) + "   " + PlaceText(trial), AttemptText(trial)};
  if (const std::string task = TaskText(trial, track); !task.empty()) lines.push_back(task);
  return lines;
}

namespace {

using stream::Activity;

bool IsOfFeet(UserInterface interface) {
  return interface == UserInterface::kLeg || interface == UserInterface::kBoards;
}

const char* LimbsOf(UserInterface interface) {
  return IsOfFeet(interface) ? "feet" : interface == UserInterface::kArm ? "arms" : "hands";
}

std::string RestText(UserInterface interface) {
  if (interface == UserInterface::kJoystick) return "stick at rest";
  if (IsOfFeet(interface)) return "standing";
  return std::string(LimbsOf(interface)) + " at rest";
}

std::string WithSpaces(std::string names) {
  std::replace(names.begin(), names.end(), '_', ' ');
  return names;
}

}  // namespace

std::string RoleText(stream::DeviceRole role) { return WithSpaces(stream::Name(role)); }

std::string RolesText(std::uint32_t roles) { return WithSpaces(stream::RoleNames(roles)); }

std::string ActivityText(const stream::InterfaceState& state) {
  const std::string limbs = LimbsOf(state.interface);
  switch (state.activity) {
    case Activity::kUnspecified:
      return "";
    case Activity::kAbsent:
      return "no devices";
    case Activity::kRest:
      return RestText(state.interface);
    case Activity::kUnclear:
      return limbs + " in motion, not clear yet";
    case Activity::kUnequal:
      return limbs + " at different frequencies";
    case Activity::kAlternate:
      return IsOfFeet(state.interface) ? "stepping" : limbs + " swing alternately";
    case Activity::kTogether:
      return IsOfFeet(state.interface) ? "both feet together" : limbs + " swing together";
    case Activity::kStick:
      return "stick pushed";
    case Activity::kButton:
      return "button A";
    case Activity::kHeelRise:
      return "heel rise";
    case Activity::kOffBoards:
      return "nobody on the boards";
  }
  return "";
}

std::string ProblemText(const stream::InterfaceState& state) {
  if (state.missing_roles != 0 && state.interface == UserInterface::kJoystick) {
    return "missing: " + stream::DevicesText(state.interface, state.missing_roles);
  }
  if (state.missing_roles != 0) return "missing: " + RolesText(state.missing_roles);
  if (state.unmounted_roles == 0) return "";
  return "no mounting: " + RolesText(state.unmounted_roles) + " (footing-ctl setup)";
}

std::string InterfaceText(const stream::InterfaceState& state) {
  if (state.interface == UserInterface::kUnspecified) return "";
  std::string text = std::string(stream::Name(state.interface)) + ": " + ActivityText(state);
  if (state.frequency_valid) text += ", " + Fixed(state.frequency_hz, 2) + " Hz";
  if (state.phase_valid) text += ", phase " + Fixed(RadiansToDegrees(state.phase_rad), 0) + " deg";
  if (state.forearms.valid) {
    text += ", forearms " + Fixed(RadiansToDegrees(state.forearms.elevation_rad), 0) + " deg";
  }
  if (state.stick.valid) text += ", " + Fixed(state.stick.x, 2) + " " + Fixed(state.stick.y, 2);
  if (state.load_valid) text += ", left " + Fixed(100 * state.left_share, 0) + " %";
  text += " -> " + GaitTitle(state.gait);
  if (state.next_gait != stream::Gait::kUnspecified) {
    text += " (" + GaitTitle(state.next_gait) + "?)";
  }
  if (std::fabs(state.turn.share) >= 1) {
    text += std::string(", turn ") + (state.turn.share > 0 ? "right" : "left") + " by " +
            stream::Name(state.turn.source);
  }
  const std::string problem = ProblemText(state);
  return problem.empty() ? text : text + "; " + problem;
}

namespace {

using stream::GamePhase;

std::string RoundTitle(std::size_t number, const stream::GameState& game) {
  return "Round " + std::to_string(number) + " of " + std::to_string(game.rounds);
}

std::string Winner(const stream::GameState& game) {
  const auto winner = stream::WinnerOf(game);
  return winner ? game.players[*winner].name + " wins" : "A draw";
}

std::string ScoreText(const stream::GameState& game, std::size_t player) {
  const std::string part = PartText(game, player);
  return game.players[player].name + (part.empty() ? " " : " (" + part + ") ") +
         Fixed(game.players[player].points, 0);
}

/// "left 8 deg", where there is a curve.
std::string Direction(double value, const char* positive, const char* negative,
                      const std::string& shown) {
  return std::string(value > 0 ? positive : negative) + " " + shown;
}

}  // namespace

bool ShowsGame(const stream::GameState& game, const stream::TrialState* trial) {
  if (game.phase == GamePhase::kUnspecified || game.players.size() != 2) return false;
  if (game.phase != GamePhase::kOver && game.phase != GamePhase::kLeft) return true;
  if (trial == nullptr || trial->trial.empty() || game.results.empty()) return true;
  // Trials after the last round are named after it.
  return trial->trial.ends_with(game.results.back().trial);
}

std::string GameTitle(const stream::GameState& game) {
  const std::size_t begun = game.results.size();
  switch (game.phase) {
    case GamePhase::kUnspecified:
      break;
    case GamePhase::kWaiting:
      return RoundTitle(begun + 1, game);
    case GamePhase::kCountdown:
      return RoundTitle(begun + 1, game) + " begins";
    case GamePhase::kRound:
      return RoundTitle(begun, game);
    case GamePhase::kPause:
      return "Change the controllers over";
    case GamePhase::kOver:
      return Winner(game);
    case GamePhase::kLeft:
      return "The game was left";
  }
  return "";
}

std::string GameClock(const stream::GameState& game) {
  if (!(game.left_s > 0)) return "";
  const auto left_s = static_cast<int>(std::ceil(std::min(game.left_s, 5999.0)));
  const std::string seconds = std::to_string(left_s % 60);
  return std::to_string(left_s / 60) + (seconds.size() < 2 ? ":0" : ":") + seconds;
}

std::string PartText(const stream::GameState& game, std::size_t player) {
  // Before a round: the part in it.
  const bool next = game.phase == GamePhase::kWaiting || game.phase == GamePhase::kCountdown;
  if (next) return game.results.size() % 2 == player ? "runs" : "builds";
  if (game.phase != GamePhase::kRound || game.results.empty()) return "";
  return game.results.back().runner == player ? "runs" : "builds";
}

std::string RoundText(const stream::GameState& game) {
  if (game.results.empty() || game.phase == GamePhase::kOver) return "";
  const stream::GameRound& round = game.results.back();
  return Fixed(round.distance_m, 1) + " m, " + std::to_string(round.segments_passed) + " of " +
         std::to_string(round.segments_laid) + " segments passed, failures " +
         std::to_string(stream::Total(round.failures)) + CauseText(round.failures);
}

std::string GhostText(const stream::GameState& game) {
  if (!game.ghost) return "";
  if (game.ghost->pit) return "next: a pit of " + Fixed(game.ghost->length_m, 1) + " m";
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  const double slope_deg = RadiansToDegrees(game.ghost->slope_rad);
  const double curve_deg = RadiansToDegrees(game.ghost_curve_rad);
  const double step_cm = 100 * game.ghost_step_m;
  if (std::abs(slope_deg) >= 0.05) {
    add("slope " + Direction(slope_deg, "up", "down", Fixed(std::abs(slope_deg), 1) + " deg"));
  }
  if (std::abs(step_cm) >= 0.05) {
    add("step " + Direction(step_cm, "up", "down", Fixed(std::abs(step_cm), 1) + " cm"));
  }
  if (std::abs(curve_deg) >= 0.5) {
    add("curve " + Direction(curve_deg, "left", "right", Fixed(std::abs(curve_deg), 0) + " deg"));
  }
  return "next: " + (text.empty() ? "level" : text);
}

std::string GameLine(const stream::GameState& game) {
  std::string line = "game: " + GameTitle(game);
  for (const std::string& part : {GameClock(game), ScoreText(game, 0) + " : " + ScoreText(game, 1),
                                  GhostText(game), game.note}) {
    if (!part.empty()) line += "  " + part;
  }
  return line;
}

std::vector<std::string> GameLines(const stream::GameState& game) {
  std::vector<std::string> lines{"Game        " + GameTitle(game) + "   " + GameClock(game),
                                 "  " + ScoreText(game, 0) + " : " + ScoreText(game, 1)};
  for (const std::string& part : {RoundText(game), GhostText(game), game.note}) {
    if (!part.empty()) lines.push_back("  " + part);
  }
  return lines;
}

namespace {

using stream::StudyActivity;

constexpr double kGoS = 1;

/// The part of a phase's id behind the interface: "rest" of "arm.rest".
std::string KindOf(const std::string& phase) { return phase.substr(phase.rfind('.') + 1); }

std::string InterfaceOf(const std::string& phase) {
  const std::size_t end = phase.rfind('.');
  return end == std::string::npos ? "" : phase.substr(0, end);
}

/// A phase in the words of a participant; empty: one that says nothing to them.
std::string PhaseForParticipant(const std::string& phase) {
  const std::string kind = KindOf(phase), interface = InterfaceOf(phase);
  if (kind.starts_with("straight") || kind == "test") return "a trial";
  if (kind == "rest") return "a rest";
  if (kind == "demonstration") return "the interface " + interface;
  if (kind == "practice") return "practice of the interface " + interface;
  if (kind == "ranges") return "your own movements";
  if (kind == "survey") return "questions about the interface " + interface;
  if (kind == "final_survey") return "the last questions";
  return "";
}

std::string NextForParticipant(const std::string& phase) {
  const std::string text = PhaseForParticipant(phase);
  return text.empty() ? "" : "Next: " + text;
}

/// Counts in, says "Go!" for a moment, and is gone.
std::optional<ParticipantText> CountIn(const stream::StudyState& study, double passed_s,
                                       bool started) {
  if (started || !(study.left_s > 0) || passed_s >= study.left_s + kGoS) return std::nullopt;
  const double left_s = std::ceil(std::min(study.left_s - passed_s, study.left_s));
  return ParticipantText{.headline = "", .count = left_s > 0 ? Fixed(left_s, 0) : "Go!"};
}

}  // namespace

bool ShowsStudy(const stream::StudyState& study) { return !study.participant.empty(); }

std::string StudyTitle(const stream::StudyState& study) {
  std::string text = study.participant + ", " + study.phase;
  if (study.attempt > 0) text += ", attempt " + std::to_string(study.attempt);
  return text + " (" + std::to_string(study.number) + " of " + std::to_string(study.phases) + ")";
}

std::string StudyClock(const stream::StudyState& study, double passed_s) {
  if (!(study.left_s > 0)) return "";
  // Once the trial is counted in, nothing counts down any more.
  if (study.activity == StudyActivity::kTrial && passed_s >= study.left_s) return "";
  const double left_s = std::clamp(study.left_s - passed_s, 0.0, 359'999.0);
  const int seconds = static_cast<int>(std::ceil(left_s));
  const std::string rest = std::to_string(seconds % 60);
  return std::to_string(seconds / 60) + (rest.size() < 2 ? ":0" : ":") + rest;
}

std::string StudyNext(const stream::StudyState& study) {
  return "next: " + study.next + "; in motion so far " + Fixed(study.active_s / 60, 1) + " min";
}

std::string StudyKeys(const stream::StudyState& study) {
  return study.keys.empty() ? "" : "keys: " + study.keys;
}

std::optional<ParticipantText> ParticipantTextOf(const stream::StudyState& study, double passed_s,
                                                 bool started) {
  if (!ShowsStudy(study)) return std::nullopt;
  const std::string clock = StudyClock(study, passed_s);
  const std::string next = NextForParticipant(study.next);
  switch (study.activity) {
    case StudyActivity::kUnspecified:
      return std::nullopt;
    case StudyActivity::kWait:
      return ParticipantText{.headline = "Please wait"};
    case StudyActivity::kDemonstration:
      return ParticipantText{.headline = "Demonstration of the interface " + study.interface,
                             .aside = true};
    case StudyActivity::kRanges:
      return ParticipantText{.headline = "Move as the experimenter says", .aside = true};
    case StudyActivity::kPractice:
      return ParticipantText{.headline = "Practice", .count = clock, .aside = true};
    case StudyActivity::kGetReady:
      return ParticipantText{.headline = "Get ready", .detail = "The trial begins after 3, 2, 1"};
    case StudyActivity::kTrial:
      return CountIn(study, passed_s, started);
    case StudyActivity::kFinished:
      return ParticipantText{.headline = "Finished", .detail = next};
    case StudyActivity::kStopped:
      return ParticipantText{.headline = "The trial is over", .detail = next};
    case StudyActivity::kRest: {
      // A rest that is due before a phase is none of the plan: the phase itself is what follows.
      const bool planned = KindOf(study.phase) == "rest";
      return ParticipantText{.headline = "Rest",
                             .count = clock,
                             .detail = planned ? next : NextForParticipant(study.phase)};
    }
    case StudyActivity::kSurvey:
      return ParticipantText{.headline = "Questions", .detail = "Please answer the survey"};
  }
  return std::nullopt;
}

std::optional<ParticipantText> GameStage(const stream::GameState& game) {
  if (game.players.size() != 2) return std::nullopt;
  const std::string& first = game.players[0].name;
  const std::string& second = game.players[1].name;
  const std::string parts =
      first + " " + PartText(game, 0) + ", " + second + " " + PartText(game, 1);
  const std::string points =
      Fixed(game.players[0].points, 0) + " : " + Fixed(game.players[1].points, 0);
  switch (game.phase) {
    case GamePhase::kUnspecified:
    case GamePhase::kLeft:
      return std::nullopt;
    case GamePhase::kWaiting:
      return ParticipantText{.headline = first + " against " + second,
                             .detail = game.note.empty() ? parts : game.note};
    case GamePhase::kCountdown:
      return ParticipantText{.headline = RoundTitle(game.results.size() + 1, game),
                             .count = Fixed(std::ceil(std::max(game.left_s, 1.0)), 0),
                             .detail = parts};
    case GamePhase::kRound:
      if (game.results.empty() || game.results.back().time_s > kGoS) return std::nullopt;
      return ParticipantText{.count = "Go!"};
    case GamePhase::kPause:
      return ParticipantText{
          .headline = "The round is over", .count = points, .detail = GameTitle(game)};
    case GamePhase::kOver:
      return ParticipantText{
          .headline = GameTitle(game), .count = points, .detail = first + " : " + second};
  }
  return std::nullopt;
}

std::optional<ParticipantText> TrialStage(const stream::TrialState& trial) {
  if (!(trial.finish_m > 0)) return std::nullopt;
  const stream::TrialProgress& progress = trial.progress;
  if (progress.phase == stream::TrialPhase::kRunning && progress.time_s < kGoS)
    return ParticipantText{.count = "Go!", .aside = true};
  if (progress.phase != stream::TrialPhase::kFinished) return std::nullopt;
  return ParticipantText{.headline = "Finish",
                         .count = Fixed(progress.time_s, 1) + " s",
                         .detail = AttemptText(trial),
                         .aside = true};
}

std::vector<std::string> StudyLines(const stream::StudyState& study, double passed_s) {
  const std::string clock = StudyClock(study, passed_s);
  std::vector<std::string> lines{StudyTitle(study),
                                 study.doing + (clock.empty() ? "" : "   " + clock + " left"),
                                 StudyNext(study)};
  if (const std::string keys = StudyKeys(study); !keys.empty()) lines.push_back(keys);
  return lines;
}

std::string ModeText(const BodyState& body) {
  std::string text = body.mode + " mode";
  for (std::size_t i = 0; i < body.left_out.size(); ++i) {
    std::string part = body.left_out[i];
    std::replace(part.begin(), part.end(), '_', ' ');
    text += (i == 0 ? " without " : ", ") + part;
  }
  return text;
}

}  // namespace footing::scene
