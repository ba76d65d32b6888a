#include "clients/study/report/event.h"

#include <cmath>

#include <gtest/gtest.h>

#include "clients/study/report/trials.h"

namespace footing::study::records {
namespace {

using nlohmann::ordered_json;

class Events {
 public:
  Events& Add(EventKind kind, ordered_json fields = ordered_json::object()) {
    list.push_back({kind, list.size() + 1, static_cast<std::int64_t>(list.size()), fields});
    return *this;
  }
  Events& Trial(const std::string& phase, int attempt) {
    return Add(EventKind::kTrialStarted, {{"phase", phase},
                                          {"trial", phase + std::to_string(attempt)},
                                          {"interface", "wrist"},
                                          {"kind", "straight"},
                                          {"attempt", attempt}});
  }
  Events& Finished(double time_s) {
    return Add(EventKind::kTrialFinished, {{"outcome", "finished"}, {"time_s", time_s}});
  }
  Events& Failed(int number, const std::string& kind, double time_s) {
    return Add(EventKind::kFailure,
               {{"failure", number}, {"kind", kind}, {"trial_time_s", time_s}});
  }
  std::vector<Event> list;
};

plan::SessionPlan TwoTrials() {
  plan::SessionPlan session;
  session.participant = "P7";
  session.interfaces = {"wrist"};
  session.phases = {{"consent", plan::PhaseKind::kConsent, "", "", "", 0, 0},
                    {"wrist.straight1", plan::PhaseKind::kStraight, "wrist", "s", "", 0, 1},
                    {"wrist.straight2", plan::PhaseKind::kStraight, "wrist", "s", "", 0, 2}};
  return session;
}

TEST(Progress, GoesOnWithTheFirstPhaseThatIsNotFinished) {
  const plan::SessionPlan session = TwoTrials();
  Events events;
  EXPECT_FALSE(Replay(session.phases, events.list).started);
  events.Add(EventKind::kSessionStarted).Add(EventKind::kPhaseFinished, {{"phase", "consent"}});
  EXPECT_EQ(Replay(session.phases, events.list).next_phase, 1u);
  events.Trial("wrist.straight1", 1);
  Progress progress = Replay(session.phases, events.list);
  EXPECT_EQ(progress.next_phase, 1u);
  EXPECT_EQ(progress.interrupted_trial, "wrist.straight11");
  EXPECT_EQ(Describe(progress, session), "P7 stopped in wrist.straight1, attempt 1");
  events.Trial("wrist.straight1", 2).Finished(9);
  events.Add(EventKind::kPhaseFinished, {{"phase", "wrist.straight1"}});
  progress = Replay(session.phases, events.list);
  EXPECT_EQ(progress.next_phase, 2u);
  EXPECT_EQ(progress.attempts.at("wrist.straight1"), 2u);
  EXPECT_TRUE(progress.interrupted_trial.empty());
}

TEST(Progress, AnAttemptThatWasInterruptedIsRepeatedAndNamed) {
  const plan::SessionPlan session = TwoTrials();
  Events events;
  events.Trial("wrist.straight1", 1);
  events.Add(EventKind::kTrialFinished, {{"outcome", kInterrupted}, {"time_s", 3}});
  const Progress progress = Replay(session.phases, events.list);
  EXPECT_EQ(progress.interrupted_trial, "wrist.straight11");
  EXPECT_TRUE(progress.outcomes.empty());
  const Records records = Collect(events.list);
  EXPECT_TRUE(Counting(records).empty());
  EXPECT_EQ(records.trials.front().time_s, 3);
}

TEST(Progress, AddsUpTheActiveTimeOfFinishedPhases) {
  Events events;
  events.Add(EventKind::kPhaseFinished, {{"phase", "a"}, {"active_s", 40.5}});
  events.Add(EventKind::kPhaseFinished, {{"phase", "b"}, {"active_s", 20}});
  EXPECT_EQ(Replay(TwoTrials().phases, events.list).active_s, 60.5);
}

TEST(Progress, KnowsAfterHowLongInMotionTheLastLongRestWas) {
  Events events;
  events.Add(EventKind::kPhaseFinished, {{"phase", "a"}, {"active_s", 40}});
  events.Add(EventKind::kNote, {{"text", "warning: something"}});
  EXPECT_EQ(Replay(TwoTrials().phases, events.list).rested_at_s, 0);
  events.Add(EventKind::kNote, {{"text", "Rest"}, {kRestedAt, 40}});
  events.Add(EventKind::kPhaseFinished, {{"phase", "b"}, {"active_s", 20}});
  const Progress progress = Replay(TwoTrials().phases, events.list);
  EXPECT_EQ(progress.rested_at_s, 40);
  EXPECT_EQ(progress.active_s, 60);
}

TEST(Progress, KeepsTheTrialThatEndedBeforeACrash) {
  const plan::SessionPlan session = TwoTrials();
  Events events;
  events.Add(EventKind::kSessionStarted).Add(EventKind::kPhaseFinished, {{"phase", "consent"}});
  events.Add(EventKind::kPhaseStarted, {{"phase", "wrist.straight1"}, {"interface", "wrist"}});
  events.Trial("wrist.straight1", 1);
  EXPECT_TRUE(Replay(session.phases, events.list).outcomes.empty());
  events.Add(EventKind::kTrialFinished, {{"outcome", "timed_out"}, {"active_s", 7.5}});
  Progress progress = Replay(session.phases, events.list);
  EXPECT_EQ(progress.next_phase, 1u);  // Whether to repeat it has not been answered.
  EXPECT_EQ(progress.outcomes.at("wrist.straight1"), "timed_out");
  EXPECT_EQ(progress.active_s, 7.5);
  // A repeat that lost a device does not replace it.
  events.Add(EventKind::kPhaseStarted, {{"phase", "wrist.straight1"}, {"interface", "wrist"}});
  events.Trial("wrist.straight1", 2);
  events.Add(EventKind::kTrialFinished, {{"outcome", kDeviceLost}, {"active_s", 2}});
  progress = Replay(session.phases, events.list);
  EXPECT_EQ(progress.outcomes.at("wrist.straight1"), "timed_out");
  EXPECT_EQ(progress.active_s, 9.5);
  // The time of a phase holds that of its trials in the same run.
  events.Add(EventKind::kPhaseFinished,
             {{"phase", "wrist.straight1"}, {"interface", "wrist"}, {"active_s", 3}});
  EXPECT_EQ(Replay(session.phases, events.list).active_s, 10.5);
  EXPECT_EQ(Collect(events.list).active_s.at("wrist"), 10.5);
}

TEST(Progress, KnowsWithdrawalAndTheEnd) {
  const plan::SessionPlan session = TwoTrials();
  Events events;
  events.Add(EventKind::kSessionStarted).Add(EventKind::kWithdrawn);
  EXPECT_TRUE(Replay(session.phases, events.list).withdrawn);
  events.Add(EventKind::kSessionFinished);
  EXPECT_TRUE(Replay(session.phases, events.list).finished);
}

TEST(TrialRecords, CountFailuresByKindWithoutThoseUndone) {
  Events events;
  events.Add(EventKind::kSessionStarted, {{"participant", "P7"}, {"interfaces", {"arm", "wrist"}}});
  events.Trial("wrist.straight1", 1).Failed(1, "jump", 2).Failed(2, "curve", 5);
  events.Add(EventKind::kFailureUndone, {{"failure", 1}}).Failed(3, "jump", 8).Finished(12);
  const Records records = Collect(events.list);
  ASSERT_EQ(records.trials.size(), 1u);
  const Trial& trial = records.trials.front();
  EXPECT_EQ(trial.participant, "P7");
  EXPECT_EQ(trial.position, 2u);
  EXPECT_EQ(trial.Count("jump"), 1u);
  EXPECT_EQ(trial.failure_count(), 2u);
  EXPECT_EQ(trial.time_to_first_failure_s(), 5);  // The one at 2 s was none.
  events.Add(EventKind::kFailureRestored, {{"failure", 1}});
  EXPECT_EQ(Collect(events.list).trials.front().failure_count(), 3u);
}

TEST(TrialRecords, UndoTheNewestFailureOfANumberWhenAServerStartedAgain) {
  Events events;
  events.Add(EventKind::kSessionStarted);
  events.Trial("a", 1).Failed(1, "jump", 1).Finished(3);
  events.Trial("b", 1).Failed(1, "jump", 1).Finished(3);
  events.Add(EventKind::kFailureUndone, {{"failure", 1}});
  const Records records = Collect(events.list);
  EXPECT_EQ(records.trials[0].failure_count(), 1u);
  EXPECT_EQ(records.trials[1].failure_count(), 0u);
}

TEST(TrialRecords, UndoTheFailureOfTheTrialThatIsNamed) {
  Events events;
  events.Add(EventKind::kSessionStarted);
  events.Trial("a", 1).Failed(1, "jump", 1).Finished(3);
  events.Trial("b", 1).Failed(1, "jump", 1).Failed(2, "jump", 2).Finished(3);
  events.Add(EventKind::kFailureUndone, {{"failure", 1}, {"trial", "a1"}});
  const Records records = Collect(events.list);
  EXPECT_EQ(records.trials[0].failure_count(), 0u);
  EXPECT_EQ(records.trials[1].failure_count(), 2u);
  EXPECT_TRUE(FailuresOf(records, "a1").at(0).undone);
  EXPECT_FALSE(FailuresOf(records, "b1").at(0).undone);
  EXPECT_TRUE(FailuresOf(records, "c1").empty());
  EXPECT_EQ(WithFailure(records, 1)->id, "b1");
  EXPECT_EQ(WithFailure(records, 999), nullptr);
}

TEST(TrialRecords, AreSyntheticOnceATrialIs) {
  Events events;
  events.Add(EventKind::kSessionStarted, {{"participant", "P7"}, {"synthetic", false}});
  events.Trial("a", 1).Finished(3);
  EXPECT_FALSE(Collect(events.list).synthetic);
  events.Add(EventKind::kTrialStarted, {{"phase", "b"}, {"synthetic", true}});
  EXPECT_TRUE(Collect(events.list).synthetic);
  EXPECT_TRUE(Collect(events.list).trials[1].synthetic);
}

TEST(TrialRecords, CountTheLastAttemptThatEnded) {
  Events events;
  events.Add(EventKind::kSessionStarted);
  events.Trial("a", 1).Finished(3).Trial("a", 2).Finished(4).Trial("a", 3);
  events.Trial("b", 1);
  const Records records = Collect(events.list);
  EXPECT_EQ(records.trials.size(), 4u);
  EXPECT_EQ(records.trials[2].outcome, "interrupted");
  const auto counting = Counting(records);
  ASSERT_EQ(counting.size(), 1u);
  EXPECT_EQ(counting.front()->time_s, 4);
}

TEST(TrialRecords, DoNotCountAnAttemptThatLostADeviceOrBrokeOff) {
  for (const char* outcome : {kDeviceLost, kBrokenOff}) {
    Events events;
    events.Add(EventKind::kSessionStarted);
    events.Trial("a", 1).Finished(3).Trial("a", 2);
    events.Add(EventKind::kTrialFinished, {{"outcome", outcome}, {"time_s", 1}});
    const Records records = Collect(events.list);
    const auto counting = Counting(records);
    ASSERT_EQ(counting.size(), 1u) << outcome;
    EXPECT_EQ(counting.front()->attempt, 1u) << outcome;
  }
}

TEST(TrialRecords, KeepTheStagesOfResponsesWithTheirTrial) {
  Events events;
  events.Add(EventKind::kSessionStarted);
  events.Trial("a", 1);
  events.Add(EventKind::kResponse, {{"stages_ms", {{"decode", 0.5}, {"contact", 100}}}});
  events.Add(EventKind::kTrialFinished, {{"outcome", "finished"}, {"anticipation_s", 0.25}});
  events.Trial("b", 1).Finished(3);
  const Records records = Collect(events.list);
  ASSERT_EQ(records.trials[0].responses.size(), 1u);
  EXPECT_EQ(records.trials[0].responses[0][1].stage, "contact");
  EXPECT_EQ(records.trials[0].responses[0][1].ms, 100);
  EXPECT_EQ(records.trials[0].anticipation_s, 0.25);
  EXPECT_TRUE(records.trials[1].responses.empty());
  EXPECT_TRUE(std::isnan(records.trials[1].anticipation_s));
}

TEST(Progress, ASurveyGoesOnWithTheItemsThatHaveNoAnswer) {
  plan::Protocol protocol;
  protocol.survey.ratings = {"fun", "like"};
  const auto items = plan::ItemsAfter(protocol, "arm");  // And exertion, good, bad.
  Events events;
  events.Add(EventKind::kRating, {{"interface", "arm"}, {"item", "like"}, {"value", 2}});
  events.Add(EventKind::kExertion, {{"interface", "arm"}, {"item", "exertion"}, {"value", 2}});
  events.Add(EventKind::kAnswer, {{"interface", "arm"}, {"question", "bad"}, {"text", ""}});
  // Another interface, and the same one at the end.
  events.Add(EventKind::kRating, {{"interface", "leg"}, {"item", "fun"}, {"value", 2}});
  events.Add(EventKind::kRating,
             {{"interface", "arm"}, {"item", "fun"}, {"value", 2}, {"at_end", true}});
  const auto left = Unanswered(items, events.list);
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left[0].item, "fun");
  EXPECT_EQ(left[1].item, "good");
}

TEST(Progress, AChoiceIsNotAskedAgain) {
  const auto items = plan::ItemsAtEnd(plan::Protocol(), {"arm", "leg"});
  Events events;
  events.Add(
      EventKind::kAnswer,
      {{"interface", ""}, {"question", plan::kPreferredItem}, {"text", "leg"}, {"at_end", true}});
  const auto left = Unanswered(items, events.list);
  ASSERT_EQ(left.size(), items.size() - 1);
  EXPECT_EQ(left.back().item, "remarks");
  EXPECT_NE(left[left.size() - 2].item, plan::kPreferredItem);
}

TEST(TrialRecords, KeepRatingsAtTheEndApart) {
  Events events;
  events.Add(EventKind::kSessionStarted, {{"participant", "P7"}});
  events.Add(EventKind::kRating, {{"interface", "arm"}, {"item", "fun"}, {"value", 2}});
  events.Add(EventKind::kRating,
             {{"interface", "arm"}, {"item", "fun"}, {"value", 5}, {"at_end", true}});
  events.Add(EventKind::kRating, {{"interface", ""}, {"item", "fun"}, {"value", 1}});
  const Records records = Collect(events.list);
  ASSERT_EQ(records.ratings.size(), 3u);
  EXPECT_FALSE(records.ratings[0].at_end);
  EXPECT_TRUE(records.ratings[1].at_end);
  EXPECT_TRUE(records.ratings[2].at_end);  // Without interface: for the whole study.
}

TEST(TrialRecords, HaveOneRatingPerItemTheLastOne) {
  Events events;
  events.Add(EventKind::kSessionStarted, {{"participant", "P7"}});
  for (const int value : {2, 5}) {
    events.Add(EventKind::kRating, {{"interface", "arm"}, {"item", "fun"}, {"value", value}});
  }
  events.Add(EventKind::kExertion, {{"interface", "arm"}, {"value", 3}});
  const Records records = Collect(events.list);
  ASSERT_EQ(records.ratings.size(), 2u);
  EXPECT_EQ(records.ratings[0].value, 5);
  EXPECT_EQ(records.ratings[1].item, "exertion");
}

}  // namespace
}  // namespace footing::study::records
