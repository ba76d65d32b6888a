#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/engine/state.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::Gait;

/// The first flight of a jump.
struct Leap {
  double flight_s = 0;
  double rise_m = 0;  ///< Of the COM over its height at lift-off.
};

/// Commands the jump until it has leapt.
Leap FirstLeap(GaitEngine& engine, const biped::GaitCommand& jump) {
  const EngineInputs inputs = Direct(jump);
  const auto simulate_until = [&](auto&& done) {
    for (int i = 0; i < 3000 && !done(engine.Output()); ++i) engine.Advance(inputs);
  };
  simulate_until([](const EngineOutput& output) { return output.gait.gait == Gait::kJump; });
  const double start_s = engine.Output().time_s, start_m = engine.Output().p_WC_m.z();
  Leap leap;
  simulate_until([&](const EngineOutput& output) {
    leap.rise_m = std::max(leap.rise_m, output.p_WC_m.z() - start_m);
    return output.gait.phase == std::string("compression");
  });
  leap.flight_s = engine.Output().time_s - start_s;
  return leap;
}

class LeapOutOfARun : public testing::TestWithParam<double> {};

/// It was as low as the run's own hops, 0.09 m, and only the next one as high as commanded.
TEST_P(LeapOutOfARun, IsAsHighAsCommandedAtAnyMomentOfTheStride) {
  constexpr double kHeightM = 0.3;
  // Up and down again, without what the COM at touchdown lies lower than at lift-off.
  const double flight_s = 2 * std::sqrt(2 * kHeightM / kStandardGravityMps2);
  GaitEngine engine = NewEngine();
  const EngineInputs run = Direct(Command(Gait::kRun, GetParam()));
  Simulate(engine, run, 6);
  for (int moment = 0; moment < 8; ++moment) {
    const EngineState running = engine.Save();
    const Leap leap = FirstLeap(engine, Command(Gait::kJump, 1.5, kHeightM));
    EXPECT_GT(leap.flight_s, 0.9 * flight_s) << moment;
    EXPECT_NEAR(leap.rise_m, kHeightM, 0.2 * kHeightM) << moment;
    Simulate(engine, Direct(Command(Gait::kJump, 1.5, kHeightM)), 3);
    EXPECT_EQ(engine.Output().gait.falls, 0u) << moment;
    engine.Restore(running);
    Simulate(engine, run, 0.06);
  }
}

/// Two of 600 leaps out of runs of 2.5 to 6 m/s fell, at 3.5 m/s: a landing that turns by 8 degrees
/// is one that much aside.
TEST_P(LeapOutOfARun, LandsTurnedByLessTheFasterItIs) {
  GaitEngine engine = NewEngine();
  Simulate(engine, Direct(Command(Gait::kRun, GetParam())), 6);
  double speed_mps = 0, heading_rad = 0;
  const EngineInputs jump = Direct(Command(Gait::kJump, 1.5, 0.5, DegreesToRadians(8)));
  for (int i = 0; i < 3000; ++i) {
    engine.Advance(jump);
    const stream::GaitState& state = engine.Output().gait;
    if (state.gait == Gait::kJump && state.phase == std::string("compression")) break;
    speed_mps = state.speed_mps;
    heading_rad = state.heading_rad;
  }
  const double turned_rad = engine.Output().gait.heading_rad - heading_rad;
  EXPECT_NEAR(turned_rad, DegreesToRadians(8) * std::min(1.0, 2 / speed_mps), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Speeds, LeapOutOfARun, testing::Values(1.5, 2.5, 3.8));

}  // namespace
}  // namespace footing::engine
