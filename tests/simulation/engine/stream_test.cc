#include <cmath>

#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::Gait;

mapping::Inputs Swing(double frequency_hz, double phase_rad) {
  const mapping::LimbFeatures hand{.present = true,
                                   .moving = true,
                                   .frequency_valid = true,
                                   .frequency_hz = frequency_hz,
                                   .amplitude_valid = true,
                                   .amplitude_mps2 = 12};
  mapping::Inputs inputs;
  inputs.hands = {.left = hand, .right = hand, .phase_valid = true, .phase_rad = phase_rad};
  return inputs;
}

/// New features every 10 ms, as footingd sends them.
void SimulateFed(GaitEngine& engine, EngineInputs& inputs, double seconds) {
  for (int i = 0; i < std::lround(seconds * 100); ++i) {
    ++inputs.features_number;
    Simulate(engine, inputs, 0.01);
  }
}

TEST(SensorStream, CommandsAllGaits) {
  GaitEngine engine = NewEngine();
  EngineInputs inputs;
  const struct {
    double frequency_hz, phase_rad;
    Gait gait;
  } rows[] = {{1.2, M_PI, Gait::kWalk}, {3.0, M_PI, Gait::kRun}, {2.0, 0, Gait::kJump}};
  for (const auto& row : rows) {
    inputs.features = Swing(row.frequency_hz, row.phase_rad);
    SimulateFed(engine, inputs, 6);
    EXPECT_EQ(engine.Output().gait.gait, row.gait);
    EXPECT_TRUE(engine.Output().gait.commanded_by_stream);
  }
  inputs.features.hands.left.moving = inputs.features.hands.right.moving = false;
  SimulateFed(engine, inputs, 4);
  EXPECT_EQ(engine.Output().gait.gait, Gait::kStep);
  EXPECT_EQ(engine.Output().gait.falls, 0u);
}

TEST(SensorStream, CuttingItStopsTheWalk) {
  GaitEngine engine = NewEngine();
  EngineInputs inputs;
  inputs.features = Swing(1.5, M_PI);
  SimulateFed(engine, inputs, 6);
  EXPECT_EQ(engine.Output().gait.gait, Gait::kWalk);
  EXPECT_GT(engine.Output().gait.speed_mps, 0.7);

  double lost_s = 0;
  const double cut_s = engine.Output().time_s;
  Simulate(engine, inputs, 4, [&](const EngineOutput& output) {
    for (int i = 0; i < output.event_count; ++i) {
      if (output.events[static_cast<std::size_t>(i)].kind == EventKind::kStreamLost) {
        lost_s = output.time_s;
      }
    }
  });
  EXPECT_NEAR(lost_s - cut_s, EngineConfig{}.features_timeout_s, 0.02);
  EXPECT_EQ(engine.Output().gait.gait, Gait::kStep);
  EXPECT_FALSE(engine.Output().gait.commanded_by_stream);
  const double stopped_m = engine.Output().gait.distance_m;
  Simulate(engine, inputs, 5);
  EXPECT_NEAR(engine.Output().gait.distance_m, stopped_m, 0.15);
  EXPECT_EQ(engine.Output().gait.falls, 0u);
}

TEST(SensorStream, ComingBackTakesOverAgain) {
  GaitEngine engine = NewEngine();
  EngineInputs inputs;
  Simulate(engine, inputs, 1);
  EXPECT_FALSE(engine.Output().gait.commanded_by_stream);
  inputs.features = Swing(1.5, M_PI);
  SimulateFed(engine, inputs, 1);
  EXPECT_EQ(engine.Output().gait.gait, Gait::kWalk);
}

TEST(SensorStream, ADirectCommandGoesBeforeIt) {
  GaitEngine engine = NewEngine();
  EngineInputs inputs = Direct(Command(Gait::kJump, 0));
  inputs.features = Swing(1.5, M_PI);
  SimulateFed(engine, inputs, 3);
  EXPECT_EQ(engine.Output().gait.gait, Gait::kJump);
  inputs.direct = false;
  SimulateFed(engine, inputs, 3);
  EXPECT_EQ(engine.Output().gait.gait, Gait::kWalk);
}

}  // namespace
}  // namespace footing::engine
