#include "daemon/simulation/gait_service/trial_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "common/runtime/files.h"
#include "daemon/simulation/gait_service/config.h"
#include "daemon/simulation/gait_service/gait_run.h"
#include "daemon/simulation/gait_service/publish.h"

namespace footing::gait_service {
namespace {

using testing::HasSubstr;
using testing::Not;

engine::EngineTexts TextsOf(const std::string& track) {
  return *engine_files::ReadTexts({.track = track});
}

/// An engine with its trials, both sides in one thread.
class Line {
 public:
  explicit Line(const std::string& track)
      : run_(engine::GaitEngine::Create(TextsOf(track)).value(), exchange_),
        control_({track, "", *biped::ParseBiped(TextsOf(track).biped, "biped.json"), 0.001},
                 run_.engine().track(), exchange_) {}

  v1::CommandResult Send(const v1::Command& command) {
    const v1::CommandResult result = control_.OnCommand(command);
    if (result.ok()) inputs_.engine.trial = control_.inputs();
    return result;
  }
  v1::CommandResult Start(const std::string& id, const std::string& track,
                          const std::string& task = "", std::uint64_t seed = 0) {
    v1::Command command;
    command.mutable_start_trial()->set_trial(id);
    command.mutable_start_trial()->set_track(track);
    command.mutable_start_trial()->set_task(task);
    command.mutable_start_trial()->set_seed(seed);
    return Send(command);
  }
  v1::CommandResult Stop(const std::string& id) {
    v1::Command command;
    command.mutable_stop_trial()->set_trial(id);
    return Send(command);
  }
  v1::CommandResult Correct(std::uint64_t failure, bool restore, const std::string& reason = "") {
    v1::Command command;
    command.mutable_correct_failure()->set_failure(failure);
    command.mutable_correct_failure()->set_restore(restore);
    command.mutable_correct_failure()->set_reason(reason);
    return Send(command);
  }

  /// So many frames of ten steps; returns the last character.
  v1::Character Run(int frames) {
    v1::CharacterFrame message;
    for (int i = 0; i < frames; ++i) {
      latest_.Write(inputs_);
      for (int step = 0; step < 10; ++step) run_.StepOnSimThread(latest_, frame_);
      run_.FillOnSimThread(frame_);
      for (int event = 0; event < frame_.event_count; ++event) {
        events.push_back(control_.ToEvent(frame_.events[static_cast<std::size_t>(event)], 7));
      }
      for (const v1::Event& event : control_.TakeCorrections(8)) events.push_back(event);
      switched = control_.OnFrame(frame_) || switched;
      message = ToCharacterFrame(frame_, "world", "rig");
      control_.Describe(frame_, *message.mutable_characters(0));
      run_.TakenOnSimThread(frame_);
    }
    return message.characters(0);
  }
  /// A fall by a push, seen to its put-back.
  void Fail() {
    ++inputs_.engine.push_number;
    inputs_.engine.push_impulse_W_ns = {40, 90};
    Run(250);
  }

  std::vector<v1::Event> Events(v1::Event::Kind kind) const {
    std::vector<v1::Event> found;
    for (const v1::Event& event : events) {
      if (event.kind() == kind) found.push_back(event);
    }
    return found;
  }
  TrialControl& control() { return control_; }
  engine::EngineInputs& inputs() { return inputs_.engine; }

  std::vector<v1::Event> events;
  bool switched = false;

