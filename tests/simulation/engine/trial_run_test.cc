#include <cmath>

#include "daemon/simulation/engine/track_world.h"
#include "daemon/simulation/biped/track.h"
#include "tests/simulation/allocations.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::FailureCause;
using stream::Gait;
using stream::TaskPhase;
using stream::TrialPhase;

GaitEngine EngineOnTrack(const std::string& text) {
  EngineTexts texts = Texts();
  texts.track = text;
  Result<GaitEngine> engine = GaitEngine::Create(texts);
  EXPECT_TRUE(engine.ok()) << (engine.ok() ? "" : engine.error().message);
  return std::move(engine).value();
}

GaitEngine EngineOnFile(const std::string& name) {
  return EngineOnTrack(test::DataFile("tracks/" + name + ".json"));
}

/// All events of a run, with the step's output in which they happened.
struct Seen {
  std::vector<EngineEvent> events;

  std::function<void(const EngineOutput&)> Look() {
    return [this](const EngineOutput& output) {
      events.insert(events.end(), output.events.begin(),
                    output.events.begin() + output.event_count);
    };
  }
  int Count(EventKind kind) const {
    return static_cast<int>(
        std::count_if(events.begin(), events.end(),
                      [kind](const EngineEvent& event) { return event.kind == kind; }));
  }
  const EngineEvent* First(EventKind kind) const {
    for (const EngineEvent& event : events) {
      if (event.kind == kind) return &event;
    }
    return nullptr;
  }
};

int TaskIndex(const GaitEngine& engine, const std::string& name) {
  for (std::size_t i = 0; i < engine.track().tasks.size(); ++i) {
    if (engine.track().tasks[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

constexpr const char* kShortTrack =
    R"({"version": 1, "finish_m": 9, "segments": [{"length_m": 13}]})";

TEST(TrialRun, ARunOverTheFinishLineEndsItOnceWithItsTime) {
  GaitEngine engine = EngineOnTrack(kShortTrack);
  Seen seen;
  Simulate(engine, Direct(Command(Gait::kWalk, 1)), 20, seen.Look());
  EXPECT_EQ(seen.Count(EventKind::kTrialRunning), 1);
  ASSERT_EQ(seen.Count(EventKind::kTrialFinished), 1);
  const EngineEvent& finished = *seen.First(EventKind::kTrialFinished);
  EXPECT_NEAR(finished.trial.distance_m, 9, 0.01);
  EXPECT_NEAR(finished.trial.time_s, 8, 0.8);  // From 1 m to 9 m at 1 m/s, from standing.
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kFinished);
  EXPECT_EQ(engine.Output().trial.time_s, finished.trial.time_s);
}

TEST(TrialRun, WalkingPastTheEndBehindTheFinishLineIsNotAFailure) {
  GaitEngine engine = EngineOnTrack(kShortTrack);
  Seen seen;
  Simulate(engine, Direct(Command(Gait::kWalk, 1)), 30, seen.Look());
  EXPECT_EQ(seen.Count(EventKind::kFall), 0);
  EXPECT_GE(seen.Count(EventKind::kPutBack), 1);  // It went over the end and stands again.
  EXPECT_EQ(engine.Output().gait.falls, 0u);
  EXPECT_EQ(engine.Output().gait.operator_put_backs, 0u);
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kFinished);
}

TEST(TrialRun, BeginsAtTheStartAndCountsForItselfAlone) {
  GaitEngine engine = EngineOnFile("pits");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1));
  Simulate(engine, inputs, 5);
  Push(inputs, 30, 90);
  Simulate(engine, inputs, 4);
  ASSERT_EQ(engine.Output().trial.failures.curve + engine.Output().trial.failures.simulation, 1u);
  inputs.trial.number = 1;
  Seen seen;
  Simulate(engine, inputs, 0.01, seen.Look());
  ASSERT_EQ(seen.Count(EventKind::kTrialReady), 1);
  EXPECT_EQ(seen.First(EventKind::kTrialReady)->trial_number, 1u);
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kReady);
  EXPECT_NEAR(engine.Output().trial.distance_m, 0, 0.05);
  EXPECT_EQ(engine.Output().trial.failures, stream::FailureCounts{});
  EXPECT_EQ(engine.Output().gait.falls, 1u);  // The server's count goes on.
  Simulate(engine, inputs, 3, seen.Look());
  EXPECT_EQ(seen.Count(EventKind::kTrialReady), 1);  // The same inputs begin it once.
  inputs.trial.stopped_below = 2;
  Simulate(engine, inputs, 1, seen.Look());
  EXPECT_EQ(seen.Count(EventKind::kTrialStopped), 1);
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kStopped);
}

