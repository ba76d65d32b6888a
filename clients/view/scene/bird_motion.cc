#include "clients/view/scene/bird_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr double kHeadS = 0.2;
constexpr double kToesS = 0.05;
constexpr double kFreeFootS = 0.04;      // A foot in flight goes back to where it is.
constexpr double kLargestCreepM = 0.03;  // Beyond, a foot slides for everybody to see.
constexpr double kWingsOpenS = 0.18;
constexpr double kWingsCloseS = 0.25;
constexpr double kMaxLiftM = 0.10;
constexpr double kLongestPauseS = 0.1;  // A longer pause is not made up for.
constexpr double kPutAwayM = 0.5;       // A body that is so far away was put there.

// Bobbing of the head: as far as the neck reaches, less at a stroll, and not in a run.
constexpr double kMostBobM = 0.12;
constexpr double kStrollMps = 0.6;
constexpr double kRunFromMps = 1.8, kRunMps = 2.6;
constexpr double kThrustRadps = 20;
constexpr double kThrown = 0.85;  // Share of the way at which the thrust ends.

constexpr double kTailRadps = 14, kTailDamping = 0.3;
constexpr double kTailRadPerG = 0.18;      // Pitch under one g of the body.
constexpr double kTailRadPerRadps = 0.15;  // Yaw against the body's turn.
constexpr double kMostTailRad = 0.5;
constexpr double kMostMps2 = 30;

constexpr double kTiltedRad = 0.12, kTippingRad = 0.45;  // Wings begin to help, and are half open.
constexpr double kBlinkS = 0.16;
constexpr std::uint64_t kBlinkSteps = 8;
constexpr double kGazeS = 0.12, kMostGazeRad = 0.6;
constexpr double kEyesAboveM = 0.60, kEyesAheadM = 0.40;

/// The share of the way to its goal that a first-order filter goes in dt_s.
double Share(double dt_s, double time_constant_s) { return 1 - std::exp(-dt_s / time_constant_s); }

int IndexOf(const std::vector<stream::Link>& links, const char* name, int otherwise) {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name == name) return static_cast<int>(i);
  }
  return otherwise;
}

int IndexOf(const std::vector<std::string>& points, const char* name, int otherwise) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i] == name) return static_cast<int>(i);
  }
  return otherwise;
}

bool Touches(const CharacterPose& pose, int contact) {
  return contact < static_cast<int>(pose.contacts.size()) &&
         pose.contacts[static_cast<std::size_t>(contact)].touching;
}

/// x'' = w^2 (goal - x) - 2 damping w x', stepped exactly for damping below 1.
void Step(Spring& spring, double goal, double w_radps, double damping, double dt_s) {
  const double x = spring.value - goal, v = spring.rate, decay = damping * w_radps;
  const double fade = std::exp(-decay * dt_s);
  const double wd = w_radps * std::sqrt(1 - damping * damping);
  const double c = std::cos(wd * dt_s), s = std::sin(wd * dt_s);
  spring.value = goal + fade * (x * c + (v + decay * x) / wd * s);
  spring.rate = fade * (v * c - (decay * v + w_radps * w_radps * x) / wd * s);
}

/// How far the head goes ahead and back at this speed.
double BobM(double speed_mps) {
  const double walks = std::clamp(speed_mps / kStrollMps, 0.0, 1.0);
  const double runs = std::clamp((speed_mps - kRunFromMps) / (kRunMps - kRunFromMps), 0.0, 1.0);
  return kMostBobM * walks * (1 - runs);
}

void MoveHead(double speed_mps, bool touchdown, double dt_s, BirdMotion& motion) {
  Spring& ahead = motion.head_ahead;
  const double most_m = BobM(speed_mps);
  if (touchdown) motion.head_rests = false;
  if (motion.head_rests) {
    // At the end of the neck's reach it goes on with the body.
    ahead = {std::max(ahead.value - speed_mps * dt_s, -most_m), -speed_mps};
    return;
  }
  ahead.Advance(most_m, kThrustRadps, dt_s);
  if (most_m > 0.01 && ahead.value >= kThrown * most_m) motion.head_rests = true;
}

void MoveTail(const Eigen::Vector3d& acceleration_mps2, double turn_radps, double dt_s,
              BirdMotion& motion) {
  const double g = std::clamp(acceleration_mps2.z(), -kMostMps2, kMostMps2) / kStandardGravityMps2;
  Step(motion.tail_pitch, -kTailRadPerG * g, kTailRadps, kTailDamping, dt_s);
  Step(motion.tail_yaw, kTailRadPerRadps * turn_radps, kTailRadps, kTailDamping, dt_s);
  for (Spring* tail : {&motion.tail_pitch, &motion.tail_yaw}) {
    tail->value = std::clamp(tail->value, -kMostTailRad, kMostTailRad);
  }
}

void Blink(bool touchdown, std::uint64_t steps, double dt_s, BirdMotion& motion) {
  motion.blink_s = touchdown && steps % kBlinkSteps == 0 ? 0 : std::min(motion.blink_s + dt_s, 1.0);
  motion.lid = std::clamp(2 - 4 * std::abs(motion.blink_s / kBlinkS - 0.5), 0.0, 1.0);
}

