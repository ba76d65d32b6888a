#include "common/virtual/people/style.h"

#include "common/base/units.h"
#include "common/virtual/devices/random.h"

namespace footing::users {

using stream::UserInterface;

namespace {

Style Draw(noise::Random& random) {
  Style style;
  style.reaction_s = random.Uniform(0.2, 0.4);
  style.favourite_mps = random.Uniform(2.2, 3.0);
  style.amplitude = random.Uniform(0.85, 1.2);
  style.asymmetry = random.Uniform(-0.1, 0.1);
  style.tempo = random.Uniform(0.94, 1.06);
  style.tempo_drift = random.Uniform(0.01, 0.04);
  style.phase_error_rad = random.Uniform(-0.25, 0.25);
  style.timing_s = random.Uniform(0.05, 0.15);
  style.mass_kg = random.Uniform(50, 95);
  style.height_m = random.Uniform(1.55, 1.95);
  return style;
}

}  // namespace

Style DrawStyle(std::uint64_t seed) {
  noise::Random random(seed);
  return Draw(random);
}

Style DrawStyle(std::uint64_t seed, UserInterface interface) {
  noise::Random random(seed);
  Style style = Draw(random);
  style.left_grip_rad = MostGrip(interface) * random.Uniform(-1, 1);
  style.right_grip_rad = MostGrip(interface) * random.Uniform(-1, 1);
  return style;
}

double MostGrip(UserInterface interface) {
  switch (interface) {
    case UserInterface::kArm:
      return DegreesToRadians(45);
    case UserInterface::kUnspecified:
    case UserInterface::kWrist:
      return DegreesToRadians(4);
    case UserInterface::kLeg:
      return DegreesToRadians(5);
    case UserInterface::kJoystick:
    case UserInterface::kBoards:
      return 0;
  }
  return 0;
}

}  // namespace footing::users
