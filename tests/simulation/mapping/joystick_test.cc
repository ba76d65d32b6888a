#include "daemon/simulation/mapping/joystick.h"

#include <cmath>

#include "common/base/units.h"
#include "tests/simulation/test_world.h"

namespace footing::mapping {
namespace {

using stream::Gait;

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
