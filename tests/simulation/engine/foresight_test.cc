#include "daemon/simulation/engine/foresight.h"

#include <gtest/gtest.h>

#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/engine/state.h"
#include "tests/simulation/allocations.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::Gait;

GaitEngine NewRunner(bool foresees) {
  EngineTexts texts = Texts();
  if (foresees) texts.choices = {kChoicesFile, test::DataFile(kChoicesFile)};
  return std::move(GaitEngine::Create(texts)).value();
}

const EngineInputs kRun = Direct(Command(Gait::kRun, 2));

EngineInputs Pushed(double x_ns, double y_ns) {
  EngineInputs inputs = kRun;
  Push(inputs, x_ns, y_ns);
  return inputs;
}

/// Falls within 1.5 s of pushes of 40 N s to either side, at times all over two steps.
int FallsAfterPushes(bool foresees) {
  GaitEngine engine = NewRunner(foresees);
  Simulate(engine, kRun, 6);
  int falls = 0;
  for (int phase = 0; phase < 8; ++phase) {
    const EngineState before = engine.Save();
    for (const double side_ns : {-40, 40}) {
      engine.Restore(before);
      Simulate(engine, Pushed(0, side_ns), 1.5);
      falls += static_cast<int>(engine.Output().gait.falls);
    }
    engine.Restore(before);
    Simulate(engine, kRun, 0.1);
  }
  return falls;
}

TEST(Foresight, SavesMostFallsAfterPushes) {
  const int blind = FallsAfterPushes(false), seeing = FallsAfterPushes(true);
  EXPECT_GE(blind, 3);
  EXPECT_LE(3 * seeing, blind) << blind;
  RecordProperty("blind", blind);
  RecordProperty("seeing", seeing);
}

TEST(Foresight, LeavesARegularGaitAlone) {
  GaitEngine with = NewRunner(true), without = NewRunner(false);
  Simulate(with, kRun, 6);
  Simulate(without, kRun, 6);
  EXPECT_EQ(with.Output().state_hash, without.Output().state_hash);
}

TEST(Foresight, IsTheSameAfterARestore) {
  GaitEngine engine = NewRunner(true);
  Simulate(engine, kRun, 8);
  const EngineInputs pushed = Pushed(10, 40);
  Simulate(engine, pushed, 0.12);
  const EngineState after = engine.Save();
  ASSERT_NE(after.foresight.chosen.number, 0) << "a push that nothing else is chosen for";
  Simulate(engine, pushed, 2);
  const std::uint64_t once = engine.Output().state_hash;
  engine.Restore(after);
  Simulate(engine, pushed, 2);
  EXPECT_EQ(engine.Output().state_hash, once);
  GaitEngine other = NewRunner(true);
  other.Restore(after);
  Simulate(other, pushed, 2);
  EXPECT_EQ(other.Output().state_hash, once);
}

TEST(Foresight, AllocatesNothing) {
  GaitEngine engine = NewRunner(true);
  Simulate(engine, kRun, 8);
  const EngineInputs pushed = Pushed(0, 40);
  const long before = test::Allocations();
  Simulate(engine, pushed, 1);
  EXPECT_EQ(test::Allocations(), before);
}

TEST(Foresight, ChoicesAreReadInOrder) {
  const auto choices = *ReadChoices(
      "# why\ngait,choice,gain,factor\nrun,far,recovery.idle_yield,2\n"
      "run,far,hopping.foothold_side_limit_m,1.5\nwalk,quick,walking.swing_time_s,0.8\n"
      "run,near,recovery.idle_yield,0.5\n",
      "choices.csv");
  const auto& run = choices[stream::IndexOf(Gait::kRun)];
  ASSERT_EQ(run.size(), 2u);
  EXPECT_EQ(run[0].name, "far");
  ASSERT_EQ(run[0].factors.size(), 2u);
  EXPECT_EQ(run[0].factors[1].second, 1.5);
  EXPECT_EQ(run[1].name, "near");
  EXPECT_EQ(choices[stream::IndexOf(Gait::kWalk)].size(), 1u);
  EXPECT_TRUE(choices[stream::IndexOf(Gait::kJump)].empty());
}

TEST(Foresight, AWrongTableNamesItsLine) {
  const auto fault = [](const std::string& row) {
    const auto choices = ReadChoices("gait,choice,gain,factor\n" + row + "\n", "choices.csv");
    return choices.ok() ? "" : choices.error().message;
  };
  EXPECT_EQ(fault("run,far,recovery.idle_yield,2"), "");
  EXPECT_NE(fault("hop,far,recovery.idle_yield,2").find("choices.csv, line 2"), std::string::npos)
      << fault("hop,far,recovery.idle_yield,2");
  EXPECT_NE(fault("run,far,recovery.idle_yeild,2").find("unknown gain"), std::string::npos);
  EXPECT_NE(fault("run,far,recovery.idle_yield,0").find("0.1 to 10"), std::string::npos);
  EXPECT_NE(fault("run,far,recovery.idle_yield,nan").find("0.1 to 10"), std::string::npos);
  EXPECT_NE(fault("run,,recovery.idle_yield,2").find("no name"), std::string::npos);
  EXPECT_NE(fault("run,far,2").find("gait,choice,gain,factor"), std::string::npos);
  EXPECT_FALSE(ReadChoices("gait,choice\n", "choices.csv").ok());
  EXPECT_FALSE(ReadChoices("", "choices.csv").ok());
}

}  // namespace
}  // namespace footing::engine
