#include "clients/view/scene/words.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/game_text.h"
#include "clients/view/scene/interface_text.h"
#include "clients/view/scene/lost_text.h"
#include "clients/view/scene/notice_text.h"
#include "clients/view/scene/study_text.h"
#include "clients/view/scene/trial_text.h"
#include "common/base/number.h"
#include "common/base/units.h"

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
      body.mode + " mode   lag " + Fixed(1e3 * body.lag_s, 0) + " ms   resets " +
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

}  // namespace footing::scene
