#include "common/virtual/people/style.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/virtual/devices/noise.h"

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

namespace {

/// How fast people change tempo, the relation of two limbs, and start or stop a swing.
constexpr double kTempoS = 0.12;
constexpr double kPhaseS = 0.1;
constexpr double kAmplitudeS = 0.08;
/// Correlation time of the drift of the tempo.
constexpr double kDriftS = 6;

}  // namespace

void Follower::Advance(double target, double time_constant_s, double step_s) {
  const double w = 1 / time_constant_s;
  rate += step_s * (w * w * (target - value) - 2 * w * rate);
  value += step_s * rate;
}

void Rhythm::Advance(const Aim& aim, double step_s) {
  drift_ += -step_s / kDriftS * drift_ +
            style_.tempo_drift * std::sqrt(2 * step_s / kDriftS) * random_.Normal();
  const double tempo = style_.tempo * (1 + std::clamp(drift_, -0.12, 0.12));
  const bool resting = activity_.value < 0.05 && activity_.rate <= 0;
  if (aim.moves) {
    const double phase = aim.together ? 0 : 0.5 + style_.phase_error_rad / (2 * kPi);
    if (resting) {  // Limbs at rest begin as they are meant to go on.
      frequency_ = {aim.frequency_hz * tempo, 0};
      phase_ = {phase, 0};
      cycles_ = std::ceil(cycles_);
    }
    frequency_.Advance(aim.frequency_hz * tempo, kTempoS, step_s);
    phase_.Advance(phase, kPhaseS, step_s);
  }
  const double amplitude = aim.moves ? aim.amplitude * style_.amplitude : 0;
  amplitude_.Advance(amplitude, kAmplitudeS, step_s);
  activity_.Advance(aim.moves ? 1 : 0, kAmplitudeS, step_s);
  cycles_ += activity_.value * frequency_.value * step_s;  // The first cycle begins gently.
}

namespace {

using stream::Gait;

/// A thumb gets to a new place in about 0.2 s, and holds it with a slow tremor.
constexpr double kThumbS = 0.05;
constexpr double kTremorS = 0.3;
constexpr double kTremor = 0.02;
constexpr double kPressS = 0.12;
/// Radii at ease: inside and outside of the circle that the user was shown, at 0.6.
constexpr double kWalkNear = 0.36, kWalkFar = 0.52;
constexpr double kRunNear = 0.72, kRunFar = 1.0;
/// Sideways to turn, of directions 30 to 75 degrees from the front.
constexpr double kTurnRad = DegreesToRadians(52);

}  // namespace

StickBody::StickBody(const Style& style, std::uint64_t seed)
    : style_(style), random_(seed), bias_rad_(random_.Uniform(-0.12, 0.12)) {}

void StickBody::Advance(const Intention& wanted, double step_s) {
  const bool jumps = wanted.gait == Gait::kJump;
  if (jumps && !wanted_jump_) pressed_s_ = kPressS;
  wanted_jump_ = jumps;
  pressed_s_ -= step_s;
  gesture_ = jumps ? Gait::kJump : wanted.gait;
  // Who jumps goes on pushing forward.
  double radius = 0;
  if (wanted.gait == Gait::kWalk) radius = std::lerp(kWalkNear, kWalkFar, wanted.effort);
  if (wanted.gait == Gait::kRun) radius = std::lerp(kRunNear, kRunFar, wanted.effort);
  if (jumps) radius = std::hypot(right_.value, front_.value);
  const double side = wanted.turn_rad == 0 ? 0 : wanted.turn_rad > 0 ? -1 : 1;
  const double angle_rad = bias_rad_ * (1 - std::fabs(side)) + side * kTurnRad;
  tremor_ += -step_s / kTremorS * tremor_ +
             kTremor * style_.amplitude * std::sqrt(2 * step_s / kTremorS) * random_.Normal();
  right_.Advance(radius * std::sin(angle_rad), kThumbS, step_s);
  front_.Advance(radius * std::cos(angle_rad), kThumbS, step_s);
}

void StickBody::Feel(Felt& felt) const {
  const double right = right_.value + tremor_, front = front_.value + tremor_;
  const double beyond = std::max(1.0, std::hypot(right, front));  // The rim of the stick.
  felt.stick_x = right / beyond;
  felt.stick_y = front / beyond;
  felt.button_a = pressed_s_ > 0;
}

