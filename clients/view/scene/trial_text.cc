#include "clients/view/scene/trial_text.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/words.h"
#include "common/base/units.h"

namespace footing::scene {
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

}  // namespace footing::scene
