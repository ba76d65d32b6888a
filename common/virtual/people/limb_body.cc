#include "common/virtual/people/limb_body.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::users {
namespace {

using stream::DeviceRole;
using stream::Gait;
using stream::TurnSource;
using stream::UserInterface;

/// Ordinary frequencies of one limb, Hz: walking, running, jumping. People were shown where an
/// interface changes from walking to running, and keep off it; the fastest are those that untrained
/// people keep up for a minute. People hop at 2.2 Hz when nobody asks for another rate (Farley et
/// al. 1991), and who was shown that quicker swings jump further swings briskly.
struct Tempo {
  double walk_slow_hz, walk_fast_hz, run_slow_hz, run_fast_hz, jump_hz;
};
constexpr Tempo kWristTempo{0.8, 1.65, 2.5, 3.8, 2.2};
constexpr Tempo kArmTempo{0.85, 1.4, 1.2, 2.3, 1.5};
constexpr Tempo kLegTempo{0.75, 1.55, 2.4, 3.0, 2.2};

/// Half the way of a joint at ease, and the speed that it does not exceed at ease.
struct Way {
  double most_rad, most_radps;
};
constexpr Way kWristWay{0.5, 6};
constexpr Way kShoulderWay{0.5, 4.5};
constexpr Way kHipWay{0.6, 5};

/// A jump is a wider swing than a walk.
constexpr double kJumpAmplitude = 1.3;
/// Shares of weight by which a step, a jogging step and a hop accelerate the pelvis up and down.
constexpr double kStepBounce = 0.15, kJogBounce = 0.5, kHopBounce = 0.9;
constexpr double kMostBounceM = 0.1;
/// How far hands and head incline, arms twist; an elbow hangs, and is bent to run.
constexpr double kWristTurnRad = DegreesToRadians(32);
constexpr double kArmTurnRad = DegreesToRadians(36);
constexpr double kHeadTurnRad = DegreesToRadians(23);
constexpr double kTrunkTurnRad = DegreesToRadians(22);
/// A trunk sways to the standing leg with every step; inclined, it loads the leg on its lower side,
/// which is lifted less by this share.
constexpr double kTrunkSwayRad = DegreesToRadians(3);
constexpr double kLoadedLift = 0.25;
/// To turn by the feet, one is lifted higher than the other: their difference over their sum. In an
/// even step the hips move as fast as they do at ease already (kHipWay), so the higher foot goes on
/// as before and the other one is lifted less. Wider movements take longer, by this power of their
/// width (Viviani & Flash 1995).
constexpr double kFeetTurn = 0.6;
constexpr double kIsochrony = 0.25;
constexpr double kHangingRad = DegreesToRadians(12), kBentRad = DegreesToRadians(85);
constexpr double kTurnS = 0.07, kBendS = 0.1;
/// Share of a leg's cycle in the air, walking and running in place.
constexpr double kWalkSwing = 0.45, kRunSwing = 0.6;

const Tempo& TempoOf(UserInterface interface) {
  return interface == UserInterface::kArm   ? kArmTempo
         : interface == UserInterface::kLeg ? kLegTempo
                                            : kWristTempo;
}

double WayAt(const Way& way, double frequency_hz) {
  return std::min(way.most_rad, way.most_radps / (2 * kPi * frequency_hz));
}

/// A swing that is sharper at one end of its way, as a wrist's is.
double Swing(double cycles) {
  const double angle = 2 * kPi * cycles;
  return std::sin(angle) + 0.12 * std::sin(2 * angle + 0.6);
}

/// How far a leg is lifted in a cycle, 0 to 1.
double Lift(double cycles, double share) {
  const double into = cycles - std::floor(cycles);
  if (into >= share) return 0;
  const double wave = std::sin(kPi * into / share);
  return wave * wave;
}

/// How far who turns inclines or twists, rad; with the feet a share.
double TurnOf(UserInterface interface, TurnSource turn_by) {
  if (interface == UserInterface::kArm) return kArmTurnRad;
  if (interface != UserInterface::kLeg) return kWristTurnRad;
  return turn_by == TurnSource::kFeet    ? kFeetTurn
         : turn_by == TurnSource::kTrunk ? kTrunkTurnRad
                                         : kHeadTurnRad;
}

}  // namespace

LimbBody::LimbBody(UserInterface interface, const Style& style, std::uint64_t seed,
                   TurnSource turn_by)
    : interface_(interface), turn_by_(turn_by), style_(style), rhythm_(style, seed) {
  bend_.value = kHangingRad;
  poses_.fill(PosesNow());
}

void LimbBody::Advance(const Intention& wanted, double step_s) {
  const Tempo& tempo = TempoOf(interface_);
  gesture_ = wanted.gait;
  Rhythm::Aim aim{.moves = wanted.gait != Gait::kStep && wanted.gait != Gait::kUnspecified,
                  .together = wanted.gait == Gait::kJump,
                  .frequency_hz = tempo.jump_hz,
                  .amplitude = wanted.size * (wanted.gait == Gait::kJump ? kJumpAmplitude : 1)};
  const bool runs = wanted.gait == Gait::kRun;
  if (runs) aim.frequency_hz = std::lerp(tempo.run_slow_hz, tempo.run_fast_hz, wanted.effort);
  if (wanted.gait == Gait::kWalk) {
    aim.frequency_hz = std::lerp(tempo.walk_slow_hz, tempo.walk_fast_hz, wanted.effort);
  }
  rhythm_.Advance(aim, step_s);
  const double side = wanted.turn_rad == 0 ? 0 : wanted.turn_rad > 0 ? -1 : 1;
  turn_.Advance(side * TurnOf(interface_, turn_by_) * style_.amplitude, kTurnS, step_s);
  bend_.Advance(runs ? kBentRad : kHangingRad, kBendS, step_s);
  hop_.Advance(aim.together ? 1 : 0, kBendS, step_s);
  run_.Advance(runs ? 1 : 0, kBendS, step_s);
  step_s_ = step_s;
  std::rotate(poses_.begin(), poses_.begin() + 1, poses_.end());
  poses_[2] = PosesNow();
}