namespace {

/// Which side; how far is a matter of the style.
constexpr double kLeftRad = 0.1, kRightRad = -0.1;
/// Size of a gentle jump.
constexpr double kGentle = 0.5;

void AddBothSides(std::vector<Act>& acts, Gait gait, double effort, double duration_s) {
  for (const double turn_rad : {kLeftRad, kRightRad}) {
    acts.push_back({{.gait = gait, .turn_rad = turn_rad, .effort = effort}, duration_s});
  }
}

/// A heel rise that was begun is finished; a user who wants it for longer walks on after it.
std::vector<Act> BoardActs() {
  std::vector<Act> acts{{{.gait = Gait::kWalk, .effort = 0}, 5},
                        {{.gait = Gait::kRun, .effort = 1}, 4},
                        {{.gait = Gait::kStep}, 1.5}};
  for (const double size : {kGentle, kGentle, kGentle, 1.0, 1.0, 1.0}) {
    acts.push_back({{.gait = Gait::kJump, .size = size}, 0.4});
    acts.push_back({{.gait = Gait::kStep}, 1.2});
  }
  AddBothSides(acts, Gait::kWalk, 0.5, 4);
  AddBothSides(acts, Gait::kStep, 0, 3);
  return acts;
}

std::vector<Act> LimbActs(Gait turning) {
  std::vector<Act> acts{{{.gait = Gait::kWalk, .effort = 0}, 5},
                        {{.gait = Gait::kRun, .effort = 1}, 3},
                        {{.gait = Gait::kJump, .size = kGentle}, 3.5},
                        {{.gait = Gait::kJump}, 3.5}};
  AddBothSides(acts, turning, 0, 2.5);
  return acts;
}

/// Straight arms walk; bent ones run and incline.
std::vector<Act> ArmActs() {
  std::vector<Act> acts{
      {{.gait = Gait::kWalk, .effort = 0}, 4},       {{.gait = Gait::kWalk, .effort = 1}, 3},
      {{.gait = Gait::kRun, .effort = 0}, 3.5},      {{.gait = Gait::kRun, .effort = 1}, 2.5},
      {{.gait = Gait::kJump, .size = kGentle}, 2.5}, {{.gait = Gait::kJump}, 2.5}};
  AddBothSides(acts, Gait::kRun, 0, 2);
  return acts;
}

}  // namespace

std::vector<Act> RangeActs(UserInterface interface, stream::TurnSource turn_by) {
  switch (interface) {
    case UserInterface::kBoards:
      return BoardActs();
    case UserInterface::kArm:
      return ArmActs();
    case UserInterface::kLeg:
      return LimbActs(turn_by == stream::TurnSource::kFeet ? Gait::kWalk : Gait::kStep);
    case UserInterface::kWrist:
      return LimbActs(Gait::kStep);
    case UserInterface::kJoystick:
    case UserInterface::kUnspecified:
      return {};
  }
  return {};
}

const Intention& WantedAt(const std::vector<Act>& acts, double time_s) {
  double all_s = 0;
  for (const Act& act : acts) all_s += act.duration_s;
  double left_s = std::fmod(time_s, all_s);
  for (const Act& act : acts) {
    if (left_s < act.duration_s) return act.wanted;
    left_s -= act.duration_s;
  }
  return acts.back().wanted;
}

namespace {

constexpr double kMostDeg = 90;

Style WithGrip(std::uint64_t seed, UserInterface interface, const std::optional<GripWish>& grip) {
  if (!grip) return DrawStyle(seed, interface);
  Style style = DrawStyle(seed);
  const double side = seed % 2 == 0 ? 1 : -1;
  style.left_grip_rad = side * grip->rotation_rad;
  style.right_grip_rad = grip->same ? style.left_grip_rad : -style.left_grip_rad;
  return style;
}

}  // namespace

Result<GripWish> ParseGrip(double rotation_deg, const std::string& way, UserInterface interface) {
  if (interface != UserInterface::kWrist && interface != UserInterface::kArm) {
    return UsageError("--grip-deg: only the users of wrist and arm hold remotes that they swing");
  }
  if (!(std::fabs(rotation_deg) <= kMostDeg)) {
    return UsageError("--grip-deg takes -90 to 90 degrees");
  }
  if (way != "mirrored" && way != "same") {
    return UsageError("unknown --grip-way " + way + "; there are: mirrored, same");
  }
  return GripWish{.rotation_rad = DegreesToRadians(rotation_deg), .same = way == "same"};
}

Style StyleOf(std::uint64_t seed, UserInterface interface, const std::optional<GripWish>& grip,
              const StyleWish& wish) {
  Style style = WithGrip(seed, interface, grip);
  style.tempo = wish.tempo.value_or(style.tempo);
  style.amplitude = wish.amplitude.value_or(style.amplitude);
  style.asymmetry = wish.asymmetry.value_or(style.asymmetry);
  return style;
}

}  // namespace footing::users