void LookAt(const CharacterPose& pose, double dt_s, BirdMotion& motion) {
  double yaw = 0, pitch = 0;
  const Eigen::Vector2d& next_m = pose.gait.next_foothold_m;
  if (!next_m.isZero()) {
    const Eigen::Rotation2Dd to_head(-motion.head_yaw_rad);
    const Eigen::Vector2d ahead_m = to_head * Eigen::Vector2d(next_m - motion.body_m.head<2>()) -
                                    Eigen::Vector2d(kEyesAheadM, 0);
    const double level_m = std::max(ahead_m.norm(), 0.1);
    yaw = std::atan2(ahead_m.y(), std::max(ahead_m.x(), 0.1));
    pitch = -std::atan2(motion.body_m.z() + kEyesAboveM, level_m) - 0.6 * motion.head_pitch_rad;
  }
  const double share = Share(dt_s, kGazeS);
  motion.gaze_yaw_rad +=
      share * (std::clamp(yaw, -kMostGazeRad, kMostGazeRad) - motion.gaze_yaw_rad);
  motion.gaze_pitch_rad +=
      share * (std::clamp(pitch, -kMostGazeRad, kMostGazeRad) - motion.gaze_pitch_rad);
}

DrawnFoot Planted(const DrawnFoot& before, bool touching, const Eigen::Vector3d& foot_m,
                  double dt_s) {
  DrawnFoot foot = before;
  foot.touches = touching;
  if (!touching) {
    foot.shift_m *= 1 - Share(dt_s, kFreeFootS);
    return foot;
  }
  if (!before.touches) foot.planted_m = foot_m + before.shift_m;
  foot.shift_m = foot.planted_m - foot_m;
  foot.shift_m.z() = 0;
  const double creep_m = foot.shift_m.norm();
  if (creep_m > kLargestCreepM) foot.shift_m *= kLargestCreepM / creep_m;
  return foot;
}

/// How far the wings are open to keep a body up that leans so much.
double Balance(const Eigen::Quaterniond& orientation) {
  const double up = std::clamp((orientation * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0);
  return std::clamp((std::acos(up) - kTiltedRad) / (2 * (kTippingRad - kTiltedRad)), 0.0, 1.0);
}

}  // namespace

BirdSkeleton FindParts(const stream::Skeleton& skeleton) {
  BirdSkeleton found;
  found.body = IndexOf(skeleton.links, "body", found.body);
  found.hips = {IndexOf(skeleton.links, "left_hip", found.hips[0]),
                IndexOf(skeleton.links, "right_hip", found.hips[1])};
  found.feet = {IndexOf(skeleton.contact_points, "left_foot", found.feet[0]),
                IndexOf(skeleton.contact_points, "right_foot", found.feet[1])};
  return found;
}

BirdMotion Advance(const BirdMotion& motion, const BirdSkeleton& skeleton,
                   const CharacterPose& pose, double dt_s) {
  if (skeleton.body >= static_cast<int>(pose.links.size())) return motion;
  const stream::LinkPose& body = pose.links[static_cast<std::size_t>(skeleton.body)];
  const Eigen::Vector3d forward = body.orientation * Eigen::Vector3d::UnitX();
  const double yaw_rad = std::atan2(forward.y(), forward.x());
  const double pitch_rad = std::asin(std::clamp(forward.z(), -1.0, 1.0));
  const double height_m = body.position_m.z();

  BirdMotion next = motion;
  if (!motion.placed || (body.position_m - motion.body_m).norm() > kPutAwayM) {
    next = {};
    next.placed = true;
    next.head_yaw_rad = next.body_yaw_rad = yaw_rad;
    next.head_pitch_rad = pitch_rad;
    next.body_height_m = height_m;
    next.body_m = body.position_m;
  }
  const double head = Share(dt_s, kHeadS);
  next.head_yaw_rad = WrapAngle(next.head_yaw_rad + head * WrapAngle(yaw_rad - next.head_yaw_rad));
  next.head_pitch_rad += head * (pitch_rad - next.head_pitch_rad);
  next.body_height_m += head * (height_m - next.body_height_m);
  next.head_lift_m = std::clamp(next.body_height_m - height_m, -kMaxLiftM, kMaxLiftM);
  bool airborne = true, touchdown = false;
  for (std::size_t leg = 0; leg < 2; ++leg) {
    const bool touching = Touches(pose, skeleton.feet[leg]);
    airborne = airborne && !touching;
    touchdown = touchdown || (touching && !next.feet[leg].touches);
    const auto contact = static_cast<std::size_t>(skeleton.feet[leg]);
    if (contact < pose.contacts.size()) {
      next.feet[leg] = Planted(next.feet[leg], touching, pose.contacts[contact].position_m, dt_s);
    }
    next.toe_spread[leg] += Share(dt_s, kToesS) * ((touching ? 1 : 0) - next.toe_spread[leg]);
  }
  const double wings = airborne ? 1 : Balance(body.orientation);
  next.wing_spread += Share(dt_s, wings > next.wing_spread ? kWingsOpenS : kWingsCloseS) *
                      (wings - next.wing_spread);
  if (dt_s <= 0) return next;
  const double step_s = std::min(dt_s, kLongestPauseS);
  const Eigen::Vector3d velocity_mps = (body.position_m - next.body_m) / dt_s;
  const Eigen::Vector2d heading(std::cos(next.head_yaw_rad), std::sin(next.head_yaw_rad));
  MoveHead(std::max(0.0, velocity_mps.head<2>().dot(heading)), touchdown, step_s, next);
  MoveTail((velocity_mps - next.velocity_mps) / dt_s, WrapAngle(yaw_rad - next.body_yaw_rad) / dt_s,
           step_s, next);
  next.body_m = body.position_m;
  next.velocity_mps = velocity_mps;
  next.body_yaw_rad = yaw_rad;
  Blink(touchdown, pose.gait.steps, step_s, next);
  LookAt(pose, step_s, next);
  return next;
}

}  // namespace footing::scene