SensorPose LimbBody::HandNow(bool left) const {
  const double cycles = left ? rhythm_.left_cycles() : rhythm_.right_cycles();
  const double amplitude = left ? rhythm_.left_amplitude() : rhythm_.right_amplitude();
  const double rolled = turn_.value + (left ? style_.left_grip_rad : style_.right_grip_rad);
  if (interface_ == UserInterface::kArm) {
    const double way = WayAt(kShoulderWay, rhythm_.frequency_hz());
    const double bent = (bend_.value - kHangingRad) / (kBentRad - kHangingRad);
    return ArmPose(style_.height_m, 0.1 + amplitude * way * Swing(cycles), bend_.value, rolled,
                   -0.3 * bent * turn_.value);
  }
  const double way = WayAt(kWristWay, rhythm_.frequency_hz());
  return WristPose(amplitude * way * Swing(cycles), rolled);
}

/// The pelvis goes up and down with every step, or once a cycle in a hop; no further than the
/// muscles' share of the weight drives it.
double LimbBody::PelvisRise() const {
  const double share = std::lerp(std::lerp(kStepBounce, kJogBounce, run_.value), kHopBounce,
                                 std::clamp(hop_.value, 0.0, 1.0));
  const double one_hz = rhythm_.frequency_hz();
  const auto bounce_m = [&](double frequency_hz) {
    const double w = 2 * kPi * frequency_hz;
    return std::min(kMostBounceM, share * kStandardGravityMps2 / (w * w));
  };
  const double hop_m = -bounce_m(one_hz) * std::cos(2 * kPi * rhythm_.left_cycles());
  const double step_m = -bounce_m(2 * one_hz) * std::cos(4 * kPi * rhythm_.left_cycles());
  return rhythm_.activity() * std::lerp(step_m, hop_m, hop_.value);
}

/// Height of a leg's lift over that of an even step; in a hop both are lifted alike.
double LimbBody::LiftedBy(bool left) const {
  const double steps = 1 - std::clamp(hop_.value, 0.0, 1.0);
  if (turn_by_ == TurnSource::kFeet) {
    const double higher = (left ? 1 : -1) * steps * turn_.value;
    return (1 + higher) / (1 + std::fabs(higher));
  }
  if (turn_by_ != TurnSource::kTrunk) return 1;
  const double lower = (left ? -1 : 1) * turn_.value / kTrunkTurnRad;  // Right side down: right.
  return 1 - kLoadedLift * steps * std::clamp(lower, 0.0, 1.0);
}

SensorPose LimbBody::ShinNow(bool left) const {
  const double lifted = std::max(0.1, LiftedBy(left));
  const double even = std::lerp(kWalkSwing, kRunSwing, run_.value);
  const double share = even * std::pow(lifted, kIsochrony);
  // A leg that is in the air for longer makes the other one wait.
  const double wait = left ? 0 : even * (std::pow(std::max(0.1, LiftedBy(true)), kIsochrony) - 1);
  const double cycles = left ? rhythm_.left_cycles() : rhythm_.right_cycles() - wait;
  const double amplitude = left ? rhythm_.left_amplitude() : rhythm_.right_amplitude();
  const double way = 2 * WayAt(kHipWay, rhythm_.frequency_hz()) * amplitude / kJumpAmplitude;
  const double hip_rad = way * lifted * Lift(cycles, share);
  const double grip_rad = left ? style_.left_grip_rad : style_.right_grip_rad;
  return ShinPose(style_.height_m, hip_rad, 1.8 * hip_rad, PelvisRise(), grip_rad);
}

SensorPose LimbBody::TrunkNow() const {
  const double sway_rad =
      kTrunkSwayRad * rhythm_.activity() * std::sin(2 * kPi * rhythm_.left_cycles());
  return TrunkPose(style_.height_m, turn_.value + sway_rad, PelvisRise());
}

LimbBody::Poses LimbBody::PosesNow() const {
  if (interface_ != UserInterface::kLeg) return {HandNow(true), HandNow(false), {}};
  const bool head = turn_by_ == TurnSource::kHead;
  return {ShinNow(true), ShinNow(false),
          head ? HeadPose(style_.height_m, turn_.value, PelvisRise()) : TrunkNow()};
}

void LimbBody::Feel(Felt& felt) const {
  const bool legs = interface_ == UserInterface::kLeg;
  const DeviceRole roles[] = {
      legs ? DeviceRole::kLeftLeg : DeviceRole::kLeftHand,
      legs ? DeviceRole::kRightLeg : DeviceRole::kRightHand,
      turn_by_ == TurnSource::kTrunk ? DeviceRole::kTrunk : DeviceRole::kHead};
  felt.remote_count = legs && turn_by_ != TurnSource::kFeet ? 3 : 2;
  for (std::size_t i = 0; i < static_cast<std::size_t>(felt.remote_count); ++i) {
    felt.remotes[i] = {roles[i], SpecificForce(poses_[0][i], poses_[1][i], poses_[2][i], step_s_)};
  }
}

}  // namespace footing::users
