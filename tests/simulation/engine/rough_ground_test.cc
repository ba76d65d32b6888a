#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::Gait;

GaitEngine On(const std::string& segments) {
  EngineTexts texts = Texts();
  texts.track =
      R"({"version":1,"name":"test","width_m":12,"segments":[{"length_m":6},)" + segments + "]}";
  Result<GaitEngine> engine = GaitEngine::Create(texts);
  EXPECT_TRUE(engine.ok()) << (engine.ok() ? "" : engine.error().message);
  return std::move(engine).value();
}

class RoughGround : public testing::TestWithParam<biped::GaitCommand> {};

/// Kicked once on the way; returns the speed over the last half.
double GoAndPush(GaitEngine& engine, const biped::GaitCommand& command, double seconds) {
  EngineInputs inputs = Direct(command);
  Simulate(engine, inputs, seconds / 2);
  Push(inputs, 1.4, -1.4);
  const double start_m = engine.Output().gait.distance_m;
  Simulate(engine, inputs, seconds / 2);
  EXPECT_EQ(engine.Output().gait.falls, 0u);
  return (engine.Output().gait.distance_m - start_m) / (seconds / 2);
}

TEST_P(RoughGround, IsCrossedAtTheCommandedSpeed) {
  const biped::GaitCommand& command = GetParam();
  const double seconds = 2 * 24 / (command.speed_mps + 1);
  for (const char* segments :
       {R"({"length_m":200,"slope_deg":5})", R"({"length_m":200,"slope_deg":-5})",
        R"({"length_m":2.7,"step_m":0.1},{"length_m":3.1,"step_m":0.1},
           {"length_m":3.6,"step_m":-0.1},{"length_m":2.6,"step_m":0.1},
           {"length_m":3.3,"step_m":-0.1},{"length_m":200,"step_m":-0.1})"}) {
    GaitEngine engine = On(segments);
    EXPECT_NEAR(GoAndPush(engine, command, seconds), command.speed_mps, 0.25) << segments;
  }
}

INSTANTIATE_TEST_SUITE_P(Kicked, RoughGround,
                         testing::Values(Command(Gait::kWalk, 1.2), Command(Gait::kRun, 2),
                                         Command(Gait::kRun, 3), Command(Gait::kJump, 1, 0.2)));

TEST(FastRun, GoesUphill) {
  GaitEngine engine = On(R"({"length_m":300,"slope_deg":5})");
  EXPECT_NEAR(GoAndPush(engine, Command(Gait::kRun, 4), 20), 4, 0.1);
}

}  // namespace
}  // namespace footing::engine