TEST(TrialRun, AFailureHasItsPlaceItsTimeAndItsNumber) {
  GaitEngine engine = EngineOnFile("pits");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1, 0.2, 0.08));
  inputs.trial.number = 1;
  Seen seen;
  Simulate(engine, inputs, 14, seen.Look());
  ASSERT_GE(seen.Count(EventKind::kFall), 2);
  const EngineEvent& fall = *seen.First(EventKind::kFall);
  EXPECT_EQ(fall.cause, FailureCause::kCurve) << fall.text;
  EXPECT_EQ(fall.failure_number, 1u);
  EXPECT_TRUE(fall.in_trial);
  EXPECT_GT(fall.trial.lateral_offset_m, 1.5);  // To the left, where it turned to.
  EXPECT_GT(fall.trial.heading_error_rad, 0.5);
  EXPECT_GT(fall.trial.time_s, 1);
  EXPECT_NEAR(fall.p_WC_m.y(), fall.trial.lateral_offset_m, 0.3);
  EXPECT_EQ(seen.events.back().trial_number, 1u);
}

TEST(TrialRun, AnOperatorsPutBackIsNotAFailure) {
  GaitEngine engine = EngineOnFile("1");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1));
  Simulate(engine, inputs, 5);
  inputs.put_back_number = 1;
  Simulate(engine, inputs, 1);
  EXPECT_EQ(engine.Output().trial.operator_put_backs, 1u);
  EXPECT_EQ(engine.Output().trial.failures, stream::FailureCounts{});
  EXPECT_EQ(engine.Output().gait.falls, 0u);
}

TEST(TrialRun, LeavingTheStraightTrackIsStraightnessAndItGoesOn) {
  GaitEngine engine = EngineOnFile("straight");
  EngineInputs inputs = Direct(Command(Gait::kRun, 2.5, 0.2, 0.02));
  inputs.trial = {.number = 1, .task = TaskIndex(engine, "run_walk")};
  Seen seen;
  Simulate(engine, inputs, 12, seen.Look());
  ASSERT_GE(seen.Count(EventKind::kFall), 1);
  EXPECT_EQ(seen.First(EventKind::kFall)->cause, FailureCause::kStraightness);
  EXPECT_GE(engine.Output().gait.failures.straightness, 1u);
  EXPECT_EQ(engine.Output().trial.failures, engine.Output().gait.failures);
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kRunning);
}

TEST(TrialRun, ATaskDoneAtTheLineIsAnnouncedAndTheTrialFinishes) {
  GaitEngine engine = EngineOnFile("straight");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1.3));
  inputs.trial = {.number = 1, .task = TaskIndex(engine, "walk_run")};
  Seen seen;
  for (int i = 0; i < 400 && engine.Output().trial.phase != TrialPhase::kFinished; ++i) {
    const bool crossed = engine.Output().trial.distance_m > 30;
    inputs.direct_command = crossed ? Command(Gait::kRun, 2.5) : Command(Gait::kWalk, 1.3);
    Simulate(engine, inputs, 0.1, seen.Look());
  }
  ASSERT_EQ(seen.Count(EventKind::kTaskDone), 1);
  EXPECT_GT(seen.First(EventKind::kTaskDone)->trial.distance_m, 31);
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kFinished);
  EXPECT_EQ(engine.Output().trial.failures, stream::FailureCounts{});
}

