#include "clients/view/scene/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/view/scene/model.h"

namespace footing::scene {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

stream::StudyState Trial() {
  return {.study = "Four interfaces",
          .participant = "P07",
          .interface = "wrist",
          .phase = "wrist.straight1",
          .number = 5,
          .phases = 23,
          .doing = "The trial is running.",
          .next = "wrist.straight2",
          .keys = "s stops it",
          .active_s = 750,
          .attempt = 2};
}

TEST(StudyText, SaysWhoWhereWhatAndWhatNext) {
  EXPECT_THAT(StudyLines(Trial(), 0),
              ElementsAre("P07, wrist.straight1, attempt 2 (5 of 23)", "The trial is running.",
                          "next: wrist.straight2; in motion so far 12.5 min", "keys: s stops it"));
}

TEST(StudyText, CountsDownFromWhenItWasSent) {
  stream::StudyState practice = Trial();
  practice.left_s = 125;
  EXPECT_EQ(StudyClock(practice, 0), "2:05");
  EXPECT_EQ(StudyClock(practice, 64.5), "1:01");
  EXPECT_EQ(StudyClock(practice, 500), "0:00");
  EXPECT_EQ(StudyClock(Trial(), 3), "");
}

using stream::StudyActivity;

stream::StudyState Doing(StudyActivity activity, double left_s = 0) {
  stream::StudyState study = Trial();
  study.activity = activity;
  study.left_s = left_s;
  return study;
}

/// Headline, count and detail, with bars between them; "-" for none.
std::string ReadBy(const stream::StudyState& study, double passed_s = 0, bool started = false) {
  const auto text = ParticipantTextOf(study, passed_s, started);
  return text ? text->headline + "|" + text->count + "|" + text->detail : "-";
}

TEST(ParticipantText, SaysInEveryStateWhatToDo) {
  EXPECT_EQ(ReadBy(Doing(StudyActivity::kUnspecified)), "-");  // An older footing-study.
  EXPECT_EQ(ReadBy({}), "-");
  EXPECT_EQ(ReadBy(Doing(StudyActivity::kWait)), "Please wait||");
  EXPECT_EQ(ReadBy(Doing(StudyActivity::kDemonstration)), "Demonstration of the interface wrist||");
  EXPECT_EQ(ReadBy(Doing(StudyActivity::kRanges)), "Move as the experimenter says||");
  EXPECT_EQ(ReadBy(Doing(StudyActivity::kPractice, 125), 5), "Practice|2:00|");
  EXPECT_EQ(ReadBy(Doing(StudyActivity::kGetReady)), "Get ready||The trial begins after 3, 2, 1");
  EXPECT_EQ(ReadBy(Doing(StudyActivity::kFinished)), "Finished||Next: a trial");
  EXPECT_EQ(ReadBy(Doing(StudyActivity::kStopped)), "The trial is over||Next: a trial");
  EXPECT_EQ(ReadBy(Doing(StudyActivity::kSurvey)), "Questions||Please answer the survey");
  for (const auto activity : {StudyActivity::kDemonstration, StudyActivity::kPractice}) {
    EXPECT_TRUE(ParticipantTextOf(Doing(activity), 0, false)->aside);
  }
  EXPECT_FALSE(ParticipantTextOf(Doing(StudyActivity::kRest, 5), 0, false)->aside);
}

TEST(ParticipantText, CountsATrialInAndLeavesTheWorldAlone) {
  const stream::StudyState trial = Doing(StudyActivity::kTrial, 3);
  EXPECT_EQ(ReadBy(trial, 0), "|3|");
  EXPECT_EQ(ReadBy(trial, 0.9), "|3|");
  EXPECT_EQ(ReadBy(trial, 1.1), "|2|");
  EXPECT_EQ(ReadBy(trial, 2.9), "|1|");
  EXPECT_EQ(ReadBy(trial, 3.1), "|Go!|");
  EXPECT_EQ(ReadBy(trial, 4.1), "-");
  EXPECT_EQ(ReadBy(trial, 0.5, /*started=*/true), "-");  // Such as a viewer that comes later.
  EXPECT_EQ(ReadBy(Doing(StudyActivity::kTrial)), "-");  // Unattended: nobody is counted in.
  // The experimenter reads no clock that stands at 0:00 for the whole trial.
  EXPECT_EQ(StudyClock(trial, 1), "0:02");
  EXPECT_EQ(StudyClock(trial, 3.5), "");
}

TEST(ParticipantText, SaysWhatComesNextInWordsOfTheParticipant) {
  stream::StudyState study = Doing(StudyActivity::kFinished);
  const auto next = [&study](const std::string& phase) {
    study.next = phase;
    return ParticipantTextOf(study, 0, false)->detail;
  };
  EXPECT_EQ(next("wrist.test"), "Next: a trial");
  EXPECT_EQ(next("wrist.survey"), "Next: questions about the interface wrist");
  EXPECT_EQ(next("arm.rest"), "Next: a rest");
  EXPECT_EQ(next("arm.demonstration"), "Next: the interface arm");
  EXPECT_EQ(next("final_survey"), "Next: the last questions");
  EXPECT_EQ(next("the end of the session"), "");
  // A planned rest, and one that is due before a phase.
  stream::StudyState rest = Doing(StudyActivity::kRest, 60);
  rest.phase = "arm.rest";
  rest.next = "arm.demonstration";
  EXPECT_EQ(ReadBy(rest, 18), "Rest|0:42|Next: the interface arm");
  rest.phase = "arm.practice";
  EXPECT_EQ(ReadBy(rest, 18), "Rest|0:42|Next: practice of the interface arm");
}

TEST(StudyText, IsOnTheTextScreenOnlyWhileAStudyRuns) {
  Model model;
  Update update;
  update.received_ns = 5;
  update.study = Trial();
  Apply(model, update);
  EXPECT_EQ(model.study.received_ns, 5);
  EXPECT_THAT(StatusScreen(model, 5), testing::Contains(HasSubstr("P07, wrist.straight1")));
  update.study = stream::StudyState{};
  Apply(model, update);
  EXPECT_THAT(StatusScreen(model, 5), testing::Not(testing::Contains(HasSubstr("P07"))));
}

}  // namespace
}  // namespace footing::scene
