#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::Gait;

constexpr double kNearM = 17;

constexpr double kPitSightM = 7;  ///< The controllers see a pit from 8 m, once a step.

std::string TrackWithPit(double width_m, bool helps = true) {
  return std::string(R"({"version": 1, "help_over_pits": )") + (helps ? "true" : "false") +
         R"(, "segments": [{"length_m": )" + std::to_string(kNearM) + R"(}, {"length_m": )" +
         std::to_string(width_m) + R"(, "pit": true}, {"length_m": 100}]})";
}

GaitEngine NewEngineBeforeAPit(double width_m, bool helps = true) {
  EngineTexts texts = Texts();
  texts.track = TrackWithPit(width_m, helps);
  return std::move(GaitEngine::Create(texts)).value();
}

TEST(Pit, IsCrossedByARunToldToJumpAtAnyMomentOfItsStride) {
  for (const double lead_m : {1.2, 2.0, 2.8, 3.6}) {
    GaitEngine engine = NewEngineBeforeAPit(1.5);
    const EngineInputs run = Direct(Command(Gait::kRun, 3));
    const EngineInputs jump = Direct(Command(Gait::kJump, 3));
    bool jumped_across = false;
    for (int i = 0; i < 11000; ++i) {
      const EngineOutput& output = engine.Output();
      const double to_edge_m = kNearM - output.p_WC_m.x();
      const bool over = to_edge_m < -0.2 && to_edge_m > -1.3;
      jumped_across = jumped_across || (over && output.gait.gait == Gait::kJump);
      engine.Advance(to_edge_m < lead_m && to_edge_m > -2 ? jump : run);
    }
    EXPECT_EQ(engine.Output().gait.falls, 0u) << lead_m;
    EXPECT_GT(engine.Output().p_WC_m.x(), kNearM + 1.5) << lead_m;
    EXPECT_TRUE(jumped_across) << lead_m;
  }
}

TEST(Pit, NarrowIsCrossedByARunAlone) {
  GaitEngine engine = NewEngineBeforeAPit(0.4);
  Simulate(engine, Direct(Command(Gait::kRun, 3)), 10);
  EXPECT_EQ(engine.Output().gait.falls, 0u);
  EXPECT_GT(engine.Output().p_WC_m.x(), kNearM + 2);
}

TEST(Pit, WideEndsARunThatIsNotToldToJump) {
  GaitEngine engine = NewEngineBeforeAPit(2.5);
  Simulate(engine, Direct(Command(Gait::kRun, 3)), 10);
  EXPECT_GT(engine.Output().gait.falls, 0u);
}

TEST(Pit, IsSteppedOverByAWalkAtAnySpeed) {
  for (const double speed_mps : {0.4, 0.9, 1.5}) {
    GaitEngine engine = NewEngineBeforeAPit(0.3);
    Simulate(engine, Direct(Command(Gait::kWalk, speed_mps)), 4 + 20 / speed_mps);
    EXPECT_EQ(engine.Output().gait.falls, 0u) << speed_mps;
    EXPECT_GT(engine.Output().p_WC_m.x(), kNearM + 1) << speed_mps;
  }
}

TEST(Pit, IsMetByAWalkWithoutItsStyle) {
  EngineTexts texts = Texts();
  texts.track = TrackWithPit(0.3);
  for (const char* name : kStyleFiles) texts.style.push_back({name, test::DataFile(name)});
  GaitEngine styled = std::move(GaitEngine::Create(texts)).value();
  texts.style.clear();
  GaitEngine plain = std::move(GaitEngine::Create(texts)).value();
  const EngineInputs walk = Direct(Command(Gait::kWalk, 1.2));
  // Until the pit is in sight, and from there on.
  const auto steps = [&walk](GaitEngine& engine) {
    std::array<std::uint64_t, 2> counted{};
    Simulate(engine, walk, 17, [&counted](const EngineOutput& output) {
      const double to_edge_m = kNearM - output.p_WC_m.x();
      if (to_edge_m > kPitSightM) counted[0] = output.gait.steps;
      if (to_edge_m > 1) counted[1] = output.gait.steps;
    });
    EXPECT_EQ(engine.Output().gait.falls, 0u);
    EXPECT_GT(engine.Output().p_WC_m.x(), kNearM + 1);
    return std::array{counted[0], counted[1] - counted[0]};
  };
  const auto with = steps(styled), without = steps(plain);
  EXPECT_LT(with[0] + 4, without[0]);  // 2.0 and 2.7 steps a second.
  EXPECT_LE(std::max(with[1], without[1]) - std::min(with[1], without[1]), 1u);
}

TEST(Pit, WideStopsAWalkBeforeIt) {
  GaitEngine engine = NewEngineBeforeAPit(0.6);
  Simulate(engine, Direct(Command(Gait::kWalk, 1)), 30);
  EXPECT_EQ(engine.Output().gait.falls, 0u);
  EXPECT_LT(engine.Output().p_WC_m.x(), kNearM);
  EXPECT_GT(engine.Output().p_WC_m.x(), kNearM - 1.5);
}

TEST(Pit, WideEndsAWalkThatGetsNoHelp) {
  GaitEngine engine = NewEngineBeforeAPit(0.6, false);
  Simulate(engine, Direct(Command(Gait::kWalk, 1)), 20);
  EXPECT_GT(engine.Output().gait.failures.jump, 0u);
}

}  // namespace
}  // namespace footing::engine
