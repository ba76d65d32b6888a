#include <cmath>

#include "daemon/simulation/engine/state.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::Gait;
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

}  // namespace
}  // namespace footing::engine
