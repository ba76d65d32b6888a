#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "common/base/units.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/engine/state.h"
#include "tests/simulation/allocations.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

TEST(Engine, AllocatesNothingAfterItsStart) {
  if (!test::CountsAllocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  GaitEngine engine = NewEngine();
  EngineInputs inputs = Direct(Command(stream::Gait::kWalk, 1));
  long before = test::Allocations();
  auto probe = std::make_unique<int>(1);
  ASSERT_GT(test::Allocations(), before) << "the counter does not count";

  before = test::Allocations();
  for (const stream::Gait gait :
       {stream::Gait::kWalk, stream::Gait::kRun, stream::Gait::kJump, stream::Gait::kStep}) {
    inputs.direct_command.gait = gait;
    for (int i = 0; i < 4000; ++i) {
      engine.Advance(inputs);
      engine.Output();
    }
  }
  Push(inputs, 30, 90);  // A fall and a put-back too.
  for (int i = 0; i < 3000; ++i) engine.Advance(inputs);
  const EngineState state = engine.Save();
  engine.Restore(state);
  EXPECT_EQ(test::Allocations(), before);
  EXPECT_EQ(engine.Output().gait.falls, 1u);
}

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

using stream::UserInterface;

GaitEngine NewEngineOf(UserInterface interface) {
  EngineTexts texts = Texts();
  texts.mapping = test::DataFile(mapping::MappingFileOf(interface));
  EngineConfig config;
  config.interface.interface = interface;
  return std::move(GaitEngine::Create(texts, config)).value();
}

/// New inputs every 10 ms; `see` gets every step's output.
void Feed(GaitEngine& engine, EngineInputs& inputs, double seconds,
          const std::function<void(const EngineOutput&)>& see = nullptr) {
  for (int i = 0; i < std::lround(seconds * 100); ++i) {
    ++inputs.features_number;
    Simulate(engine, inputs, 0.01, see);
  }
}

TEST(Interfaces, EachNamesItselfAndWhatItMisses) {
  for (const UserInterface interface : stream::kUserInterfaces) {
    GaitEngine engine = NewEngineOf(interface);
    Simulate(engine, {}, 0.1);
    EXPECT_EQ(engine.Output().interface.interface, interface);
    EXPECT_EQ(engine.Output().interface.activity, stream::Activity::kAbsent);
    EXPECT_NE(engine.Output().interface.missing_roles, 0u);
  }
}

TEST(Interfaces, APressOfTheButtonIsOneJump) {
  for (const double radius : {0.0, 0.4, 0.59, 0.65, 0.7, 0.8, 0.9, 1.0}) {
    GaitEngine engine = NewEngineOf(UserInterface::kJoystick);
    EngineInputs inputs;
    inputs.features.stick = {.present = true, .y = radius};
    Feed(engine, inputs, 6);
    const Gait before = engine.Output().gait.gait;
    inputs.features.stick.presses = 1;
    double jumped_s = 0;
    Feed(engine, inputs, 6, [&](const EngineOutput& output) {
      if (output.gait.gait == Gait::kJump) jumped_s += EngineConfig{}.step_s;
    });
    // One hop of 0.3 m takes 0.5 s in the air, and its push and the change before it. Out of a fast
    // run the hop is as long as the run was fast, and two more slow it down.
    EXPECT_GT(jumped_s, 0.9) << radius;
    EXPECT_LT(jumped_s, 2.2) << radius;
    EXPECT_EQ(engine.Output().gait.gait, before) << radius;
    EXPECT_EQ(engine.Output().gait.falls, 0u) << radius;
  }
}

TEST(Interfaces, WithoutItsControllersTheCharacterStopsTurningAndRests) {
  GaitEngine engine = NewEngineOf(UserInterface::kWrist);
  EngineInputs inputs;
  mapping::LimbFeatures hand{.present = true,
                             .moving = true,
                             .frequency_valid = true,
                             .frequency_hz = 1.3,
                             .inclination_valid = true,
                             .roll_rad = 0.5};
  inputs.features.hands = {.left = hand, .right = hand, .phase_valid = true, .phase_rad = M_PI};
  Feed(engine, inputs, 5);
  EXPECT_EQ(engine.Output().gait.gait, Gait::kWalk);
  EXPECT_LT(engine.Output().gait.commanded_turn_rad, 0);
  // footingd goes on to report both, and knows nothing of them.
  inputs.features.hands = {};
  Feed(engine, inputs, 0.1);
  EXPECT_EQ(engine.Output().gait.commanded_gait, Gait::kStep);
  EXPECT_EQ(engine.Output().gait.commanded_turn_rad, 0);
  Feed(engine, inputs, 2);
  const double heading_rad = engine.Output().gait.heading_rad;
  Feed(engine, inputs, 3);
  EXPECT_EQ(engine.Output().gait.heading_rad, heading_rad);
  EXPECT_NEAR(engine.Output().gait.speed_mps, 0, 0.1);
}

TEST(Interfaces, ANewTrialLearnsAgainHowArmsHoldTheirControllers) {
  GaitEngine engine = NewEngineOf(UserInterface::kArm);
  EngineInputs inputs;
  mapping::LimbFeatures hand{.present = true,
                             .moving = true,
                             .frequency_valid = true,
                             .frequency_hz = 1,
                             .inclination_valid = true,
                             .pitch_rad = -1.4,
                             .swing_valid = true};
  const auto swing = [&](double rotation_rad, double seconds) {
    hand.swing_rad = rotation_rad;
    inputs.features.hands = {.left = hand, .right = hand, .phase_valid = true, .phase_rad = M_PI};
    Feed(engine, inputs, seconds);
    return engine.Output().gait.commanded_turn_rad;
  };
  EXPECT_EQ(swing(0.7, 3), 0);
  EXPECT_GT(swing(0, 3), 0);  // Both turned back: to the left.
  ++inputs.trial.number;
  EXPECT_EQ(swing(0, 3), 0);
  EXPECT_LT(swing(0.7, 3), 0);
}

TEST(Interfaces, AnotherOneTakesOverWhenItsNumberIsNewAndBeginsAtRest) {
  GaitEngine engine = NewEngineOf(UserInterface::kJoystick);
  EngineInputs inputs;
  inputs.features.stick = {.present = true, .y = 0.5};
  Feed(engine, inputs, 3);
  ASSERT_EQ(engine.Output().gait.gait, Gait::kWalk);
  inputs.interface = {.number = 1, .options = {.interface = UserInterface::kWrist}};
  inputs.interface.made = mapping::AnyInterface::Create(inputs.interface.options,
                                                        test::DataFile(mapping::kWristMappingFile))
                              .value();
  Feed(engine, inputs, 0.01);
  EXPECT_EQ(engine.Output().interface.interface, UserInterface::kWrist);
  EXPECT_EQ(engine.Output().interface.activity, stream::Activity::kAbsent);
  EXPECT_EQ(engine.Output().gait.commanded_gait, Gait::kStep);
  // The same number again changes nothing: the hands' gait goes on.
  mapping::LimbFeatures hand{
      .present = true, .moving = true, .frequency_valid = true, .frequency_hz = 1.3};
  inputs.features.hands = {.left = hand, .right = hand, .phase_valid = true, .phase_rad = M_PI};
  Feed(engine, inputs, 3);
  EXPECT_EQ(engine.Output().gait.commanded_gait, Gait::kWalk);
  EXPECT_EQ(engine.Output().gait.falls, 0u);
}

TEST(Interfaces, APressBeforeATrialDoesNotJumpAtItsStart) {
  GaitEngine engine = NewEngineOf(UserInterface::kJoystick);
  EngineInputs inputs;
  inputs.features.stick = {.present = true};
  Feed(engine, inputs, 2);
  ++inputs.features.stick.presses;
  Feed(engine, inputs, 0.01);
  ASSERT_EQ(engine.Output().gait.commanded_gait, Gait::kJump);
  ++inputs.trial.number;
  for (int i = 0; i < 300; ++i) {
    Feed(engine, inputs, 0.01);
    ASSERT_NE(engine.Output().gait.commanded_gait, Gait::kJump) << i;
  }
}

/// Saved while the press waits for the character: what is left of the wait is part of the state.
TEST(Interfaces, SavingAndRestoringRepeatsAWaitingJump) {
  GaitEngine engine = NewEngineOf(UserInterface::kJoystick);
  EngineInputs inputs;
  inputs.features.stick = {.present = true, .y = 0.9};
  Feed(engine, inputs, 4);
  ++inputs.features.stick.presses;
  Feed(engine, inputs, 0.05);
  ASSERT_EQ(engine.Output().gait.commanded_gait, Gait::kJump);
  const EngineState saved = engine.Save();
  const std::uint64_t number = inputs.features_number;
  Feed(engine, inputs, 4);
  ASSERT_NE(engine.Output().gait.commanded_gait, Gait::kJump);
  const std::uint64_t hash = engine.Output().state_hash;
  engine.Restore(saved);
  inputs.features_number = number;
  Feed(engine, inputs, 4);
  EXPECT_EQ(engine.Output().state_hash, hash);
}

TEST(Interfaces, SavingAndRestoringRepeatsBitForBit) {
  for (const UserInterface interface : {UserInterface::kLeg, UserInterface::kBoards}) {
    GaitEngine engine = NewEngineOf(interface);
    EngineInputs inputs;
    inputs.features.left_board = {.present = true, .corners_n = {90, 90, 90, 90}};
    inputs.features.right_board = {.present = true, .corners_n = {100, 80, 90, 90}};
    mapping::LimbFeatures leg{.present = true, .moving = true, .frequency_valid = true};
    leg.frequency_hz = 1.2;
    inputs.features.legs = {.left = leg, .right = leg, .phase_valid = true, .phase_rad = 3};
    Feed(engine, inputs, 2);
    const EngineState saved = engine.Save();
    const std::uint64_t number = inputs.features_number;
    Feed(engine, inputs, 2);
    const std::uint64_t hash = engine.Output().state_hash;
    engine.Restore(saved);
    inputs.features_number = number;
    Feed(engine, inputs, 2);
    EXPECT_EQ(engine.Output().state_hash, hash) << stream::Name(interface);
  }
}

/// The first flight of a jump.
struct Leap {
  double flight_s = 0;
  double rise_m = 0;  ///< Rise of the COM over its height at lift-off.
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

using stream::FailureCause;
using stream::TaskPhase;
using stream::TrialPhase;

GaitEngine EngineOnTrack(const std::string& text) {
  EngineTexts texts = Texts();
  texts.track = text;
  Result<GaitEngine> engine = GaitEngine::Create(texts);
  EXPECT_TRUE(engine.ok()) << (engine.ok() ? "" : engine.error().message);
  return std::move(engine).value();
}

GaitEngine EngineOnFile(const std::string& name) {
  return EngineOnTrack(test::DataFile("tracks/" + name + ".json"));
}

/// All events of a run, with the step's output in which they happened.
struct Seen {
  std::vector<EngineEvent> events;

  std::function<void(const EngineOutput&)> Look() {
    return [this](const EngineOutput& output) {
      events.insert(events.end(), output.events.begin(),
                    output.events.begin() + output.event_count);
    };
  }
  int Count(EventKind kind) const {
    return static_cast<int>(
        std::count_if(events.begin(), events.end(),
                      [kind](const EngineEvent& event) { return event.kind == kind; }));
  }
  const EngineEvent* First(EventKind kind) const {
    for (const EngineEvent& event : events) {
      if (event.kind == kind) return &event;
    }
    return nullptr;
  }
};

int TaskIndex(const GaitEngine& engine, const std::string& name) {
  for (std::size_t i = 0; i < engine.track().tasks.size(); ++i) {
    if (engine.track().tasks[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

constexpr const char* kShortTrack =
    R"({"version": 1, "finish_m": 9, "segments": [{"length_m": 13}]})";

TEST(TrialRun, ARunOverTheFinishLineEndsItOnceWithItsTime) {
  GaitEngine engine = EngineOnTrack(kShortTrack);
  Seen seen;
  Simulate(engine, Direct(Command(Gait::kWalk, 1)), 20, seen.Look());
  EXPECT_EQ(seen.Count(EventKind::kTrialRunning), 1);
  ASSERT_EQ(seen.Count(EventKind::kTrialFinished), 1);
  const EngineEvent& finished = *seen.First(EventKind::kTrialFinished);
  EXPECT_NEAR(finished.trial.distance_m, 9, 0.01);
  EXPECT_NEAR(finished.trial.time_s, 8, 0.8);  // From 1 m to 9 m at 1 m/s, from standing.
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kFinished);
  EXPECT_EQ(engine.Output().trial.time_s, finished.trial.time_s);
}

TEST(TrialRun, WalkingPastTheEndBehindTheFinishLineIsNotAFailure) {
  GaitEngine engine = EngineOnTrack(kShortTrack);
  Seen seen;
  Simulate(engine, Direct(Command(Gait::kWalk, 1)), 30, seen.Look());
  EXPECT_EQ(seen.Count(EventKind::kFall), 0);
  EXPECT_GE(seen.Count(EventKind::kPutBack), 1);  // It went over the end and stands again.
  EXPECT_EQ(engine.Output().gait.falls, 0u);
  EXPECT_EQ(engine.Output().gait.operator_put_backs, 0u);
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kFinished);
}

TEST(TrialRun, BeginsAtTheStartAndCountsForItselfAlone) {
  GaitEngine engine = EngineOnFile("pits");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1));
  Simulate(engine, inputs, 5);
  Push(inputs, 30, 90);
  Simulate(engine, inputs, 4);
  ASSERT_EQ(engine.Output().trial.failures.curve + engine.Output().trial.failures.simulation, 1u);
  inputs.trial.number = 1;
  Seen seen;
  Simulate(engine, inputs, 0.01, seen.Look());
  ASSERT_EQ(seen.Count(EventKind::kTrialReady), 1);
  EXPECT_EQ(seen.First(EventKind::kTrialReady)->trial_number, 1u);
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kReady);
  EXPECT_NEAR(engine.Output().trial.distance_m, 0, 0.05);
  EXPECT_EQ(engine.Output().trial.failures, stream::FailureCounts{});
  EXPECT_EQ(engine.Output().gait.falls, 1u);  // The server's count goes on.
  Simulate(engine, inputs, 3, seen.Look());
  EXPECT_EQ(seen.Count(EventKind::kTrialReady), 1);  // The same inputs begin it once.
  inputs.trial.stopped_below = 2;
  Simulate(engine, inputs, 1, seen.Look());
  EXPECT_EQ(seen.Count(EventKind::kTrialStopped), 1);
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kStopped);
}

