#include <cmath>
#include <functional>

#include "common/base/units.h"
#include "daemon/simulation/mapping/boards.h"
#include "tests/simulation/mapping/boards_motion.h"
#include "tests/simulation/test_world.h"

namespace footing::mapping {
namespace {

using stream::Activity;
using stream::Gait;

constexpr double kLeanStepRad = DegreesToRadians(5);

BoardsInterface NewBoards(bool may_be_left = false) {
  return BoardsInterface(
      ParseBoardsMapping(test::DataFile(kBoardsMappingFile), kBoardsMappingFile).value(),
      may_be_left);
}

using See = std::function<void(const biped::GaitCommand&)>;

/// Lets the person go on; the interface is advanced every millisecond, as the engine does it.
biped::GaitCommand For(double seconds, BoardPerson& person, BoardsInterface& boards,
                       const See& see = nullptr) {
  biped::GaitCommand command;
  for (int reading = 0; reading < std::lround(seconds * 60); ++reading) {
    const double from_s = person.time_s();
    Inputs inputs = person.Advance();
    inputs.running = command.gait;  // This character takes everything over at once.
    for (int i = 1; i <= 16; ++i) {
      command = boards.Advance(from_s + 0.001 * i, inputs);
      if (see) see(command);
    }
  }
  return command;
}

/// The heels rise: the push comes first, then it lacks as much while the body slows down.
void Rise(BoardPerson& person, BoardsInterface& boards, double push, const See& see = nullptr) {
  person.push = push;
  for (int i = 1; i <= 8; ++i) {
    person.rise_m = 0.01 * i;
    For(1.0 / 60, person, boards, see);
  }
  person.push = -push;
  For(0.13, person, boards, see);
  person.push = 0;
  person.rise_m = 0;
}

TEST(Boards, SteppingWalksAndRunsByTheFrequencyOfAFoot) {
  for (const double mass_kg : {28.0, 75.0, 120.0}) {
    BoardPerson person(mass_kg);
    BoardsInterface boards = NewBoards();
    EXPECT_EQ(For(2, person, boards).gait, Gait::kStep);
    person.step_hz = 1.6;
    const auto walk = For(4, person, boards);
    EXPECT_EQ(walk.gait, Gait::kWalk) << mass_kg;
    EXPECT_NEAR(walk.speed_mps, 0.8, 0.05);  // 0.8 Hz is half way from 0.4 to 1.2 Hz.
    EXPECT_NEAR(walk.cadence_hz, 1.6, 0.06);
    person.step_hz = 3.4;
    const auto run = For(4, person, boards);
    EXPECT_EQ(run.gait, Gait::kRun) << mass_kg;
    EXPECT_NEAR(run.speed_mps, 3, 0.3);  // 1.7 Hz is half way from 1.2 to 2.2 Hz.
    EXPECT_NEAR(run.cadence_hz, 3.4, 0.15);
    EXPECT_EQ(run.turn_per_step_rad, 0);
    person.step_hz = 0;
    EXPECT_EQ(For(2, person, boards).gait, Gait::kStep);
  }
}

TEST(Boards, AWalkBeginsWithTheSecondStepAndEndsWithinTwoStepsOfTheLast) {
  BoardPerson person(70);
  BoardsInterface boards = NewBoards();
  For(2, person, boards);
  const double from_s = person.time_s();
  person.step_hz = 2;
  double began_s = 0;
  For(3, person, boards, [&](const auto& command) {
    if (began_s == 0 && command.gait == Gait::kWalk) began_s = person.time_s();
  });
  EXPECT_LT(began_s - from_s, 1.1);
  person.step_hz = 0;
  const double stopped_s = person.time_s();
  double rested_s = 0;
  For(3, person, boards, [&](const auto& command) {
    if (rested_s == 0 && command.gait == Gait::kStep) rested_s = person.time_s();
  });
  EXPECT_GT(rested_s, 0);
  EXPECT_LT(rested_s - stopped_s, 1.1);
}

TEST(Boards, ARunFromStandingHasNoWalkBeforeIt) {
  for (const double step_hz : {2.9, 3.4, 4.2}) {
    BoardPerson person(70);
    BoardsInterface boards = NewBoards();
    For(2, person, boards);
    const double from_s = person.time_s();
    person.step_hz = step_hz;
    double began_s = 0;
    For(4, person, boards, [&](const auto& command) {
      EXPECT_NE(command.gait, Gait::kWalk) << step_hz;
      EXPECT_EQ(command.speed_mps > 0, command.gait == Gait::kRun) << step_hz;
      if (began_s == 0 && command.gait == Gait::kRun) began_s = person.time_s();
    });
    // Two steps until a step has a frequency, and the two that a run must last.
    EXPECT_GT(began_s, from_s) << step_hz;
    EXPECT_LT(began_s - from_s, 4.5 / step_hz) << step_hz;
  }
}

TEST(Boards, SteppingNeverJumps) {
  for (const double step_hz : {1.0, 1.6, 2.4, 3.4, 4.2}) {
    BoardPerson person(70);
    BoardsInterface boards = NewBoards();
    For(2, person, boards);
    person.step_hz = step_hz;
    bool jumped = false;
    const See see = [&](const auto& command) { jumped |= command.gait == Gait::kJump; };
    For(10, person, boards, see);
    person.step_hz = 0;
    For(2, person, boards, see);
    EXPECT_FALSE(jumped) << step_hz << " steps a second";
  }
}

TEST(Boards, AQuickHeelRiseJumpsAndASlowOneDoesNot) {
  BoardPerson person(70);
  BoardsInterface boards = NewBoards();
  For(2, person, boards);
  double height_m = 0, jumped_s = 0;
  const See see = [&](const biped::GaitCommand& command) {
    if (command.gait != Gait::kJump) return;
    height_m = command.height_m;
    jumped_s += 0.001;
  };
  Rise(person, boards, 0.02, see);
  For(2, person, boards, see);
  EXPECT_EQ(jumped_s, 0) << "slow";
  Rise(person, boards, 0.36, see);
  For(2, person, boards, see);
  EXPECT_NEAR(height_m, 0.08 + 0.24 / 0.48 * 0.27, 0.03);
  EXPECT_NEAR(jumped_s, 0.4, 0.1);  // jump_after_s.
  EXPECT_EQ(boards.state().gait, Gait::kStep);
}

TEST(Boards, AJumpKeepsTheSpeedOfTheWalkBeforeIt) {
  BoardPerson person(70);
  BoardsInterface boards = NewBoards();
  For(2, person, boards);
  person.step_hz = 1.6;
  For(4, person, boards);
  person.step_hz = 0;
  For(0.3, person, boards);
  double speed_mps = 0;
  const See see = [&](const biped::GaitCommand& command) {
    if (command.gait == Gait::kJump) speed_mps = command.speed_mps;
  };
  Rise(person, boards, 0.4, see);
  For(0.2, person, boards, see);
  EXPECT_NEAR(speed_mps, 0.8, 0.1);
}

/// Both feet stand for longer than a step takes before the heels rise.
TEST(Boards, AJumpKeepsTheSpeedOfTheLastStepThatCameOnTime) {
  for (const double stands_s : {0.6, 2.0}) {
    BoardPerson person(70);
    BoardsInterface boards = NewBoards();
    For(2, person, boards);
    person.step_hz = 2;
    For(4, person, boards);
    person.step_hz = 0;
    For(stands_s, person, boards);
    double speed_mps = -1;
    const See see = [&](const biped::GaitCommand& command) {
      if (command.gait == Gait::kJump) speed_mps = command.speed_mps;
    };
    Rise(person, boards, 0.4, see);
    For(0.2, person, boards, see);
    // 1 Hz of a foot: 0.2 + 0.6 / 0.8 * 1.2 m/s; who has stood for longer jumps in place.
    EXPECT_NEAR(speed_mps, stands_s < 1 ? 1.1 : 0, 0.1) << stands_s;
  }
}

/// The steps of a run are short: both feet stand for longer than two of them before the heels rise.
TEST(Boards, AJumpOutOfARunComesBeforeTheRunEnds) {
  BoardPerson person(70);
  BoardsInterface boards = NewBoards();
  For(2, person, boards);
  person.step_hz = 4;
  For(4, person, boards);
  ASSERT_EQ(boards.state().gait, Gait::kRun);
  person.step_hz = 0;
  bool jumped = false;
  double slowest_mps = 10;  // While both feet stand already.
  const See see = [&](const biped::GaitCommand& command) {
    jumped = jumped || command.gait == Gait::kJump;
    if (!jumped) slowest_mps = std::min(slowest_mps, command.speed_mps);
  };
  For(0.35, person, boards, see);
  Rise(person, boards, 0.4, see);
  For(0.2, person, boards, see);
  EXPECT_TRUE(jumped);
  EXPECT_NEAR(slowest_mps, 3.9, 0.3);  // 2 Hz of a foot: 1.5 + 0.8 * 3 m/s.
}

TEST(Boards, LeaningTurnsToThatSideWhileSteppingAndWhileStanding) {
  BoardPerson person(70);
  BoardsInterface boards = NewBoards();
  For(2, person, boards);
  for (const double side : {1.0, -1.0}) {
    person.step_hz = 0;
    person.lean = 0.2 * side;  // As people stand without meaning it.
    EXPECT_EQ(For(2, person, boards).turn_per_step_rad, 0);
    person.lean = 0.55 * side;
    const auto standing = For(2, person, boards);
    EXPECT_EQ(standing.gait, Gait::kStep);
    EXPECT_NEAR(standing.turn_per_step_rad, -side * kLeanStepRad, 1e-12);
    person.lean = 0;
    EXPECT_EQ(For(2, person, boards).turn_per_step_rad, 0);
    person.step_hz = 1.8;
    person.step_lean = 0.05 * side;
    EXPECT_EQ(For(4, person, boards).turn_per_step_rad, 0);
    person.step_lean = 0.3 * side;
    const auto walking = For(4, person, boards);
    EXPECT_EQ(walking.gait, Gait::kWalk);
    EXPECT_NEAR(walking.turn_per_step_rad, -side * kLeanStepRad, 1e-12);
    person.step_lean = 0;
  }
}

TEST(Boards, TheFirstStepDoesNotTurn) {
  BoardPerson person(70);
  BoardsInterface boards = NewBoards();
  For(2, person, boards);
  person.step_hz = 1;
  bool turned = false;
  For(3, person, boards, [&](const auto& command) { turned |= command.turn_per_step_rad != 0; });
  EXPECT_FALSE(turned);
}

TEST(Boards, BothFeetOffStopTheCharacterUnlessTheStudyAllowsIt) {
  for (const bool may_be_left : {false, true}) {
    BoardPerson person(70);
    BoardsInterface boards = NewBoards(may_be_left);
    For(2, person, boards);
    person.step_hz = 1.6;
    For(4, person, boards);
    bool jumped = false;
    person.on_boards = false;
    For(0.3, person, boards, [&](const auto& command) { jumped |= command.gait == Gait::kJump; });
    EXPECT_EQ(jumped, may_be_left);
    EXPECT_EQ(boards.state().activity == Activity::kOffBoards, !may_be_left);
    For(2, person, boards);
    EXPECT_EQ(boards.state().gait, Gait::kStep);
    person.on_boards = true;
    person.step_hz = 0;
    For(1, person, boards);
    EXPECT_EQ(boards.state().activity, Activity::kRest);
  }
}

TEST(Boards, ALeapOffTheBoardsThatIsNotAllowedDoesNotJumpOnceTheFeetAreOff) {
  BoardPerson person(70);
  BoardsInterface boards = NewBoards();
  For(3, person, boards);
  person.push = 0.36;
  for (int i = 1; i <= 8; ++i) {
    person.rise_m = 0.01 * i;
    For(1.0 / 60, person, boards);
  }
  ASSERT_EQ(boards.state().activity, Activity::kHeelRise);
  person.on_boards = false;
  For(0.15, person, boards);
  bool jumped = false;
  For(1, person, boards, [&](const auto& command) { jumped |= command.gait == Gait::kJump; });
  EXPECT_FALSE(jumped);
  EXPECT_EQ(boards.state().activity, Activity::kOffBoards);
}

TEST(Boards, SteppingOnWalksNowhereAndDoesNotJump) {
  BoardPerson person(70);
  BoardsInterface boards = NewBoards();
  person.on_boards = false;
  For(1, person, boards);
  person.on_boards = true;
  person.lean = -1;  // The left foot first.
  bool moved = false;
  const See see = [&](const auto& command) { moved |= command.gait != Gait::kStep; };
  For(0.5, person, boards, see);
  person.lean = 0;
  For(3, person, boards, see);
  EXPECT_FALSE(moved);
}

TEST(Boards, WithoutABoardTheCharacterStopsAndTurnsNoMore) {
  BoardPerson person(70);
  BoardsInterface boards = NewBoards();
  For(2, person, boards);
  person.step_hz = 1.6;
  person.step_lean = 0.4;
  For(4, person, boards);
  Inputs inputs = person.Advance();
  inputs.right_board = {};
  const auto command = boards.Advance(person.time_s(), inputs);
  EXPECT_EQ(command, biped::GaitCommand{});
  EXPECT_EQ(boards.state().activity, Activity::kAbsent);
  EXPECT_EQ(boards.state().missing_roles, stream::RoleBit(stream::DeviceRole::kRightBoard));
}

/// One who leans over takes two short steps in a row, and the first one from standing may be short.
TEST(Boards, WhoWalksAndLeansToOneSideAndTheOtherIsNeverTakenToRun) {
  for (int moment = 0; moment < 12; ++moment) {
    BoardsInterface boards = NewBoards();
    BoardPerson person(70);
    for (int i = 0; i < 120; ++i) boards.Advance(person.time_s(), person.Advance());
    person.step_hz = 1.9;
    double side = 0.35;
    for (int i = 0; i < 900; ++i) {
      if (i % 97 == 8 * moment) side = -side;
      person.step_lean += std::clamp(side - person.step_lean, -0.03, 0.03);  // In 0.4 s.
      const auto command = boards.Advance(person.time_s(), person.Advance());
      ASSERT_NE(command.gait, Gait::kRun) << moment << " at " << i;
    }
  }
}

constexpr double kStickStepRad = DegreesToRadians(5);

JoystickInterface NewJoystick() {
  return JoystickInterface(
      ParseJoystickMapping(test::DataFile(kJoystickMappingFile), kJoystickMappingFile).value());
}

/// The stick at this radius and angle, clockwise from the front.
Inputs Stick(double radius, double angle_deg, std::uint64_t presses = 0, bool pressed = false) {
  Inputs inputs;
  const double angle_rad = DegreesToRadians(angle_deg);
  inputs.stick = {.present = true,
                  .x = radius * std::sin(angle_rad),
                  .y = radius * std::cos(angle_rad),
                  .pressed = pressed,
                  .presses = presses};
  return inputs;
}

TEST(Joystick, RegionsAndSectorsAreThoseOfFigure11) {
  const struct {
    double radius, angle_deg;
    Gait gait;
    double speed_mps, turn_steps;
  } rows[] = {
      {0, 0, Gait::kStep, 0, 0},         {0.2, 0, Gait::kStep, 0, 0},
      {0.425, 0, Gait::kWalk, 0.8, 0},  // Half way from 0.25 to 0.6.
      {0.8, 0, Gait::kRun, 3, 0},       // Half way from 0.6 to 1.
      {1, 0, Gait::kRun, 4.5, 0},        {0.425, 45, Gait::kWalk, 0.8, -1},
      {0.425, -45, Gait::kWalk, 0.8, 1}, {1, 60, Gait::kRun, 4.5, -1},
      {0.8, 20, Gait::kRun, 3, 0},       {0.8, -20, Gait::kRun, 3, 0},
      {0.9, 90, Gait::kStep, 0, -1},     {0.9, -90, Gait::kStep, 0, 1},
      {0.9, 120, Gait::kStep, 0, -1},    {0.9, 180, Gait::kStep, 0, 0},
  };
  for (const auto& row : rows) {
    JoystickInterface joystick = NewJoystick();
    const auto command = joystick.Advance(0, Stick(row.radius, row.angle_deg));
    EXPECT_EQ(command.gait, row.gait) << row.radius << " at " << row.angle_deg;
    EXPECT_NEAR(command.speed_mps, row.speed_mps, 1e-9) << row.radius << " at " << row.angle_deg;
    EXPECT_NEAR(command.turn_per_step_rad, row.turn_steps * kStickStepRad, 1e-9)
        << row.radius << " at " << row.angle_deg;
  }
}

TEST(Joystick, BordersHaveHysteresis) {
  JoystickInterface joystick = NewJoystick();
  EXPECT_EQ(joystick.Advance(0, Stick(0.55, 0)).gait, Gait::kWalk);
  EXPECT_EQ(joystick.Advance(1, Stick(0.62, 0)).gait, Gait::kWalk);
  EXPECT_EQ(joystick.Advance(2, Stick(0.64, 0)).gait, Gait::kRun);
  EXPECT_EQ(joystick.Advance(3, Stick(0.58, 0)).gait, Gait::kRun);
  EXPECT_EQ(joystick.Advance(4, Stick(0.56, 0)).gait, Gait::kWalk);
  EXPECT_EQ(joystick.Advance(5, Stick(0.23, 0)).gait, Gait::kWalk);
  EXPECT_EQ(joystick.Advance(6, Stick(0.21, 0)).gait, Gait::kStep);
  EXPECT_EQ(joystick.Advance(7, Stick(0.5, 32)).turn_per_step_rad, 0);
  EXPECT_LT(joystick.Advance(8, Stick(0.5, 34)).turn_per_step_rad, 0);
  EXPECT_LT(joystick.Advance(9, Stick(0.5, 28)).turn_per_step_rad, 0);
  EXPECT_EQ(joystick.Advance(10, Stick(0.5, 26)).turn_per_step_rad, 0);
}

TEST(Joystick, APressJumpsOnceAndAHeldButtonForAsLongAsItIsHeld) {
  JoystickInterface joystick = NewJoystick();
  joystick.Advance(0, Stick(1, 0, 4));
  const auto jump = joystick.Advance(1, Stick(1, 0, 5));  // Pressed and let go within a tick.
  EXPECT_EQ(jump.gait, Gait::kJump);
  EXPECT_NEAR(jump.height_m, 0.3, 1e-9);
  EXPECT_NEAR(jump.speed_mps, 1.5, 1e-9);  // Not faster than a jump can be.
  EXPECT_EQ(joystick.state().activity, stream::Activity::kButton);
  EXPECT_EQ(joystick.Advance(2.2, Stick(1, 0, 5)).gait, Gait::kJump) << "not taken over yet";
  Inputs jumping = Stick(1, 0, 5);
  jumping.running = Gait::kJump;
  EXPECT_EQ(joystick.Advance(2.3, jumping).gait, Gait::kJump);
  EXPECT_EQ(joystick.Advance(2.6, jumping).gait, Gait::kJump);
  EXPECT_EQ(joystick.Advance(2.8, jumping).gait, Gait::kRun);
  EXPECT_EQ(joystick.Advance(3, Stick(1, 0, 6, true)).gait, Gait::kJump);
  EXPECT_EQ(joystick.Advance(6, Stick(1, 0, 6, true)).gait, Gait::kJump);
  EXPECT_EQ(joystick.Advance(6.1, Stick(1, 0, 6)).gait, Gait::kRun) << "let go, after 2.5 s";
}

TEST(Joystick, WhatWasPressedBeforeDoesNotJump) {
  JoystickInterface joystick = NewJoystick();
  EXPECT_EQ(joystick.Advance(0, Stick(0.4, 0, 7, true)).gait, Gait::kWalk);
  joystick.Advance(1, {});
  EXPECT_EQ(joystick.Advance(2, Stick(0.4, 0, 9)).gait, Gait::kWalk) << "pressed while it was gone";
}

TEST(Joystick, WithoutItsStickTheCharacterStopsAndTurnsNoMore) {
  JoystickInterface joystick = NewJoystick();
  joystick.Advance(0, Stick(0.9, 60, 0));
  const auto command = joystick.Advance(1, {});
  EXPECT_EQ(command, biped::GaitCommand{});
  EXPECT_EQ(joystick.state().activity, stream::Activity::kAbsent);
  EXPECT_NE(joystick.state().missing_roles, 0u);
}

TEST(Joystick, NamesTheHandWhoseStickIsMissing) {
  JoystickInterface joystick = NewJoystick();
  const std::uint32_t left = stream::RoleBit(stream::DeviceRole::kLeftHand);
  joystick.Advance(0, {});
  EXPECT_EQ(joystick.state().missing_roles, left | stream::RoleBit(stream::DeviceRole::kRightHand));
  Inputs inputs = Stick(0.9, 0);
  inputs.stick.role = stream::DeviceRole::kLeftHand;
  joystick.Advance(1, inputs);
  EXPECT_EQ(joystick.state().missing_roles, 0u);
  inputs.stick = {.role = stream::DeviceRole::kLeftHand};
  joystick.Advance(2, inputs);
  EXPECT_EQ(joystick.state().missing_roles, left);
  joystick.Advance(3, {});
  EXPECT_EQ(joystick.state().missing_roles, left) << "nothing comes from footingd any more";
}

TEST(JoystickMapping, RefusesACentreBeyondTheRun) {
  std::string text = test::DataFile(kJoystickMappingFile);
  const std::string key = "\"centre_radius\": 0.25";
  text.replace(text.find(key), key.size(), "\"centre_radius\": 0.7");
  EXPECT_FALSE(ParseJoystickMapping(text, kJoystickMappingFile).ok());
}

}  // namespace
}  // namespace footing::mapping
