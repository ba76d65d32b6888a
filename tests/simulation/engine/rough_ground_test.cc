#include "daemon/simulation/engine/state.h"
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

TEST(FastWalk, SlowsDownOnASteepSlope) {
  for (const char* slope :
       {R"({"length_m":300,"slope_deg":15})", R"({"length_m":300,"slope_deg":-15})"}) {
    GaitEngine engine = On(slope);
    EXPECT_NEAR(GoAndPush(engine, Command(Gait::kWalk, 1.75), 15), 1.3, 0.1) << slope;
  }
}

GaitEngine OnSurface(const terrain::Surface& surface) {
  Result<GaitEngine> engine = GaitEngine::Create(Texts(), {.surface = surface});
  EXPECT_TRUE(engine.ok()) << (engine.ok() ? "" : engine.error().message);
  return std::move(engine).value();
}

TEST(Surface, HoldsAFootByItsFrictionAlone) {
  constexpr double kFriction = 0.3;
  GaitEngine engine = OnSurface({.friction = kFriction});
  double largest = 0;
  Simulate(engine, Direct(Command(Gait::kWalk, 0.8)), 6, [&](const EngineOutput&) {
    const Eigen::Vector3d force_n = engine.Save().world.contact_force_W_n;
    if (force_n.z() > 1) largest = std::max(largest, force_n.head<2>().norm() / force_n.z());
  });
  EXPECT_LE(largest, kFriction + 1e-6);
  EXPECT_GT(largest, kFriction / 2);
}

TEST(Surface, YieldsByItsDepthUnderTheWeight) {
  constexpr double kSinksM = 0.02;
  GaitEngine engine = OnSurface({.sinks_m = kSinksM});
  const EngineInputs inputs = Direct(Command(Gait::kStep, 0));
  Simulate(engine, inputs, 2);
  double depths_m = 0;
  int steps = 0;
  Simulate(engine, inputs, 4, [&](const EngineOutput& output) {
    for (const stream::Contact& foot : output.contacts) {
      depths_m += foot.touching ? -foot.position_m.z() : 0;
    }
    ++steps;
  });
  // The mean force of both feet is the weight, and the ground a spring.
  EXPECT_NEAR(depths_m / steps, kSinksM, 0.1 * kSinksM);
  EXPECT_EQ(engine.Output().gait.falls, 0u);
}

TEST(Tow, PullsAtTheBodyAndHidesNoForce) {
  GaitEngine engine = NewEngine();
  EngineInputs inputs = Direct(Command(Gait::kWalk, 0.8));
  Simulate(engine, inputs, 4);
  inputs.tow_W_n = {10, 0};
  Simulate(engine, inputs, 1);
  EXPECT_EQ(engine.Output().push_W_n, Eigen::Vector3d(10, 0, 0));
  EXPECT_EQ(engine.Output().root_force_max_n, 0);
  inputs.tow_W_n = {NAN, 0};
  Simulate(engine, inputs, 0.1);
  EXPECT_EQ(engine.Output().push_W_n, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace footing::engine