TEST(TrialRun, AFailureHasItsPlaceItsTimeAndItsNumber) {
  GaitEngine engine = EngineOnFile("pits");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1, 0.2, 0.08));
  inputs.trial.number = 1;
  Seen seen;
  Simulate(engine, inputs, 14, seen.Look());
  ASSERT_GE(seen.Count(EventKind::kFall), 2);
  const EngineEvent& fall = *seen.First(EventKind::kFall);
  EXPECT_EQ(fall.cause, FailureCause::kCurve) << fall.text;
  EXPECT_EQ(fall.failure_number, 1u);
  EXPECT_TRUE(fall.in_trial);
  EXPECT_GT(fall.trial.lateral_offset_m, 1.5);  // To the left, where it turned to.
  EXPECT_GT(fall.trial.heading_error_rad, 0.5);
  EXPECT_GT(fall.trial.time_s, 1);
  EXPECT_NEAR(fall.p_WC_m.y(), fall.trial.lateral_offset_m, 0.3);
  EXPECT_EQ(seen.events.back().trial_number, 1u);
}

TEST(TrialRun, AnOperatorsPutBackIsNotAFailure) {
  GaitEngine engine = EngineOnFile("1");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1));
  Simulate(engine, inputs, 5);
  inputs.put_back_number = 1;
  Simulate(engine, inputs, 1);
  EXPECT_EQ(engine.Output().trial.operator_put_backs, 1u);
  EXPECT_EQ(engine.Output().trial.failures, stream::FailureCounts{});
  EXPECT_EQ(engine.Output().gait.falls, 0u);
}

