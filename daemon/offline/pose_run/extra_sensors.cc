#include "daemon/offline/pose_run/extra_sensors.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/base/units.h"
#include "common/body/skeleton_points.h"
#include "common/virtual/devices/noise.h"
#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::pose_run {

using virtual_sensors::KinectErrors;
using virtual_sensors::KinectSkeleton;

KinectBody::KinectBody(const body::Body& body, std::uint64_t seed, double step_s,
                       const virtual_sensors::KinectOptions& options)
    : skeleton_(body, seed, options), step_s_(step_s) {
  const auto joints = reconstruction::JointTracks();
  std::copy(joints.begin(), joints.end(), tracks_.begin() + KinectSkeleton::kHands);
}

void KinectBody::Advance(const body::Kinematics& at, bool with_joints,
                         reconstruction::Inputs& inputs) {
  constexpr double kRoundS = 1e-9;
  if (now_s_ >= next_s_ - kRoundS) {
    exposed_ = skeleton_.Expose(at);
    on_their_way_.push_back({now_s_, exposed_});
    next_s_ += KinectErrors::kPeriodS;
  }
  while (!on_their_way_.empty() &&
         on_their_way_.front().exposed_s + KinectErrors::kLateS <= now_s_ + kRoundS) {
    const Sample& sample = on_their_way_.front();
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      tracks_[i].Add(sample.exposed_s, sample.points[i].p_W_m,
                     Eigen::Vector3d::Constant(sample.points[i].sd_m));
    }
    on_their_way_.pop_front();
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const reconstruction::PointInput point = tracks_[i].At(now_s_);
    if (i < KinectSkeleton::kHands) {
      inputs.hands[i] = point;
      inputs.hands[i].of_skeleton = with_joints;
    } else if (with_joints) {
      inputs.joints[i - KinectSkeleton::kHands] = point;
    }
  }
  now_s_ += step_s_;
}

namespace {

constexpr double kLeastSdM = 0.001;
// Apart from the seeds of boards (twice the run's and one more), hands and arms.
constexpr std::uint64_t kHeadSeed = 104729, kSegmentSeed = 1299709, kSiteSeed = 15485863;
constexpr double kBehindM = 0.1;  // From a segment's joint.

std::uint64_t SeedOf(reconstruction::BodySite site, std::uint64_t seed) {
  return seed + kSegmentSeed + kSiteSeed * static_cast<std::uint64_t>(site);
}

/// Thighs have the most soft tissue over their bone (Leardini et al., Gait & Posture 21, 2005).
double SlipOf(reconstruction::BodySite site) {
  const bool is_thigh =
      site == reconstruction::BodySite::kLeftThigh || site == reconstruction::BodySite::kRightThigh;
  return is_thigh ? 0.08 : 0.05;
}

/// How far a segment turns in a squat: about the median of five people's.
double DepthOf(reconstruction::BodySite site) {
  switch (site) {
    case reconstruction::BodySite::kPelvis:
    case reconstruction::BodySite::kChest:
      return 0.6;
    case reconstruction::BodySite::kLeftThigh:
    case reconstruction::BodySite::kRightThigh:
      return 1.2;
    default:
      return 0.45;
  }
}

/// How a joint is turned in the scene's T-pose from the skeleton's: legs stand as in the clip. The
/// axes of a device are W's as the person stands.
Eigen::Matrix3d TurnInTPose(const virtual_sensors::Scene& scene, body::Landmark landmark) {
  const auto joint = static_cast<std::size_t>(scene.body.landmarks[landmark]);
  const body::Skeleton& skeleton = scene.body.skeleton;
  body::Kinematics stands(skeleton), drawn(skeleton);
  body::ComputeKinematics(skeleton, scene.motion.q.col(0), stands);
  body::ComputeKinematics(skeleton, body::TPose(skeleton, scene.body.landmarks), drawn);
  return stands.R_WJ[joint] * drawn.R_WJ[joint].transpose();
}

constexpr std::size_t kHeadJoint = body::IndexOf(stream::BodyJoint::kHead);

virtual_sensors::KinectOptions Unhidden() {
  virtual_sensors::KinectOptions options;
  options.hides = false;  // Nothing of a person is between the camera and the head.
  return options;
}

virtual_sensors::HeldErrorConfig Seeded(virtual_sensors::HeldErrorConfig config,
                                        std::uint64_t seed) {
  config.seed = seed;
  return config;
}

}  // namespace

