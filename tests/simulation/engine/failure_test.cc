#include "daemon/simulation/engine/failure.h"

#include "daemon/simulation/biped/track.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::FailureCause;
using stream::Gait;

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