TEST(TrialRun, LeavingTheStraightTrackIsStraightnessAndItGoesOn) {
  GaitEngine engine = EngineOnFile("straight");
  EngineInputs inputs = Direct(Command(Gait::kRun, 2.5, 0.2, 0.02));
  inputs.trial = {.number = 1, .task = TaskIndex(engine, "run_walk")};
  Seen seen;
  Simulate(engine, inputs, 12, seen.Look());
  ASSERT_GE(seen.Count(EventKind::kFall), 1);
  EXPECT_EQ(seen.First(EventKind::kFall)->cause, FailureCause::kStraightness);
  EXPECT_GE(engine.Output().gait.failures.straightness, 1u);
  EXPECT_EQ(engine.Output().trial.failures, engine.Output().gait.failures);
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kRunning);
}

TEST(TrialRun, ATaskDoneAtTheLineIsAnnouncedAndTheTrialFinishes) {
  GaitEngine engine = EngineOnFile("straight");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1.3));
  inputs.trial = {.number = 1, .task = TaskIndex(engine, "walk_run")};
  Seen seen;
  for (int i = 0; i < 400 && engine.Output().trial.phase != TrialPhase::kFinished; ++i) {
    const bool crossed = engine.Output().trial.distance_m > 30;
    inputs.direct_command = crossed ? Command(Gait::kRun, 2.5) : Command(Gait::kWalk, 1.3);
    Simulate(engine, inputs, 0.1, seen.Look());
  }
  ASSERT_EQ(seen.Count(EventKind::kTaskDone), 1);
  EXPECT_GT(seen.First(EventKind::kTaskDone)->trial.distance_m, 31);
  EXPECT_EQ(engine.Output().trial.phase, TrialPhase::kFinished);
  EXPECT_EQ(engine.Output().trial.failures, stream::FailureCounts{});
}

