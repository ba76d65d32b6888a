#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "daemon/simulation/engine/state.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::Gait;

struct Case {
  biped::GaitCommand command;
  double push_x_ns, push_y_ns;
};

class EveryGait : public testing::TestWithParam<Case> {};

TEST_P(EveryGait, GoesOnForTenSecondsAfterAKickOfTwoNewtonSeconds) {
  GaitEngine engine = NewEngine();
  const biped::GaitCommand& command = GetParam().command;
  EngineInputs inputs = Direct(command);
  Simulate(engine, inputs, 3);
  Push(inputs, GetParam().push_x_ns, GetParam().push_y_ns);
  const double start_m = engine.Output().gait.distance_m;
  std::map<std::string, int> phases;
  Simulate(engine, inputs, 10, [&](const EngineOutput& output) { ++phases[output.gait.phase]; });
  const EngineOutput& output = engine.Output();
  EXPECT_EQ(output.gait.falls, 0u);
  EXPECT_EQ(output.gait.gait, command.gait);
  EXPECT_EQ(output.root_force_max_n, 0);
  EXPECT_NEAR((output.gait.distance_m - start_m) / 10, command.speed_mps, 0.1);
  const bool hops = command.gait == Gait::kRun || command.gait == Gait::kJump;
  EXPECT_EQ(phases.size(), hops ? 4u : 3u);
  for (const auto& [phase, steps] : phases) EXPECT_GT(steps, 100) << phase;
}

INSTANTIATE_TEST_SUITE_P(
    Kicked, EveryGait,
    testing::Values(Case{Command(Gait::kStep, 0), 0, 2}, Case{Command(Gait::kStep, 0), -2, 0},
                    Case{Command(Gait::kWalk, 0.8), 0, -2}, Case{Command(Gait::kWalk, 1.2), 2, 0},
                    Case{Command(Gait::kRun, 2), 0, 2}, Case{Command(Gait::kRun, 3), 1.4, -1.4},
                    Case{Command(Gait::kJump, 0, 0.3), -2, 0},
                    Case{Command(Gait::kJump, 0.5, 0.15), 0, 2}));

TEST(Jumping, LowAndFastFromAStandDoesNotDriftAside) {
  GaitEngine engine = NewEngine();
  double aside_m = 0;
  Simulate(engine, Direct(Command(Gait::kJump, 2, 0.1)), 6, [&](const EngineOutput& output) {
    aside_m = std::max(aside_m, std::fabs(output.p_WC_m.y()));
  });
  EXPECT_LT(aside_m, 1.5);
  EXPECT_GT(engine.Output().p_WC_m.x(), 6);
}

/// A run of 6 m/s lands low when it is to step in place: it was thrown up and back, and half fell.
TEST(Braking, FromTheFastestRunToSteppingInPlaceDoesNotFall) {
  GaitEngine engine = NewEngine();
  Simulate(engine, Direct(Command(Gait::kRun, 6)), 7);
  for (int i = 0; i < 8; ++i) {
    Simulate(engine, Direct(Command(Gait::kRun, 6)), 0.053);
    const EngineState running = engine.Save();
    double rises_mps = 0;
    Simulate(engine, Direct(Command(Gait::kStep, 0)), 4, [&](const EngineOutput& output) {
      if (output.gait.gait == Gait::kStep) rises_mps = std::max(rises_mps, output.v_WC_mps.z());
    });
    EXPECT_EQ(engine.Output().gait.falls, 0u) << i;
    EXPECT_EQ(engine.Output().gait.gait, Gait::kStep) << i;
    EXPECT_LT(rises_mps, 1.5) << i;
    engine.Restore(running);
  }
}

class Turning : public testing::TestWithParam<biped::GaitCommand> {};

