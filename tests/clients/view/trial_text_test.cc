#include "clients/view/scene/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

stream::Track StudyTrack() {
  stream::Track track = made::StraightTrack(66);
  track.mark_m = 30;
  track.finish_m = 60;
  track.tasks = {
      {"walk_stop", stream::Gait::kWalk, stream::Gait::kStep, "walk to the line, then stop"}};
  return track;
}

stream::TrialState RunningTrial() {
  stream::TrialState trial;
  trial.trial = "p07-2";
  trial.finish_m = 60;
  trial.task = "walk_stop";
  trial.instruction = "walk to the line, then stop";
  trial.to_mark_m = 11.6;
  trial.progress.phase = stream::TrialPhase::kRunning;
  trial.progress.time_s = 12.34;
  trial.progress.distance_m = 18.4;
  trial.progress.lateral_offset_m = -0.25;
  trial.progress.on_track = true;
  trial.progress.failures = {0, 0, 0, 2, 1};
  trial.progress.task_phase = stream::TaskPhase::kAhead;
  return trial;
}

TEST(TrialStage, SaysGoAtTheStartAndTheTimeAtTheFinish) {
  stream::TrialState trial = RunningTrial();
  EXPECT_FALSE(TrialStage(trial)) << "the trial is under way";
  trial.progress.time_s = 0.3;
  EXPECT_EQ(TrialStage(trial)->count, "Go!");
  trial.progress.time_s = 41.23;
  trial.progress.phase = stream::TrialPhase::kFinished;
  EXPECT_EQ(TrialStage(trial)->count, "41.2 s");
  EXPECT_THAT(TrialStage(trial)->detail, HasSubstr("failed attempts 3"));
  EXPECT_TRUE(TrialStage(trial)->aside) << "the character is still to be seen";
  trial.progress.phase = stream::TrialPhase::kStopped;
  EXPECT_FALSE(TrialStage(trial));
  trial.finish_m = 0;
  trial.progress.phase = stream::TrialPhase::kRunning;
  trial.progress.time_s = 0.3;
  EXPECT_FALSE(TrialStage(trial)) << "an endless track has neither";
}

TEST(TrialText, AnnouncesTheTaskBeforeTheMarkAndCommandsItBehind) {
  stream::TrialState trial = RunningTrial();
  EXPECT_EQ(TaskText(trial, StudyTrack()), "walk to the line, then stop: 12 m");
  trial.progress.task_phase = stream::TaskPhase::kDue;
  EXPECT_EQ(TaskText(trial, StudyTrack()), "now stop");
  trial.progress.task_phase = stream::TaskPhase::kDone;
  EXPECT_EQ(TaskText(trial, StudyTrack()), "stop: done");
  trial.progress.task_phase = stream::TaskPhase::kUnspecified;
  EXPECT_EQ(TaskText(trial, StudyTrack()), "");
}

TEST(TrialText, CountsFailuresByKindApartFromWithdrawnOnesAndPutBacks) {
  stream::TrialState trial = RunningTrial();
  EXPECT_EQ(AttemptText(trial), "failed attempts 3 (straightness 2, transition 1)");
  trial.withdrawn_failures = 1;
  trial.progress.operator_put_backs = 2;
  EXPECT_EQ(AttemptText(trial),
            "failed attempts 3 (straightness 2, transition 1), withdrawn 1, put back by the "
            "operator 2");
}

TEST(TrialText, NamesTheTrialItsStateAndItsTime) {
  stream::TrialState trial = RunningTrial();
  EXPECT_EQ(TrialTitle(trial), "trial p07-2 running 12.3 s");
  trial.trial = "";
  trial.progress.phase = stream::TrialPhase::kReady;
  EXPECT_EQ(TrialTitle(trial), "trial ready");
  trial.progress.phase = stream::TrialPhase::kFinished;
  EXPECT_EQ(TrialTitle(trial), "trial finished 12.3 s");
}

TEST(TrialText, IsOnTheScreenAndInTheLogLine) {
  Model model = made::ModelAfter(2, {});
  Update update = made::TickAt(2.01, {});
  update.track = StudyTrack();
  update.frame->characters[0].trial = RunningTrial();
  Apply(model, update);
  const auto screen = StatusScreen(model, made::ClockAt(2.01));
  EXPECT_THAT(screen, Contains(AllOf(HasSubstr("trial p07-2 running"), HasSubstr("18.4 of 60.0 m"),
                                     HasSubstr("0.25 m right of the line"))));
  EXPECT_THAT(screen, Contains(HasSubstr("straightness 2, transition 1")));
  EXPECT_THAT(screen, Contains(HasSubstr("walk to the line, then stop: 12 m")));
  EXPECT_THAT(StatusLine(model, made::ClockAt(2.01)),
              AllOf(HasSubstr("trial p07-2 running 12.3 s"), HasSubstr("then stop: 12 m")));
}

TEST(TrialText, OfATrialWithoutAnIdAndAFinishLineIsNotShown) {
  stream::TrialState practice;
  practice.progress.phase = stream::TrialPhase::kRunning;
  EXPECT_FALSE(ShowsTrial(practice));
  practice.finish_m = 60;
  EXPECT_TRUE(ShowsTrial(practice));
}

TEST(TrialText, InAStudyIsOfThePhaseAndTheAttemptThatItIsIn) {
  CharacterPose pose;
  stream::StudyState study;
  EXPECT_EQ(ShownTrial(pose, study), nullptr);
  pose.trial = RunningTrial();
  EXPECT_EQ(ShownTrial(pose, study), &*pose.trial);  // Without a study, any.
  study.participant = "P07";
  study.phase = "wrist.straight1";
  study.attempt = 2;
  const auto shows = [&](const std::string& id) {
    pose.trial->trial = id;
    return ShownTrial(pose, study) != nullptr;
  };
  EXPECT_TRUE(shows("P07.wrist.straight1.2"));
  // Progress of practice and of an earlier attempt goes on behind the prompt of this one.
  EXPECT_FALSE(shows("P07.wrist.practice"));
  EXPECT_FALSE(shows("P07.wrist.straight1.1"));
  EXPECT_FALSE(shows("P07.wrist.straight1.20"));
  study.phase = "wrist.practice";
  study.attempt = 0;
  EXPECT_TRUE(shows("P07.wrist.practice"));
}

TEST(TrialText, OfAnotherPhaseOfTheStudyIsNotOnTheTextScreen) {
  Model model = made::ModelAfter(3, {});
  Update update = made::TickAt(3.01, {});
  update.frame->characters.front().trial = RunningTrial();
  Apply(model, update);
  EXPECT_THAT(StatusScreen(model, made::ClockAt(3.01)),
              Contains(HasSubstr("p07-2 running 12.3 s")));
  model.study.state.participant = "P08";
  EXPECT_THAT(StatusScreen(model, made::ClockAt(3.01)), Not(Contains(HasSubstr("running 12.3 s"))));
  EXPECT_THAT(StatusLine(model, made::ClockAt(3.01)), Not(HasSubstr("running 12.3 s")));
}

}  // namespace
}  // namespace footing::scene
