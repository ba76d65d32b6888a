#include "common/virtual/people/person.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/base/units.h"

namespace footing::users {
namespace {

/// Lengths of segments over the stature (Winter, Biomechanics and Motor Control, table 4.1); to the
/// sensor in the fist, and on the middle of the shin.
constexpr double kUpperArm = 0.186;
constexpr double kElbowToFist = 0.186;
constexpr double kThigh = 0.245;
constexpr double kKneeToSensor = 0.12;
constexpr double kNeckToCrown = 0.18;
/// From the hips to the middle of the chest.
constexpr double kHipToChest = 0.2;
/// A Wiimote's accelerometer lies so far before the wrist, m.
constexpr double kWristToSensorM = 0.11;

/// A direction in the sagittal plane, `angle_rad` before straight down.
Eigen::Vector3d Sagittal(double angle_rad) {
  return {std::sin(angle_rad), 0, -std::cos(angle_rad)};
}

/// At `lever_m` over a joint about which it inclines sideways.
SensorPose Inclined(double lever_m, double roll_rad, double pelvis_m) {
  const Eigen::Vector3d front = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d left =
      Eigen::AngleAxisd(roll_rad, front) * Eigen::Vector3d(Eigen::Vector3d::UnitY());
  const Eigen::Vector3d up = front.cross(left);
  return {lever_m * up + Eigen::Vector3d(0, 0, pelvis_m), AxesFrom(left, front)};
}

}  // namespace

Eigen::Matrix3d AxesFrom(const Eigen::Vector3d& left, const Eigen::Vector3d& front) {
  Eigen::Matrix3d axes;
  axes << left, front, left.cross(front);
  return axes;
}

SensorPose WristPose(double swing_rad, double roll_rad) {
  const Eigen::Vector3d front(std::cos(swing_rad), 0, std::sin(swing_rad));
  const Eigen::Vector3d left =
      Eigen::AngleAxisd(roll_rad, front) * Eigen::Vector3d(Eigen::Vector3d::UnitY());
  return {kWristToSensorM * front, AxesFrom(left, front)};
}

SensorPose ArmPose(double height_m, double shoulder_rad, double elbow_rad, double turned_rad,
                   double aside_rad) {
  const Eigen::AngleAxisd swing_plane(aside_rad, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d upper = swing_plane * Sagittal(shoulder_rad);
  const Eigen::Vector3d fore = swing_plane * Sagittal(shoulder_rad + elbow_rad);
  const Eigen::Vector3d side = swing_plane * Eigen::Vector3d(Eigen::Vector3d::UnitY());
  const Eigen::Vector3d left = Eigen::AngleAxisd(turned_rad, fore) * side;
  return {height_m * (kUpperArm * upper + kElbowToFist * fore), AxesFrom(left, fore)};
}

SensorPose ShinPose(double height_m, double hip_rad, double knee_rad, double pelvis_m,
                    double grip_rad) {
  const Eigen::Vector3d shin = Sagittal(hip_rad - knee_rad);
  const Eigen::Vector3d left =
      Eigen::AngleAxisd(grip_rad, shin) * Eigen::Vector3d(Eigen::Vector3d::UnitY());
  const Eigen::Vector3d front = shin.cross(left);
  return {height_m * (kThigh * Sagittal(hip_rad) + kKneeToSensor * shin) +
              Eigen::Vector3d(0, 0, pelvis_m),
          AxesFrom(left, front)};
}

SensorPose HeadPose(double height_m, double roll_rad, double pelvis_m) {
  return Inclined(kNeckToCrown * height_m, roll_rad, pelvis_m);
}

SensorPose TrunkPose(double height_m, double roll_rad, double pelvis_m) {
  return Inclined(kHipToChest * height_m, roll_rad, pelvis_m);
}

Eigen::Vector3d SpecificForce(const SensorPose& before, const SensorPose& at,
                              const SensorPose& after, double step_s) {
  const Eigen::Vector3d acceleration =
      (after.p_W_m - 2 * at.p_W_m + before.p_W_m) / (step_s * step_s);
  const Eigen::Vector3d gravity(0, 0, kStandardGravityMps2);
  return at.R_WS.transpose() * (acceleration + gravity);
}

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

namespace {

/// Ordinary frequencies of one foot, Hz. People were shown that a jog, faster than 1.2 Hz, runs.
constexpr double kWalkSlowHz = 0.55, kWalkFastHz = 0.95, kRunSlowHz = 1.5, kRunFastHz = 2.0;
/// Feet stand in the middle of their boards (their layout one_foot_each).
constexpr double kStanceM = 0.336;
constexpr double kLeanM = 0.05;
constexpr double kLeanS = 0.12;
/// Part of a cycle in which the load goes over from one foot to the other, walking and running.
constexpr double kWalkOver = 0.12, kRunOver = 0.06;
/// Shares of weight by which a step, and a jogging step, accelerate the body up and down.
constexpr double kBoardStepBounce = 0.12, kBoardJogBounce = 0.45;
/// A jump's gesture: both feet stand, then the heels rise, stay up and come down again, s.
constexpr double kStandsS = 0.42, kRisesS = 0.3, kStaysS = 0.1;
constexpr double kGestureS = kStandsS + 2 * kRisesS + kStaysS;
/// Again when it was in vain.
constexpr double kAgainS = 2.2;
/// How far heels rise, and the COP moves from the middle of the foot to the toes.
constexpr double kHeelRiseM = 0.07, kToesM = 0.085;
constexpr double kToesS = 0.05;
/// Slow sway of standing people, standard deviation and correlation time.
constexpr double kSwayM = 0.004, kSwayS = 1;

/// Second derivative of the smoothest way from 0 to 1 in unit time (minimum jerk: Flash & Hogan
/// 1985).
double MinimumJerkAcceleration(double u) {
  return u <= 0 || u >= 1 ? 0 : 60 * u - 180 * u * u + 120 * u * u * u;
}

}  // namespace

BoardBody::BoardBody(const Style& style, std::uint64_t seed)
    : style_(style), random_(seed), rhythm_(style, seed + 1) {}

/// The heels' acceleration, and where the pressure goes.
void BoardBody::Rise(double step_s) {
  const double h_m = kHeelRiseM * rise_size_ * style_.amplitude / (kRisesS * kRisesS);
  const double into_s = rises_s_ - kStandsS;
  const double down_s = into_s - kRisesS - kStaysS;
  lift_mps2_ =
      h_m * (MinimumJerkAcceleration(into_s / kRisesS) - MinimumJerkAcceleration(down_s / kRisesS));
  const bool up = rises_s_ >= 0 && into_s > -0.05 && down_s < 0.5 * kRisesS;
  toes_m_.Advance(up ? kToesM : 0, kToesS, step_s);
}

void BoardBody::Advance(const Intention& wanted, double step_s) {
  const bool jumps = wanted.gait == Gait::kJump;
  if (rises_s_ >= 0) rises_s_ += step_s;
  if (jumps && rises_s_ < 0) rises_s_ = 0;
  if (rises_s_ > (jumps ? kAgainS : kGestureS)) rises_s_ = jumps ? 0 : -1;
  const bool rising = rises_s_ >= 0 && rises_s_ < kGestureS;
  if (rises_s_ == 0) rise_size_ = wanted.size;
  // A rise that was begun is finished; after it the person walks on.
  gesture_ = rising  ? (rises_s_ < kStandsS ? Gait::kStep : Gait::kJump)
             : jumps ? Gait::kWalk
                     : wanted.gait;
  const bool runs = gesture_ == Gait::kRun, walks = gesture_ == Gait::kWalk;
  const double effort = wanted.effort;
  rhythm_.Advance({.moves = runs || walks,
                   .frequency_hz = runs ? std::lerp(kRunSlowHz, kRunFastHz, effort)
                                        : std::lerp(kWalkSlowHz, kWalkFastHz, effort)},
                  step_s);
  const double side = rising || wanted.turn_rad == 0 ? 0 : wanted.turn_rad > 0 ? -1 : 1;
  const bool stands = !runs && !walks;
  lean_m_.Advance(side * (stands ? 1.5 : 1) * kLeanM * style_.amplitude, kLeanS, step_s);
  run_.Advance(runs ? 1 : 0, kLeanS, step_s);
  sway_m_ +=
      -step_s / kSwayS * sway_m_ + kSwayM * std::sqrt(2 * step_s / kSwayS) * random_.Normal();
  Rise(step_s);
}

/// Share of the load on the right foot. Over a cycle the mean COP is under the COM, so who leans to
/// a side stands on it for longer.
double BoardBody::RightShare() const {
  const double lean = std::clamp(2 * lean_m_.value / kStanceM, -0.8, 0.8);
  const double standing = 0.5 + lean / 2;
  const double cycles = rhythm_.left_cycles();
  const double into = cycles - std::floor(cycles);
  const double border = 0.5 * (1 + lean + style_.asymmetry / 2);
  const double edge = std::min(into, std::min(std::fabs(into - border), 1 - into));
  const double over = std::lerp(kWalkOver, kRunOver, run_.value) / 2;
  const double away = std::clamp(edge / over, 0.0, 1.0);
  const double stepping = 0.5 + (into < border ? 0.5 : -0.5) * away;
  return std::lerp(standing, stepping, std::clamp(rhythm_.activity(), 0.0, 1.0));
}

double BoardBody::Load(double bounce_mps2) const {
  return std::max(0.0, style_.mass_kg * (kStandardGravityMps2 + bounce_mps2));
}

void BoardBody::Feel(Felt& felt) const {
  const double share =
      std::lerp(kBoardStepBounce, kBoardJogBounce, run_.value) * rhythm_.activity();
  const double bounce_mps2 =
      share * kStandardGravityMps2 * -std::cos(4 * kPi * rhythm_.left_cycles()) + lift_mps2_;
  const double load_n = Load(bounce_mps2);
  const double right = RightShare();
  const double forward_m = sway_m_ + toes_m_.value;
  felt.feet[0] = {(1 - right) * load_n, {forward_m, kStanceM / 2}};
  felt.feet[1] = {right * load_n, {forward_m, -kStanceM / 2}};
}

namespace {

std::variant<LimbBody, StickBody, BoardBody> BodyFor(UserInterface interface, const Style& style,
                                                     std::uint64_t seed,
                                                     stream::TurnSource turn_by) {
  switch (interface) {
    case UserInterface::kUnspecified:
    case UserInterface::kWrist:
    case UserInterface::kArm:
    case UserInterface::kLeg:
      break;
    case UserInterface::kJoystick:
      return StickBody(style, seed);
    case UserInterface::kBoards:
      return BoardBody(style, seed);
  }
  return LimbBody(interface, style, seed, turn_by);
}

}  // namespace

Person::Person(UserInterface interface, const Style& style, std::uint64_t seed,
               stream::TurnSource turn_by)
    : body_(BodyFor(interface, style, seed, turn_by)) {}

void Person::Advance(double time_s, const Intention& wanted) {
  std::visit(
      [&](auto& body) {
        for (; time_s_ + kStepS <= time_s; time_s_ += kStepS) body.Advance(wanted, kStepS);
        body.Feel(felt_);
      },
      body_);
}

stream::Gait Person::gesture() const {
  return std::visit([](const auto& body) { return body.gesture(); }, body_);
}

double Person::limb_hz() const {
  return std::visit([](const auto& body) { return body.limb_hz(); }, body_);
}

}  // namespace footing::users