TEST_P(Turning, FiveDegreesAStepKeepsSpeedAndBodyWithTheHeading) {
  GaitEngine engine = NewEngine();
  EngineInputs inputs = Direct(GetParam());
  Simulate(engine, inputs, 5);
  Push(inputs, 1.4, 1.4);
  double squares = 0, speed_mps = 0;
  constexpr double kSeconds = 8;
  Simulate(engine, inputs, kSeconds, [&](const EngineOutput& output) {
    const Eigen::Vector3d ahead = output.links[0].orientation * Eigen::Vector3d::UnitX();
    const double error_rad =
        std::remainder(std::atan2(ahead.y(), ahead.x()) - output.gait.heading_rad, 2 * M_PI);
    squares += error_rad * error_rad / (1000 * kSeconds);
    speed_mps += output.gait.speed_mps / (1000 * kSeconds);
  });
  EXPECT_EQ(engine.Output().gait.falls, 0u);
  EXPECT_LE(std::sqrt(squares), 5 * M_PI / 180);
  EXPECT_NEAR(speed_mps, GetParam().speed_mps, 0.1);
}

constexpr double kFiveDegreesRad = 5 * M_PI / 180;
INSTANTIATE_TEST_SUITE_P(LeftAndRight, Turning,
                         testing::Values(Command(Gait::kWalk, 1.75, 0.2, kFiveDegreesRad),
                                         Command(Gait::kRun, 3, 0.2, -kFiveDegreesRad),
                                         Command(Gait::kRun, 5, 0.2, kFiveDegreesRad),
                                         Command(Gait::kJump, 2, 0.2, -kFiveDegreesRad)));

class EveryChange : public testing::TestWithParam<std::pair<Gait, Gait>> {};

biped::GaitCommand Moderate(Gait gait) {
  return gait == Gait::kStep   ? Command(gait, 0)
         : gait == Gait::kWalk ? Command(gait, 0.9)
         : gait == Gait::kRun  ? Command(gait, 2.5)
                               : Command(gait, 0.5, 0.2);
}

TEST_P(EveryChange, SucceedsFromSeveralMoments) {
  const auto [from, to] = GetParam();
  GaitEngine engine = NewEngine();
  Simulate(engine, Direct(Moderate(from)), 6);
  ASSERT_EQ(engine.Output().gait.gait, from);
  for (int moment = 0; moment < 3; ++moment) {
    const EngineState start = engine.Save();
    EngineInputs inputs = Direct(Moderate(to));
    bool was_pending = false;
    Simulate(engine, inputs, 9,
             [&](const EngineOutput& output) { was_pending = was_pending || output.gait.pending; });
    const EngineOutput& output = engine.Output();
    EXPECT_EQ(output.gait.falls, 0u) << "moment " << moment;
    EXPECT_EQ(output.gait.gait, to);
    EXPECT_FALSE(output.gait.pending);
    EXPECT_GE(output.response.taken_over, output.response.commanded);
    const bool at_once =
        from != Gait::kRun && from != Gait::kJump && to != Gait::kRun && to != Gait::kJump;
    EXPECT_EQ(was_pending, !at_once);
    engine.Restore(start);
    Simulate(engine, Direct(Moderate(from)), 0.17);  // Another moment of the cycle.
  }
}

std::vector<std::pair<Gait, Gait>> AllChanges() {
  std::vector<std::pair<Gait, Gait>> changes;
  for (const Gait from : {Gait::kStep, Gait::kWalk, Gait::kRun, Gait::kJump}) {
    for (const Gait to : {Gait::kStep, Gait::kWalk, Gait::kRun, Gait::kJump}) {
      if (from != to) changes.emplace_back(from, to);
    }
  }
  return changes;
}

INSTANTIATE_TEST_SUITE_P(Figure9, EveryChange, testing::ValuesIn(AllChanges()),
                         [](const auto& tested) {
                           return std::string(Name(tested.param.first)) + "_to_" +
                                  Name(tested.param.second);
                         });

TEST(GaitChange, JumpingToRunningGoesByStepThenWalk) {
  GaitEngine engine = NewEngine();
  Simulate(engine, Direct(Moderate(Gait::kJump)), 5);
  std::vector<Gait> seen{engine.Output().gait.gait};
  Simulate(engine, Direct(Moderate(Gait::kRun)), 6, [&](const EngineOutput& output) {
    if (output.gait.gait != seen.back()) seen.push_back(output.gait.gait);
    EXPECT_EQ(output.gait.commanded_gait, Gait::kRun);
    EXPECT_EQ(output.gait.pending, output.gait.gait != Gait::kRun);
  });
  EXPECT_EQ(seen, (std::vector{Gait::kJump, Gait::kStep, Gait::kWalk, Gait::kRun}));
}

}  // namespace
}  // namespace footing::engine