HeadTracker::HeadTracker(const body::Body& body, HeadDevice device, const HeadErrors& errors,
                         std::uint64_t seed, double step_s)
    : device_(device),
      errors_(errors),
      random_(seed + kHeadSeed),
      sphere_(body::AboveHead(body, errors.above_m)),
      t_pose_off_m_(noise::NormalVector(errors.t_pose_sd_m, random_)),
      kinect_(body, seed + kHeadSeed, step_s, Unhidden()) {
  sphere_.p_J_m += noise::NormalVector(errors.seat_sd_m, random_);
}

void HeadTracker::Advance(const body::Kinematics& at, bool in_t_pose,
                          reconstruction::Inputs& inputs) {
  reconstruction::JointInput& head = inputs.joints[kHeadJoint];
  if (device_ == HeadDevice::kKinect) {
    reconstruction::Inputs seen;
    kinect_.Advance(at, true, seen);
    head = seen.joints[kHeadJoint];
    return;
  }
  head.valid = true;
  head.p_W_m = body::Place(sphere_, at) + noise::NormalVector(errors_.noise_m, random_);
  if (in_t_pose) head.p_W_m += t_pose_off_m_;
  head.sd_m.setConstant(std::max(errors_.noise_m, kLeastSdM));
}

BodySensor::BodySensor(const virtual_sensors::Scene& scene, reconstruction::BodySite site,
                       const BodySensorErrors& errors, std::uint64_t seed)
    : site_(site),
      course_(virtual_sensors::FollowJoint(
          scene.body, scene.motion, scene.body.landmarks[reconstruction::JointOf(site)],
          Eigen::Vector3d(site == reconstruction::BodySite::kPelvis ? -kBehindM : kBehindM, 0, 0))),
      errors_(errors),
      device_(Seeded(errors.device, SeedOf(site, seed))),
      random_(SeedOf(site, seed) + 1),
      attitude_(reconstruction::SquatTurnOf(site)),
      reading_s_(1 / scene.motion.rate_hz) {
  const Eigen::Matrix3d turned = TurnInTPose(scene, reconstruction::JointOf(site));
  course_.specific_force_S_mps2 = (turned * course_.specific_force_S_mps2).eval();
  course_.angular_velocity_S_radps = (turned * course_.angular_velocity_S_radps).eval();
  errors_.device.seed = SeedOf(site, seed);
  if (IsHand(site)) {  // Its errors are those of the grip.
    held_ = arms::Turned(noise::NormalVector(errors.hold_rad, random_));
    return;
  }
  const Eigen::Vector3d imaginary = noise::NormalVector(1, random_);
  mounting_ = Eigen::Quaterniond(random_.Normal(), imaginary.x(), imaginary.y(), imaginary.z())
                  .normalized()
                  .toRotationMatrix();
}

void BodySensor::Feel(const Eigen::Vector3d& specific_force_S_mps2,
                      const Eigen::Vector3d& angular_velocity_S_radps, bool squats) {
  const auto reading = device_.Advance(mounting_ * specific_force_S_mps2,
                                       mounting_ * angular_velocity_S_radps, reading_s_);
  attitude_.Advance(
      {reading.specific_force_S_mps2, reading.angular_velocity_S_radps, reading.clipped},
      reading_s_, squats);
}

