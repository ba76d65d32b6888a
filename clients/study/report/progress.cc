#include "clients/study/report/progress.h"

#include <optional>
#include <set>

#include "clients/study/report/active_tally.h"
#include "clients/study/report/trials.h"

namespace footing::study::records {
namespace {

/// Of the events of a survey; nothing of any other.
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
  progress.phases_finished = finished.size();
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

std::string Describe(const Progress& progress, const plan::Session& session) {
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
