#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <mujoco/mujoco.h>

#include "common/base/text.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/engine/state.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::Gait;

std::vector<EngineEvent> EventsOf(const EngineOutput& output) {
  return {output.events.begin(), output.events.begin() + output.event_count};
}

TEST(Engine, TheSameInputsGiveTheSameHashAfterSixtySeconds) {
  const auto hash = [] {
    GaitEngine engine = NewEngine();
    for (const Gait gait : {Gait::kWalk, Gait::kRun, Gait::kJump, Gait::kStep}) {
      EngineInputs inputs = Direct(Command(gait, 1));
      Push(inputs, 1, 2);
      Simulate(engine, inputs, 15);
    }
    return engine.Output().state_hash;
  };
  EXPECT_EQ(hash(), hash());
}

TEST(Engine, ARestoredStateGoesOnBitForBitInAnotherEngine) {
  GaitEngine first = NewEngine(), second = NewEngine();
  const EngineInputs inputs = Direct(Command(Gait::kRun, 2.2, 0.2, 0.05));
  Simulate(first, inputs, 4.321);
  second.Restore(first.Save());
  Simulate(first, inputs, 5);
  Simulate(second, inputs, 5);
  EXPECT_EQ(second.Output().state_hash, first.Output().state_hash);
  EXPECT_EQ(second.Output().gait.steps, first.Output().gait.steps);
}

TEST(Engine, ReplayedForcesLeadBareStepsToTheSameHash) {
  GaitEngine engine = NewEngine();
  physics::World bare = test::LevelWorld();
  for (const Gait gait : {Gait::kWalk, Gait::kRun, Gait::kJump}) {
    const EngineInputs inputs = Direct(Command(gait, 0.75));
    Simulate(engine, inputs, 3.333);
    bare.Restore(engine.Save().world);
    Simulate(engine, inputs, 1, [&](const EngineOutput& output) {
      bare.StepBare(output.joint_efforts, output.push_W_n);
    });
    EXPECT_EQ(bare.StateHash(), engine.Output().state_hash) << Name(gait);
  }
}

/// The hash as a user of MuJoCo computes it: FNV-1a over the words of the state, each as its bytes.
std::uint64_t HashOf(const mjModel& model, const mjData& data) {
  std::uint64_t hash = text::kFnvBasis;
  const auto add = [&hash](const mjtNum* words, int count) {
    for (int i = 0; i < count; ++i) {
      hash = text::AddFnv(hash, std::bit_cast<std::uint64_t>(words[i]));
    }
  };
  add(data.qpos, model.nq);
  add(data.qvel, model.nv);
  add(data.qacc_warmstart, model.nv);
  return hash;
}

/// MuJoCo alone, from the file: under the engine's efforts it walks as the engine does, falls
/// included. How many of the engine's steps, 0 to `steps`, had the same hash before one differed.
int StepsAsTheEngine(const std::string& track, int steps) {
  EngineTexts texts = Texts();
  texts.track = test::DataFile("tracks/" + track + ".json");
  const auto mjcf = ExportMjcf(texts, {}, "a test");
  EXPECT_TRUE(mjcf.ok());
  const std::string path = testing::TempDir() + "footing_" + track + ".xml";
  std::ofstream(path) << *mjcf;
  char reason[1000] = "";
  const physics::ModelPointer model(mj_loadXML(path.c_str(), nullptr, reason, sizeof reason));
  std::filesystem::remove(path);
  EXPECT_NE(model, nullptr) << reason;
  if (!model) return -1;
  const physics::StatePointer data(mj_makeData(model.get()));
  mj_resetDataKeyframe(model.get(), data.get(), 0);
  mj_forward(model.get(), data.get());
  const int body = mj_name2id(model.get(), mjOBJ_BODY, "body");

  GaitEngine engine = std::move(GaitEngine::Create(texts)).value();
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1));
  for (int i = 0; i < steps; ++i) {
    if (i == 1500) Push(inputs, 2, 4);
    if (i == 3000) inputs.direct_command = Command(Gait::kRun, 2);
    engine.Advance(inputs);
    const EngineOutput& output = engine.Output();
    std::copy(output.joint_efforts.begin(), output.joint_efforts.end(), data->ctrl);
    std::copy(output.push_W_n.data(), output.push_W_n.data() + 3, data->xfrc_applied + 6 * body);
    mj_step(model.get(), data.get());
    if (HashOf(*model, *data) != output.state_hash) return i;
  }
  return steps;
}

