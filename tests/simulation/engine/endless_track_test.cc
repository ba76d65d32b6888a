#include <cmath>

#include "daemon/simulation/engine/state.h"
#include "daemon/simulation/biped/track.h"
#include "tests/simulation/allocations.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::Gait;

GaitEngine EndlessEngine() {
  EngineTexts texts = Texts();
  texts.track = test::DataFile("tracks/endless.json");
  return std::move(GaitEngine::Create(texts)).value();
}

/// One round of what a user who practises does without looking at the track: every gait, and turns
/// to both sides of which one is longer.
void Round(GaitEngine& engine, double longer_s,
           const std::function<void(const EngineOutput&)>& see) {
  const double turn_rad = 0.087;  // 5 degrees.
  Simulate(engine, Direct(Command(Gait::kStep, 0)), 2, see);
  Simulate(engine, Direct(Command(Gait::kWalk, 0.85)), 5, see);
  Simulate(engine, Direct(Command(Gait::kWalk, 0.85, 0.2, turn_rad)), 2 + longer_s, see);
  Simulate(engine, Direct(Command(Gait::kWalk, 0.85, 0.2, -turn_rad)), 2, see);
  Simulate(engine, Direct(Command(Gait::kRun, 2.7)), 6, see);
  Simulate(engine, Direct(Command(Gait::kJump, 0.6, 0.2)), 5, see);
}

TEST(EndlessTrack, StaysUnderAUserWhoDoesNotLookForTwoMinutes) {
  GaitEngine engine = EndlessEngine();
  const long before = test::Allocations();
  int off_steps = 0;
  double largest_m = 0;
  for (int i = 0; i < 5; ++i) {
    Round(engine, i % 2 == 0 ? 0.4 : -0.4, [&](const EngineOutput& output) {
      off_steps += output.trial.on_track ? 0 : 1;
      largest_m = std::max(largest_m, std::fabs(output.trial.lateral_offset_m));
    });
  }
  EXPECT_EQ(test::Allocations(), before);  // 0 and 0 where they are not counted.
  EXPECT_EQ(off_steps, 0) << largest_m;
  EXPECT_EQ(engine.Output().gait.falls, 0u);
  EXPECT_GT(engine.Output().trial.distance_m, 100);
  EXPECT_NEAR(engine.Output().trial.distance_m, engine.Output().gait.distance_m, 8);
}

TEST(EndlessTrack, ARestoredStateContinuesTheSameTrack) {
  GaitEngine first = EndlessEngine(), second = EndlessEngine();
  const auto ignore = [](const EngineOutput&) {};
  Round(first, 0.3, ignore);
  second.Restore(first.Save());
  Round(first, -0.5, ignore);
  Round(second, -0.5, ignore);
  EXPECT_EQ(second.Output().state_hash, first.Output().state_hash);
  EXPECT_EQ(second.track().revision, first.track().revision);
  EXPECT_EQ(second.track().segments.back().start_m, first.track().segments.back().start_m);
  EXPECT_EQ(second.Output().trial.distance_m, first.Output().trial.distance_m);
}

}  // namespace
}  // namespace footing::engine