void BodySensor::SquatBefore() {
  constexpr double kRestS = 5, kDownS = 1.5;
  const Eigen::Vector3d up_mps2(0, 0, kStandardGravityMps2);
  const arms::SquatTurn turn = reconstruction::SquatTurnOf(site_);
  const double depth_rad = DepthOf(site_);
  const double way_rad = turn.to_left_rad + turn.sd_rad * random_.Normal() +
                         errors_.slip_rad / depth_rad * random_.Normal();
  const Eigen::Vector3d axis =
      turn.about_left * Eigen::Vector3d(-std::sin(way_rad), std::cos(way_rad), 0);
  const auto rest = [&] {
    for (double t_s = 0; t_s < kRestS; t_s += reading_s_)
      Feel(up_mps2, Eigen::Vector3d::Zero(), false);
  };
  rest();
  attitude_.Align();
  for (double t_s = 0; t_s < 2 * kDownS; t_s += reading_s_) {  // Down and up.
    const double phase = kPi * t_s / kDownS;
    const double angle_rad = 0.5 * depth_rad * (1 - std::cos(phase));
    const double rate_radps = 0.5 * depth_rad * kPi / kDownS * std::sin(phase);
    Feel(arms::Turned(-angle_rad * axis) * up_mps2, rate_radps * axis, true);
  }
  rest();
  squatted_before_ = true;
}

void BodySensor::Align() {
  if (!squatted_before_) attitude_.Align();
  aligned_ = true;
}

arms::HandState BodySensor::Until(Eigen::Index column, double step_s, bool squats) {
  for (; next_ <= column; ++next_) {
    Feel(course_.specific_force_S_mps2.col(next_), course_.angular_velocity_S_radps.col(next_),
         squats);
  }
  const double stays = std::exp(-step_s / errors_.slip_s);
  slip_rad_ = stays * slip_rad_ +
              noise::NormalVector(errors_.slip_rad * std::sqrt(1 - stays * stays), random_);
  arms::HandState state = attitude_.state();
  state.valid = state.valid && aligned_;
  state.turn_W = state.turn_W * held_ * arms::Turned(slip_rad_);
  return state;
}

FoundHeading BodySensor::heading() const {
  if (!attitude_.state().valid) return {site_};
  // Where the device's x points, less what of it is up as the accelerometer has it at rest.
  constexpr int kReadings = 400;
  virtual_sensors::HeldErrors device(errors_.device);
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (int i = 0; i < kReadings; ++i) {
    up += device
              .Advance(mounting_ * Eigen::Vector3d(0, 0, kStandardGravityMps2),
                       Eigen::Vector3d::Zero(), reading_s_)
              .specific_force_S_mps2;
  }
  up.normalize();
  const Eigen::Vector3d ahead_W = mounting_.transpose() * (Eigen::Vector3d::UnitX() - up.x() * up);
  const double off_rad = attitude_.heading_rad() - std::atan2(ahead_W.y(), ahead_W.x());
  return {site_, true, std::remainder(off_rad, 2 * kPi), attitude_.mounting_sd_rad()};
}

ExtraSensors::ExtraSensors(const virtual_sensors::Scene& scene, HeadDevice head,
                           const std::vector<reconstruction::BodySite>& segments, bool squat_before,
                           std::uint64_t seed, double step_s)
    : step_s_(step_s) {
  if (head != HeadDevice::kNone) head_.emplace(scene.body, head, HeadErrors{}, seed, step_s);
  for (const reconstruction::BodySite site : segments) {
    BodySensorErrors errors;
    const bool is_strapped = !IsHand(site);
    if (is_strapped)
      errors.device.grip_tilt_rad = errors.device.grip_heading_rad = 0;  // At any angle.
    errors.slip_rad = SlipOf(site);
    segments_.emplace_back(scene, site, errors, seed);
    if (squat_before && is_strapped) segments_.back().SquatBefore();
  }
}

void ExtraSensors::Advance(const body::Kinematics& at, Eigen::Index column, bool in_t_pose,
                           bool aligns, bool squats, reconstruction::Inputs& inputs) {
  if (head_) head_->Advance(at, in_t_pose, inputs);
  for (BodySensor& sensor : segments_) {
    inputs.turns[static_cast<std::size_t>(sensor.site())] = sensor.Until(column, step_s_, squats);
    if (aligns) sensor.Align();
  }
}

std::vector<FoundHeading> ExtraSensors::headings() const {
  std::vector<FoundHeading> headings;
  for (const BodySensor& sensor : segments_) {
    if (!IsHand(sensor.site())) headings.push_back(sensor.heading());
  }
  return headings;
}

}  // namespace footing::pose_run