TEST(ExportedWorld, IsSteppedByMuJoCoAloneToTheEnginesHashes) {
  for (const char* track : {"endless", "straight", "hills", "1", "pits"}) {
    EXPECT_EQ(StepsAsTheEngine(track, 6000), 6000) << track;
  }
}

/// `--gaits paper`: each gait at a speed between its slow and its fast set, pushed by 2 N s.
TEST(PaperGaits, StepWalkRunAndJumpWithoutAFall) {
  EngineTexts texts = Texts();
  for (const char* name : kPaperGainFiles) texts.gains.push_back({name, test::DataFile(name)});
  for (const auto& command :
       {Command(stream::Gait::kStep, 0), Command(stream::Gait::kWalk, 0.9),
        Command(stream::Gait::kRun, 2.5), Command(stream::Gait::kJump, 0.5)}) {
    auto engine = GaitEngine::Create(texts);
    ASSERT_TRUE(engine.ok()) << engine.error().message;
    EngineInputs inputs = Direct(command);
    Simulate(*engine, inputs, 5);
    Push(inputs, 1, 1.7);
    Simulate(*engine, inputs, 5);
    EXPECT_EQ(engine->Output().gait.falls, 0u) << stream::Name(command.gait);
    EXPECT_EQ(engine->Output().gait.gait, command.gait);
    const double from_m = engine->Output().gait.distance_m;
    Simulate(*engine, inputs, 5);
    EXPECT_NEAR((engine->Output().gait.distance_m - from_m) / 5, command.speed_mps, 0.15);
  }
}

TEST(Engine, SimulationTimeIsTheStepTimesH) {
  GaitEngine engine = NewEngine();
  Simulate(engine, {}, 1.234);
  EXPECT_EQ(engine.Output().step, 1234u);
  EXPECT_EQ(engine.Output().time_s, 1234 * 0.001);
}

TEST(Engine, AFallIsShownThenPutBackThreeMetresBehindItsPlace) {
  GaitEngine engine = NewEngine();
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1));
  Simulate(engine, inputs, 9);
  Push(inputs, 10, 90);
  double fallen_s = 0, back_s = 0, fallen_x_m = 0;
  Simulate(engine, inputs, 8, [&](const EngineOutput& output) {
    for (const EngineEvent& event : EventsOf(output)) {
      if (event.kind == EventKind::kFall) {
        fallen_s = output.time_s;
        fallen_x_m = output.links[0].position_m.x();
      }
      if (event.kind == EventKind::kPutBack) {
        back_s = output.time_s;
        EXPECT_NEAR(output.links[0].position_m.x(), fallen_x_m - 3, 0.02);
        EXPECT_NEAR(output.links[0].position_m.y(), 0, 1e-3);
        EXPECT_EQ(output.gait.gait, Gait::kWalk);  // From its first step it obeys again.
      }
    }
  });
  ASSERT_GT(fallen_s, 9);
  EXPECT_NEAR(back_s - fallen_s, 0.7, 0.0025);
  EXPECT_EQ(engine.Output().gait.falls, 1u);
  EXPECT_GT(engine.Output().links[0].position_m.z(), kLowestBodyM);
  EXPECT_EQ(engine.Output().root_force_max_n, 0);
}

TEST(Engine, APutBackOnRequestIsCountedApartFromFallsAndDoneOnce) {
  GaitEngine engine = NewEngine();
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1));
  Simulate(engine, inputs, 8);
  const double x_m = engine.Output().links[0].position_m.x();
  inputs.put_back_number = 1;
  Simulate(engine, inputs, 0.05);
  EXPECT_NEAR(engine.Output().links[0].position_m.x(), x_m - 3, 0.1);
  Simulate(engine, inputs, 3);
  EXPECT_EQ(engine.Output().gait.falls, 0u);
  EXPECT_EQ(engine.Output().gait.operator_put_backs, 1u);
  EXPECT_EQ(engine.Output().gait.failures, stream::FailureCounts{});
}