TEST(TrialRun, AMissedTaskIsATransitionAndThePutBackIsBeforeTheLine) {
  GaitEngine engine = EngineOnFile("straight");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1.4));
  inputs.trial = {.number = 1, .task = TaskIndex(engine, "walk_run")};
  Seen seen;
  double back_at_m = -1;
  Simulate(engine, inputs, 40, [&](const EngineOutput& output) {
    seen.Look()(output);
    for (int i = 0; i < output.event_count; ++i) {
      const bool back = output.events[static_cast<std::size_t>(i)].kind == EventKind::kPutBack;
      if (back && back_at_m < 0) back_at_m = output.trial.distance_m;
    }
  });
  ASSERT_GE(seen.Count(EventKind::kFall), 1);
  EXPECT_EQ(seen.First(EventKind::kFall)->cause, FailureCause::kTransition);
  EXPECT_NEAR(seen.First(EventKind::kFall)->trial.distance_m, 45, 0.1);
  EXPECT_NEAR(back_at_m, 30 - trial::kRunUpM, 0.1);
}

/// A walk up to a pit without a jump: with help the steps are fitted to it.
std::uint64_t FailuresAtAPit(bool help) {
  std::uint64_t failures = 0;
  for (int i = 0; i < 6; ++i) {
    GaitEngine engine = EngineOnTrack(
        std::string(R"({"version": 1, "help_over_pits": )") + (help ? "true" : "false") +
        R"(, "segments": [{"length_m": )" + std::to_string(12 + 0.2 * i) +
        R"(}, {"length_m": 0.5, "pit": true}, {"length_m": 20}]})");
    Simulate(engine, Direct(Command(Gait::kRun, 2.5)), 9);
    failures += engine.Output().gait.failures.jump;
  }
  return failures;
}

