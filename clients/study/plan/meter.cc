#include "clients/study/plan/meter.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/stream/user_interface.h"

namespace footing::study::ranges {
namespace {

/// As in boards_mapping.json, but for the push: who rises gently is to be measured, too.
constexpr double kStandingLoadN = 150;
constexpr board::StepBorders kSteps{.stance_above = 0.75, .longest_step_s = 1.3};
constexpr board::HeelRiseBorders kRise{
    .forward_m = 0.04, .overshoot = 0.06, .together_s = 0.35, .standing_s = 0.2};
/// A rise's push is over this time after it was recognised.
constexpr double kPushS = 0.15;
constexpr double kLongestPauseS = 0.1;

}  // namespace

BoardMeter::BoardMeter() : steps_(kSteps), rise_(kRise) {}

BoardMotion BoardMeter::Advance(double time_s, const board::Stance& stance) {
  const double elapsed_s = begun_ ? std::clamp(time_s - time_s_, 0.0, kLongestPauseS) : 0;
  begun_ = true;
  time_s_ = time_s;
  if (stance.load_n < kStandingLoadN) {
    *this = BoardMeter();
    return {};
  }
  weight_.Advance(stance.load_n, elapsed_s);
  steps_.Advance(time_s, stance.left_share);
  if (rise_.Advance(time_s, stance.load_n / weight_.n(), stance.forward_m, steps_.even_s())) {
    rose_s_ = time_s;
    push_ = 0;
  }
  BoardMotion motion{.stands = true};
  const auto lean = steps_.lean_right();  // Lean of steps, known after two whole ones.
  if (!steps_.stepping()) stands_until_s_ = time_s;
  // The first cycle and a late step have another rhythm than the rest and do not count.
  const double cycles = (time_s - stands_until_s_) * steps_.last_frequency_hz();
  motion.steps = steps_.stepping() && steps_.on_time() && lean && cycles >= 1;
  if (motion.steps) motion.foot_hz = steps_.last_frequency_hz();
  motion.leans_known = lean && (motion.steps || !steps_.stepping());
  motion.lean_right = lean.value_or(0);
  if (rose_s_ >= 0) {
    push_ = std::max(push_, rise_.overshoot());
    motion.rose = time_s - rose_s_ >= kPushS;
    motion.rise_share = push_;
  }
  if (motion.rose) rose_s_ = -1;
  return motion;
}

namespace {

using stream::DeviceFeatures;
using stream::DeviceRole;
using stream::RigFeatures;

/// Share of the values beyond either end that do not count.
constexpr double kTrim = 0.05;
/// A pause in the stream counts as no longer.
constexpr double kLongestStepS = 0.05;
/// Limbs move together below the one, alternately above the other phase: the borders of the
/// mapping tables.
const double kTogetherRad = DegreesToRadians(75), kAlternateRad = DegreesToRadians(105);
/// Midway between the borders of arm_mapping.json.
const double kBentRad = DegreesToRadians(-44);
/// For how long a motion must be seen, s.
constexpr double kLeastAlternateS = 2, kLeastArmsS = 1.5, kLeastTogetherS = 1.5, kLeastTurnS = 1,
                 kLeastStickS = 0.5, kLeastStepsS = 4, kLeastStandS = 2;
/// Heel rises that must be seen; each counts for the time that it may take.
constexpr double kRiseS = 0.35, kLeastRisesS = 4 * kRiseS;
/// At rest for longer, the next motion is another one.
constexpr double kRestS = 0.6;
/// A device is missing that is there for less than this share of the time.
constexpr double kLeastPresence = 0.5;
/// A stick is let go, or pushed, inside or outside this radius.
constexpr double kStickRadius = 0.25;
/// Pushed forwards, or to a side, within this angle of it.
const double kStickAngleRad = DegreesToRadians(35);

const DeviceFeatures* Find(const RigFeatures& rig, DeviceRole role) {
  for (const DeviceFeatures& device : rig.devices) {
    if (device.role == role) return &device;
  }
  return nullptr;
}

/// One that is silent knows neither.
bool Present(const DeviceFeatures* device) {
  return device != nullptr && (device->moving || device->inclination_valid);
}

/// Elevation of a forearm over the horizontal, rad; as mapping::ForearmElevation.
double Elevation(const DeviceFeatures& hand, bool mounted) {
  if (!mounted) return hand.pitch_rad;
  const double across = std::hypot(std::sin(hand.roll_rad), std::sin(hand.pitch_rad));
  return -std::acos(std::min(1.0, across));
}

}  // namespace

/// Left and right, both there, and the phase between them where it is known.
struct Meter::Limbs {
  const DeviceFeatures& left;
  const DeviceFeatures& right;
  bool phase_valid = false;
  double phase_rad = 0;
  bool left_mounted = false, right_mounted = false;