TEST(Engine, NonsenseCommandsMeanSteppingAndPublishNothingThatIsNotFinite) {
  GaitEngine engine = NewEngine();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EngineInputs inputs = Direct({Gait::kRun, nan, nan, nan});
  Push(inputs, nan, 1e300);
  Simulate(engine, inputs, 2);
  const EngineOutput& output = engine.Output();
  EXPECT_EQ(output.gait.commanded_gait, Gait::kStep);
  EXPECT_EQ(output.gait.falls, 0u);
  for (const auto& link : output.links) {
    EXPECT_TRUE(link.position_m.allFinite() && link.orientation.coeffs().allFinite());
  }
}

TEST(Engine, TurnsFiveDegreesAStep) {
  GaitEngine engine = NewEngine();
  const double turn_rad = 5 * M_PI / 180;
  const EngineInputs inputs = Direct(Command(Gait::kWalk, 0.8, 0.2, turn_rad));
  Simulate(engine, inputs, 3);
  const auto steps = engine.Output().gait.steps;
  const double heading_rad = engine.Output().gait.heading_rad;
  Simulate(engine, inputs, 3);
  const EngineOutput& output = engine.Output();
  const double expected_rad = turn_rad * static_cast<double>(output.gait.steps - steps);
  EXPECT_NEAR(std::remainder(output.gait.heading_rad - heading_rad - expected_rad, 2 * M_PI), 0,
              1e-9);
  EXPECT_GT(output.gait.steps - steps, 6u);
  const Eigen::Vector3d ahead = output.links[0].orientation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::remainder(std::atan2(ahead.y(), ahead.x()) - output.gait.heading_rad, 2 * M_PI),
              0, 0.15);
  EXPECT_EQ(output.gait.falls, 0u);
}

TEST(Engine, SaysWhenACommandWasGivenAndWhenTakenOver) {
  GaitEngine engine = NewEngine();
  Simulate(engine, {}, 2);
  EngineInputs inputs = Direct(Command(Gait::kRun, 2));
  inputs.features_number = 0;
  std::vector<EventKind> kinds;
  std::uint64_t taken_over = 0;
  Simulate(engine, inputs, 2, [&](const EngineOutput& output) {
    for (const EngineEvent& event : EventsOf(output)) {
      if (event.kind != EventKind::kTrialRunning) kinds.push_back(event.kind);
      if (event.kind == EventKind::kGaitTakenOver) taken_over = output.step;
    }
  });
  EXPECT_EQ(kinds, (std::vector{EventKind::kGaitCommanded, EventKind::kGaitChanged,
                                EventKind::kGaitTakenOver}));
  EXPECT_EQ(engine.Output().response.commanded, 2001u);
  EXPECT_EQ(engine.Output().response.taken_over, taken_over);
}

TEST(Engine, RefusesAWrongFileByName) {
  EngineTexts texts = Texts();
  texts.biped = "{}";
  const auto engine = GaitEngine::Create(texts);
  ASSERT_FALSE(engine.ok());
  EXPECT_NE(engine.error().message.find("biped.json"), std::string::npos);
}

using stream::FailureCause;

GaitEngine EngineOn(const std::string& track) {
  EngineTexts texts = Texts();
  texts.track = track;
  Result<GaitEngine> engine = GaitEngine::Create(texts);
  EXPECT_TRUE(engine.ok()) << (engine.ok() ? "" : engine.error().message);
  return std::move(engine).value();
}

/// The first failure within so many seconds; an event without a text when there is none.
EngineEvent FirstFailure(GaitEngine& engine, const EngineInputs& inputs, double seconds) {
  EngineEvent first;
  Simulate(engine, inputs, seconds, [&first](const EngineOutput& output) {
    for (int i = 0; i < output.event_count; ++i) {
      const EngineEvent& event = output.events[static_cast<std::size_t>(i)];
      if (event.kind == EventKind::kFall && first.text[0] == 0) first = event;
    }
  });
  return first;
}