TEST(TrialRun, HelpOverPitsIsASettingOfTheTrack) {
  EXPECT_EQ(FailuresAtAPit(true), 0u);
  EXPECT_GE(FailuresAtAPit(false), 2u);
}

TEST(TrialRun, AnotherTrackTakesOverWhileTimeAndCountsGoOn) {
  GaitEngine engine = EngineOnFile("pits");
  EngineInputs inputs = Direct(Command(Gait::kWalk, 1));
  inputs.put_back_number = 1;
  Push(inputs, 1, 0);
  Simulate(engine, inputs, 4);
  stream::Track next = terrain::ParseTrack(test::DataFile("tracks/2.json"), "2").value();
  next.number = 2;
  auto world = MakeTrackWorld(next, test::Biped(), EngineConfig{}.step_s).value();
  const long before = test::Allocations();
  engine.UseTrack(*world);
  inputs.trial = {.number = 1, .task = -1, .stopped_below = 0, .track_number = 2};
  for (int i = 0; i < 2000; ++i) engine.Advance(inputs);
  EXPECT_EQ(test::Allocations(), before);
  const EngineOutput& output = engine.Output();
  EXPECT_EQ(output.track_number, 2u);
  EXPECT_EQ(world->track.number, 1u);  // The former one came back.
  EXPECT_EQ(output.step, 6000u);
  EXPECT_EQ(output.gait.operator_put_backs, 1u);
  EXPECT_EQ(output.gait.falls, 0u);
  EXPECT_GT(output.trial.distance_m, 0.5);
  EXPECT_LT(output.trial.distance_m, 3);
  EXPECT_TRUE(output.trial.on_track);
}

TEST(TrialRun, ATrackThatTookOverRunsAsIfTheEngineHadBegunOnIt) {
  GaitEngine fresh = EngineOnFile("2"), switched = EngineOnFile("plain");
  auto world = MakeTrackWorld(terrain::ParseTrack(test::DataFile("tracks/2.json"), "2").value(),
                              test::Biped(), EngineConfig{}.step_s)
                   .value();
  switched.UseTrack(*world);
  const EngineInputs inputs = Direct(Command(Gait::kRun, 2));
  Simulate(fresh, inputs, 3);
  Simulate(switched, inputs, 3);
  EXPECT_EQ(switched.Output().state_hash, fresh.Output().state_hash);
}

}  // namespace
}  // namespace footing::engine