TEST(TrialRun, AMissedTaskIsATransitionAndThePutBackIsBeforeTheLine) {
  GaitEngine engine = EngineOnFile("straight");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1.4));
  inputs.trial = {.number = 1, .task = TaskIndex(engine, "walk_run")};
  Seen seen;
  double back_at_m = -1;
  Simulate(engine, inputs, 40, [&](const EngineOutput& output) {
    seen.Look()(output);
    for (int i = 0; i < output.event_count; ++i) {
      const bool back = output.events[static_cast<std::size_t>(i)].kind == EventKind::kPutBack;
      if (back && back_at_m < 0) back_at_m = output.trial.distance_m;
    }
  });
  ASSERT_GE(seen.Count(EventKind::kFall), 1);
  EXPECT_EQ(seen.First(EventKind::kFall)->cause, FailureCause::kTransition);
  EXPECT_NEAR(seen.First(EventKind::kFall)->trial.distance_m, 45, 0.1);
  EXPECT_NEAR(back_at_m, 30 - trial::kRunUpM, 0.1);
}

/// A walk up to a pit without a jump: with help the steps are fitted to it.
std::uint64_t FailuresAtAPit(bool help) {
  std::uint64_t failures = 0;
  for (int i = 0; i < 6; ++i) {
    GaitEngine engine = EngineOnTrack(
        std::string(R"({"version": 1, "help_over_pits": )") + (help ? "true" : "false") +
        R"(, "segments": [{"length_m": )" + std::to_string(12 + 0.2 * i) +
        R"(}, {"length_m": 0.5, "pit": true}, {"length_m": 20}]})");
    Simulate(engine, Direct(Command(Gait::kRun, 2.5)), 9);
    failures += engine.Output().gait.failures.jump;
  }
  return failures;
}

TEST(TrialRun, HelpOverPitsIsASettingOfTheTrack) {
  EXPECT_EQ(FailuresAtAPit(true), 0u);
  EXPECT_GE(FailuresAtAPit(false), 2u);
}

TEST(TrialRun, AnotherTrackTakesOverWhileTimeAndCountsGoOn) {
  GaitEngine engine = EngineOnFile("pits");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1));
  inputs.put_back_number = 1;
  Push(inputs, 1, 0);
  Simulate(engine, inputs, 4);
  stream::Track next = terrain::ParseTrack(test::DataFile("tracks/2.json"), "2").value();
  next.number = 2;
  auto world = MakeTrackWorld(next, test::Biped(), EngineConfig{}.step_s).value();
  const long before = test::Allocations();
  engine.UseTrack(*world);
  inputs.trial = {.number = 1, .task = -1, .stopped_below = 0, .track_number = 2};
  for (int i = 0; i < 2000; ++i) engine.Advance(inputs);
  EXPECT_EQ(test::Allocations(), before);
  const EngineOutput& output = engine.Output();
  EXPECT_EQ(output.track_number, 2u);
  EXPECT_EQ(world->track.number, 1u);  // The former one came back.
  EXPECT_EQ(output.step, 6000u);
  EXPECT_EQ(output.gait.operator_put_backs, 1u);
  EXPECT_EQ(output.gait.falls, 0u);
  EXPECT_GT(output.trial.distance_m, 0.5);
  EXPECT_LT(output.trial.distance_m, 3);
  EXPECT_TRUE(output.trial.on_track);
}

TEST(TrialRun, ATrackThatTookOverRunsAsIfTheEngineHadBegunOnIt) {
  GaitEngine fresh = EngineOnFile("2"), switched = EngineOnFile("plain");
  auto world = MakeTrackWorld(terrain::ParseTrack(test::DataFile("tracks/2.json"), "2").value(),
                              test::Biped(), EngineConfig{}.step_s)
                   .value();
  switched.UseTrack(*world);
  const EngineInputs inputs = Direct(Command(Gait::kRun, 2));
  Simulate(fresh, inputs, 3);
  Simulate(switched, inputs, 3);
  EXPECT_EQ(switched.Output().state_hash, fresh.Output().state_hash);
}

}  // namespace
}  // namespace footing::engine