  bool Moves() const { return left.moving && right.moving; }
  bool HasFrequency() const { return left.frequency_valid && right.frequency_valid; }
  double FrequencyHz() const { return (left.frequency_hz + right.frequency_hz) / 2; }
};

double Meter::Elapse(double time_s) {
  const double elapsed_s = time_s_ < 0 ? 0 : std::clamp(time_s - time_s_, 0.0, kLongestStepS);
  time_s_ = time_s;
  seen_s_ += elapsed_s;
  return elapsed_s;
}

void Meter::Put(const char* quantity, double value, double elapsed_s) {
  if (!std::isfinite(value)) return;
  Pool& pool = pools_[quantity];
  pool.values.push_back(value);
  pool.seconds += elapsed_s;
}

bool Meter::Settled(Motion::Kind kind, double frequency_hz) {
  if (kind != motion_.kind) motion_ = {kind, time_s_, time_s_};
  return (time_s_ - motion_.since_s) * frequency_hz >= 1;
}

void Meter::AddSwing(const Limbs& limbs, double elapsed_s) {
  // Between two slow steps nothing moves for a moment.
  if (time_s_ - motion_.moved_s > kRestS) motion_.kind = Motion::Kind::kNone;
  if (limbs.Moves()) motion_.moved_s = time_s_;
  if (!limbs.Moves() || !limbs.HasFrequency()) return;
  if (!limbs.phase_valid) {
    unequal_s_ += elapsed_s;
    return;
  }
  const double phase_rad = std::fabs(limbs.phase_rad);
  if (phase_rad >= kTogetherRad && phase_rad < kAlternateRad) return;
  const auto kind = phase_rad < kTogetherRad ? Motion::Kind::kTogether : Motion::Kind::kAlternate;
  if (!Settled(kind, limbs.FrequencyHz())) return;
  if (kind == Motion::Kind::kTogether) {
    Put(quantity::kTogetherHz, limbs.FrequencyHz(), elapsed_s);
    if (limbs.left.amplitude_valid && limbs.right.amplitude_valid) {
      Put(quantity::kTogetherMps2, (limbs.left.amplitude_mps2 + limbs.right.amplitude_mps2) / 2,
          elapsed_s);
    }
  }
  if (kind == Motion::Kind::kTogether) return;
  if (played_.interface != "arm") {
    return Put(quantity::kAlternateHz, limbs.FrequencyHz(), elapsed_s);
  }
  if (!limbs.left.inclination_valid || !limbs.right.inclination_valid) return;
  const double elevation_rad =
      (Elevation(limbs.left, limbs.left_mounted) + Elevation(limbs.right, limbs.right_mounted)) / 2;
  const bool bent = elevation_rad > kBentRad;
  Put(bent ? quantity::kBentHz : quantity::kStraightHz, limbs.FrequencyHz(), elapsed_s);
}

void Meter::AddTurn(const RigFeatures& rig, const Limbs& limbs, double elapsed_s) {
  const DeviceFeatures &left = limbs.left, &right = limbs.right;
  if (played_.interface != "leg") {
    if (!left.inclination_valid || !right.inclination_valid) return;
    // A hanging forearm that twists keeps its gravity: of arms, the bent ones' inclination counts.
    const bool hangs =
        played_.interface == "arm" && (Elevation(left, limbs.left_mounted) < kBentRad ||
                                       Elevation(right, limbs.right_mounted) < kBentRad);
    if (hangs) return;
    return Put(quantity::kTurnRight, RadiansToDegrees((left.roll_rad + right.roll_rad) / 2),
               elapsed_s);
  }
  if (played_.turn_by == "feet") {
    const double sum_mps2 = left.amplitude_mps2 + right.amplitude_mps2;
    if (!limbs.Moves() || !left.amplitude_valid || !right.amplitude_valid || sum_mps2 <= 0) return;
    return Put(quantity::kTurnRight, (left.amplitude_mps2 - right.amplitude_mps2) / sum_mps2,
               elapsed_s);
  }
  const DeviceFeatures* upper =
      Find(rig, played_.turn_by == "trunk" ? DeviceRole::kTrunk : DeviceRole::kHead);
  if (upper == nullptr || !upper->inclination_valid) return;
  Put(quantity::kTurnRight, RadiansToDegrees(upper->roll_rad), elapsed_s);
}

void Meter::Add(double time_s, const RigFeatures& rig, std::uint32_t mounted_roles) {
  const double elapsed_s = Elapse(time_s);
  const std::vector<DeviceRole> roles = plan::RolesOf(played_);
  for (const DeviceRole role : roles) {
    const DeviceFeatures* device = Find(rig, role);
    if (!Present(device)) continue;
    present_s_[role] += elapsed_s;
    simulated_ = simulated_ || device->simulated;
  }
  if (roles.size() < 2) return;  // A stick.
  const DeviceFeatures *left = Find(rig, roles[0]), *right = Find(rig, roles[1]);
  if (!Present(left) || !Present(right)) return;
  Limbs limbs{.left = *left,
              .right = *right,
              .left_mounted = (mounted_roles & stream::RoleBit(roles[0])) != 0,
              .right_mounted = (mounted_roles & stream::RoleBit(roles[1])) != 0};
  for (const stream::PairFeatures& pair : rig.pairs) {
    const bool of_both = std::minmax(pair.left_device, pair.right_device) ==
                         std::minmax(left->device, right->device);
    // While a person goes over from one motion to another a phase is held, and frequencies mean
    // neither.
    if (!of_both || !pair.phase_valid || pair.phase_held) continue;
    limbs.phase_valid = true;
    limbs.phase_rad = pair.phase_rad;
  }
  AddSwing(limbs, elapsed_s);
  AddTurn(rig, limbs, elapsed_s);
}

void Meter::AddStick(double time_s, double x, double y, bool simulated) {
  const double elapsed_s = Elapse(time_s);
  simulated_ = simulated_ || simulated;
  const double radius = std::hypot(x, y);
  if (radius < kStickRadius) return Put(quantity::kRestRadius, radius, elapsed_s);
  const double right_rad = std::fabs(std::atan2(x, y));  // From the front.
  if (right_rad < kStickAngleRad) return Put(quantity::kForwardRadius, radius, elapsed_s);
  if (std::fabs(right_rad - kPi / 2) < kStickAngleRad) {
    Put(quantity::kSideRadius, radius, elapsed_s);
  }
}

void Meter::AddStance(double time_s, const board::Stance& stance, bool simulated) {
  const double elapsed_s = Elapse(time_s);
  simulated_ = simulated_ || simulated;
  for (const DeviceRole role : plan::RolesOf(played_)) present_s_[role] += elapsed_s;
  const BoardMotion motion = boards_.Advance(time_s, stance);
  if (motion.steps) Put(quantity::kFootHz, motion.foot_hz, elapsed_s);
  if (motion.leans_known) {
    Put(motion.steps ? quantity::kStepLean : quantity::kStandLean, motion.lean_right, elapsed_s);
  }
  if (motion.rose) Put(quantity::kRiseShare, motion.rise_share, kRiseS);
}

double Meter::SecondsOf(const char* quantity) const {
  const auto found = pools_.find(quantity);
  return found == pools_.end() ? 0 : found->second.seconds;
}

Result<void> Meter::CheckDevices() const {
  if (played_.interface == "joystick") {
    if (seen_s_ > 0) return {};
    return NoDevice(
        "no stick has sent anything; plug the Nunchuk into the Wiimote of a hand, or "
        "use a Joy-Con");
  }
  std::uint32_t missing = 0;
  for (const DeviceRole role : plan::RolesOf(played_)) {
    const auto found = present_s_.find(role);
    const double present_s = found == present_s_.end() ? 0 : found->second;
    if (present_s < kLeastPresence * seen_s_ || seen_s_ == 0) missing |= stream::RoleBit(role);
  }
  if (missing == 0) return {};
  return NoDevice(stream::RoleNames(missing) + (missing & (missing - 1) ? " are" : " is") +
                  " missing or silent, and the interface " + played_.interface +
                  " needs them; connect them, or give them these roles (footing-ctl assign)");
}

Result<void> Meter::Require(const char* quantity, double least_s, const std::string& motion) const {
  const double seconds = SecondsOf(quantity);
  if (seconds >= least_s) return {};
  std::string text = motion + " was recognised for " + text::Fixed(seconds, 1) + " s, and " +
                     text::Fixed(least_s, 1) +
                     " s are needed: the motion was too small or too short";
  if (unequal_s_ > least_s) {
    text +=
        " (left and right moved at different frequencies for " + text::Fixed(unequal_s_, 1) + " s)";
  }
  return Failure(text + "; measure again");
}

Result<Ranges> Meter::Measure() const {
  if (const auto there = CheckDevices(); !there) return there.error();
  struct Needed {
    const char* quantity;
    double least_s;
    const char* motion;
  };
  std::vector<Needed> needed;
  if (played_.interface == "joystick") {
    needed = {{quantity::kRestRadius, kLeastStickS, "a stick let go"},
              {quantity::kForwardRadius, kLeastStickS, "a stick pushed forwards"},
              {quantity::kSideRadius, kLeastStickS, "a stick pushed to a side"}};
  } else if (played_.interface == "boards") {
    needed = {{quantity::kFootHz, kLeastStepsS, "stepping in place"},
              {quantity::kStepLean, kLeastStepsS, "stepping in place"},
              {quantity::kRiseShare, kLeastRisesS, "rising quickly on the toes"},
              {quantity::kStandLean, kLeastStandS, "standing with both feet loaded"}};
  } else if (played_.interface == "arm") {
    needed = {{quantity::kStraightHz, kLeastArmsS, "swinging straight arms in turns"},
              {quantity::kBentHz, kLeastArmsS, "swinging bent arms in turns"}};
  } else {
    needed = {{quantity::kAlternateHz, kLeastAlternateS, "moving left and right in turns"}};
  }
  if (played_.interface != "joystick" && played_.interface != "boards") {
    needed.push_back({quantity::kTogetherHz, kLeastTogetherS, "moving left and right together"});
    needed.push_back({quantity::kTogetherMps2, kLeastTogetherS, "moving left and right together"});
    needed.push_back({quantity::kTurnRight, kLeastTurnS, "what turns the character"});
  }
  Ranges ranges;
  for (const Needed& one : needed) {
    if (const auto done = Require(one.quantity, one.least_s, one.motion); !done) {
      return done.error();
    }
    const Pool& pool = pools_.at(one.quantity);
    // Arms that swing straight ahead show how the hands hold their controllers.
    const bool gripped =
        played_.interface == "arm" && std::string_view(one.quantity) == quantity::kTurnRight;
    const double neutral = gripped ? text::Median(pool.values) : 0;
    ranges[one.quantity] = {text::Quantile(pool.values, kTrim) - neutral,
                            text::Quantile(pool.values, 1 - kTrim) - neutral, pool.seconds};
  }
  return ranges;
}

}  // namespace footing::study::ranges
