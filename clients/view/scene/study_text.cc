#include "clients/view/scene/study_text.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/words.h"

namespace footing::scene {

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

std::vector<std::string> StudyLines(const stream::StudyState& study, double passed_s) {
  const std::string clock = StudyClock(study, passed_s);
  std::vector<std::string> lines{StudyTitle(study),
                                 study.doing + (clock.empty() ? "" : "   " + clock + " left"),
                                 StudyNext(study)};
  if (const std::string keys = StudyKeys(study); !keys.empty()) lines.push_back(keys);
  return lines;
}

}  // namespace footing::scene