 private:
  TrackExchange exchange_;
  GaitRun run_;
  TrialControl control_;
  exchange::Latest<Inputs> latest_;
  Inputs inputs_;
  Frame frame_;
};

TEST(TrialControl, AServerHasATrialWithoutAnIdFromItsStart) {
  Line line("1");
  const v1::Character character = line.Run(10);
  EXPECT_EQ(character.trial().phase(), v1::TrialState::PHASE_READY);
  EXPECT_EQ(character.trial().trial(), "");
  EXPECT_EQ(character.trial().track(), "1");
  EXPECT_GT(character.trial().finish_m(), 80);
}

TEST(TrialControl, StartsATrialOnAnotherTrackAndMarksItInTheStream) {
  Line line("plain");
  line.Run(5);
  ASSERT_TRUE(line.Start("p07-1", "straight", "run_stop", 9).ok());
  const v1::Character character = line.Run(5);
  EXPECT_TRUE(line.switched);
  EXPECT_EQ(line.control().track().number, 2u);
  EXPECT_EQ(line.control().track().tasks.size(), 6u);
  const v1::TrialState& trial = character.trial();
  EXPECT_EQ(trial.trial(), "p07-1");
  EXPECT_EQ(trial.number(), 1u);
  EXPECT_EQ(trial.track(), "straight");
  EXPECT_EQ(trial.seed(), 9u);
  EXPECT_EQ(trial.task(), "run_stop");
  EXPECT_EQ(trial.task_phase(), v1::TrialState::TASK_PHASE_AHEAD);
  EXPECT_EQ(trial.instruction(), "run to the line, then stop");
  EXPECT_NEAR(trial.to_mark_m(), 30, 0.2);
  const auto marks = line.Events(v1::Event::KIND_TRIAL);
  ASSERT_EQ(marks.size(), 1u);
  EXPECT_EQ(marks[0].trial().trial(), "p07-1");
  EXPECT_EQ(marks[0].trial().phase(), v1::TrialState::PHASE_READY);
  EXPECT_EQ(marks[0].text(), "trial ready (p07-1)");
}

TEST(TrialControl, TheSeedDrawsTheTaskOfWhichThereAreSeveral) {
  Line line("straight");
  std::set<std::string> tasks;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    ASSERT_TRUE(line.Start("t", "", "", seed).ok());
    tasks.insert(line.Run(1).trial().task());
  }
  EXPECT_EQ(tasks.size(), 6u);
}

TEST(TrialControl, RefusesWhatItCannotStartAndSaysWhatThereIs) {
  Line line("straight");
  EXPECT_THAT(line.Start("", "1").message(), HasSubstr("1 to 64 letters"));
  EXPECT_THAT(line.Start("a b", "1").message(), HasSubstr("1 to 64 letters"));
  EXPECT_THAT(line.Start(std::string(65, 'a'), "1").message(), HasSubstr("1 to 64 letters"));
  EXPECT_THAT(line.Start("t", "9").message(), HasSubstr("1, 2, 3, 4"));
  EXPECT_THAT(line.Start("t", "9").message(), Not(HasSubstr("path")));  // It takes no file.
  EXPECT_THAT(line.Start("t", "/etc/passwd").message(), HasSubstr("not the name of a built-in"));
  EXPECT_THAT(line.Start("t", "../biped.json").message(), HasSubstr("not the name of a built-in"));
  EXPECT_THAT(line.Start("t", "", "dance").message(), HasSubstr("there are: walk_run, run_walk"));
  EXPECT_EQ(line.Run(3).trial().number(), 0u);
  EXPECT_FALSE(line.switched);
}

TEST(TrialControl, HasSpaceForFourTrialsThatTheEngineHasNotTaken) {
  Line line("straight");
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(line.Start("t" + std::to_string(i), "").ok());
  EXPECT_THAT(line.Start("t4", "").message(), HasSubstr("try again"));
  EXPECT_EQ(line.Run(2).trial().trial(), "t3");
  EXPECT_TRUE(line.Start("t4", "").ok());
}

TEST(TrialControl, StopsTheTrialThatIsNamedOrWhicheverGoesOn) {
  Line line("straight");
  ASSERT_TRUE(line.Start("t1", "").ok());
  line.Run(3);
  EXPECT_THAT(line.Stop("t0").message(), HasSubstr("\"t1\""));
  EXPECT_EQ(line.Run(3).trial().phase(), v1::TrialState::PHASE_READY);
  EXPECT_TRUE(line.Stop("t1").ok());
  EXPECT_EQ(line.Run(3).trial().phase(), v1::TrialState::PHASE_STOPPED);
  ASSERT_TRUE(line.Start("t2", "").ok());
  EXPECT_TRUE(line.Stop("").ok());  // Before the engine has begun it.
  const v1::TrialState trial = line.Run(3).trial();
  EXPECT_EQ(trial.trial(), "t2");
  EXPECT_EQ(trial.phase(), v1::TrialState::PHASE_STOPPED);
  const auto marks = line.Events(v1::Event::KIND_TRIAL);
  ASSERT_EQ(marks.size(), 4u);  // Ready and stopped, twice.
  EXPECT_EQ(marks[2].trial().phase(), v1::TrialState::PHASE_READY);
  EXPECT_EQ(marks[2].trial().trial(), "t2");
}

TEST(TrialControl, StopsNothingWhereNoTrialGoesOn) {
  Line line("straight");
  line.Run(1);
  EXPECT_EQ(line.Stop("").message(), "stop_trial: no trial is ready or running");
  ASSERT_TRUE(line.Start("t1", "").ok());
  line.Run(3);
  ASSERT_TRUE(line.Stop("").ok());
  const std::string over = "stop_trial: no trial is ready or running: \"t1\" is over";
  EXPECT_EQ(line.Stop("").message(), over) << "before the engine has seen it";
  line.Run(3);
  EXPECT_EQ(line.Stop("t1").message(), over);
}

TEST(TrialControl, KnowsWhetherATrialGoesOn) {
  Line line("straight");
  line.Run(1);
  EXPECT_TRUE(line.control().CheckNoneGoesOn().ok()) << "the server's first one waits";
  ASSERT_TRUE(line.Start("t1", "").ok());
  EXPECT_FALSE(line.control().CheckNoneGoesOn().ok()) << "on its way";
  line.Run(3);
  const auto ready = line.control().CheckNoneGoesOn();
  ASSERT_FALSE(ready.ok());
  EXPECT_THAT(ready.error().message, HasSubstr("(t1)"));
  ASSERT_TRUE(line.Stop("t1").ok());
  EXPECT_TRUE(line.control().CheckNoneGoesOn().ok());
  line.Run(3);
  EXPECT_TRUE(line.control().CheckNoneGoesOn().ok());
}

TEST(TrialControl, TheFirstTrialGoesOnFromItsStartLine) {
  Line line("straight");
  line.inputs().direct = true;
  line.inputs().direct_command = {stream::Gait::kRun, 3, 0, 0};
  for (int i = 0; i < 100 && line.Run(5).trial().phase() == v1::TrialState::PHASE_READY; ++i) {
  }
  ASSERT_EQ(line.Run(1).trial().phase(), v1::TrialState::PHASE_RUNNING);
  EXPECT_THAT(line.control().CheckNoneGoesOn().error().message, HasSubstr("a trial is ready"));
}

TEST(TrialControl, AFailureIsPublishedWithItsTrialPlaceAndNumber) {
  Line line("1");
  ASSERT_TRUE(line.Start("t1", "1").ok());
  line.Run(100);
  line.Fail();
  const auto falls = line.Events(v1::Event::KIND_FALL);
  ASSERT_EQ(falls.size(), 1u);
  EXPECT_EQ(falls[0].failure().number(), 1u);
  EXPECT_EQ(falls[0].failure().trial(), "t1");
  EXPECT_EQ(falls[0].failure().cause(), falls[0].failure_cause());
  EXPECT_NE(falls[0].failure().cause(), v1::FAILURE_CAUSE_UNSPECIFIED);
  EXPECT_GT(falls[0].failure().position_m().z(), 0.1);
  EXPECT_EQ(line.Run(1).trial().failed_attempts(), 1u);
}

TEST(TrialControl, AWithdrawnFailureStaysInTheStreamAndOutOfTheCounts) {
  Line line("1");
  ASSERT_TRUE(line.Start("t1", "1").ok());
  line.Run(100);
  line.Fail();
  line.Fail();
  v1::Character character = line.Run(1);
  ASSERT_EQ(character.trial().failed_attempts(), 2u);
  ASSERT_EQ(character.gait().falls(), 2u);

  ASSERT_TRUE(line.Correct(2, false, "somebody pushed").ok());
  character = line.Run(1);
  EXPECT_EQ(character.trial().failed_attempts(), 1u);
  EXPECT_EQ(character.trial().withdrawn_failures(), 1u);
  EXPECT_EQ(character.gait().falls(), 1u);
  const auto corrections = line.Events(v1::Event::KIND_CORRECTION);
  ASSERT_EQ(corrections.size(), 1u);
  EXPECT_EQ(corrections[0].failure().number(), 2u);
  EXPECT_TRUE(corrections[0].failure().withdrawn());
  EXPECT_THAT(corrections[0].text(), HasSubstr("withdrawn: somebody pushed"));
  EXPECT_EQ(line.Events(v1::Event::KIND_FALL).size(), 2u);

  EXPECT_THAT(line.Correct(2, false).message(), HasSubstr("already"));
  EXPECT_THAT(line.Correct(9, false).message(), HasSubstr("the last one is 2"));
  EXPECT_TRUE(line.Correct(2, true).ok());
  EXPECT_EQ(line.Run(1).trial().failed_attempts(), 2u);
  EXPECT_EQ(line.Events(v1::Event::KIND_CORRECTION).size(), 2u);
}

TEST(TrialControl, ACorrectionOfAnEarlierTrialLeavesThePresentOneAlone) {
  Line line("1");
  ASSERT_TRUE(line.Start("t1", "1").ok());
  line.Run(100);
  line.Fail();
  ASSERT_TRUE(line.Start("t2", "1").ok());
  line.Run(100);
  line.Fail();
  ASSERT_TRUE(line.Correct(1, false).ok());
  const v1::Character character = line.Run(1);
  EXPECT_EQ(character.trial().failed_attempts(), 1u);
  EXPECT_EQ(character.trial().withdrawn_failures(), 0u);
  EXPECT_EQ(character.gait().falls(), 1u);
}

}  // namespace
}  // namespace footing::gait_service