TEST(Failure, WalkingOverTheEdgeOfALevelTrackIsTheCurves) {
  GaitEngine engine = EngineOn(R"({"version": 1, "segments": [{"length_m": 50}]})");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1, 0.2, 0.08));
  const EngineEvent failure = FirstFailure(engine, inputs, 12);
  EXPECT_EQ(failure.cause, FailureCause::kCurve) << failure.text;
  EXPECT_GE(engine.Output().gait.failures.curve, 1u);
  EXPECT_EQ(engine.Output().gait.failures.simulation, 0u);
  EXPECT_EQ(engine.Output().gait.falls, engine.Output().gait.failures.curve);
  EXPECT_EQ(engine.Output().gait.operator_put_backs, 0u);
}

TEST(Failure, ThereIsNothingToStandOnBesideALevelTrack) {
  GaitEngine engine = EngineOn(R"({"version": 1, "segments": [{"length_m": 50}]})");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1, 0.2, 0.08));
  double lowest_m = 1;
  Simulate(engine, inputs, 12, [&lowest_m](const EngineOutput& output) {
    lowest_m = std::min(lowest_m, output.links[0].position_m.z());
  });
  EXPECT_LT(lowest_m, 0.2);  // Lying on a plane, the body's middle stays higher than that.
}

TEST(Failure, AnOpenTrackMayBeLeft) {
  GaitEngine engine = EngineOn(R"({"version": 1, "open": true, "segments": [{"length_m": 50}]})");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1, 0.2, 0.08));
  EXPECT_STREQ(FirstFailure(engine, inputs, 12).text, "");
}

TEST(Failure, SteppingOverTheEdgeOfAHillIsTheCurves) {
  GaitEngine engine = EngineOn(R"({"version": 1, "segments": [{"length_m": 50, "slope_deg": 1}]})");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1, 0.2, 0.08));
  EXPECT_EQ(FirstFailure(engine, inputs, 12).cause, FailureCause::kCurve);
}

TEST(Failure, RunningIntoAPitIsTheJumps) {
  GaitEngine engine = EngineOn(
      R"({"version": 1, "segments": [{"length_m": 5}, {"length_m": 3, "pit": true},
                                     {"length_m": 5}]})");
  const EngineInputs inputs = Direct(Command(Gait::kRun, 2));
  EXPECT_EQ(FirstFailure(engine, inputs, 10).cause, FailureCause::kJump);
}

TEST(Failure, AFallBehindAPitWhoseEdgeAFootHitIsTheJumps) {
  // Runs at 3 m/s, whose steps are 1.2 m long, over pits of 0.3 m at every place of a step: most
  // of them are run over, and some of their far edges are hit.
  int hit = 0;
  for (int i = 0; i < 16; ++i) {
    const std::string start_m = std::to_string(8 + 0.075 * i);
    GaitEngine engine = EngineOn(R"({"version": 1, "help_over_pits": false, "segments": [
        {"length_m": )" + start_m +
                                 R"(}, {"length_m": 0.3, "pit": true}, {"length_m": 30}]})");
    const EngineEvent failure = FirstFailure(engine, Direct(Command(Gait::kRun, 3)), 8);
    if (failure.text[0] == 0) continue;
    ++hit;
    EXPECT_EQ(failure.cause, FailureCause::kJump) << start_m << ": " << failure.text;
  }
  EXPECT_GT(hit, 0);
  EXPECT_LT(hit, 16);
}

TEST(Failure, APushOverIsTheSimulations) {
  GaitEngine engine = EngineOn(test::DataFile("tracks/pits.json"));
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1));
  Simulate(engine, inputs, 3);
  Push(inputs, 40, 60);
  const EngineEvent failure = FirstFailure(engine, inputs, 2);
  EXPECT_NE(failure.text[0], 0);
  EXPECT_EQ(failure.cause, FailureCause::kSimulation) << failure.text;
}

}  // namespace
}  // namespace footing::engine
