#include "daemon/offline/pose_run/extra_sensors.h"

#include <algorithm>
#include <cmath>

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
      reading_s_(1 / scene.motion.rate_hz) {}

arms::HandState BodySensor::Until(Eigen::Index column, double step_s) {
  for (; next_ <= column; ++next_) {
    const auto reading = device_.Advance(course_.specific_force_S_mps2.col(next_),
                                         course_.angular_velocity_S_radps.col(next_), reading_s_);
    attitude_.Advance(
        {reading.specific_force_S_mps2, reading.angular_velocity_S_radps, reading.clipped},
        reading_s_);
  }
  const double stays = std::exp(-step_s / errors_.slip_s);
  slip_rad_ = stays * slip_rad_ +
              noise::NormalVector(errors_.slip_rad * std::sqrt(1 - stays * stays), random_);
  arms::HandState state = attitude_.state();
  state.turn_W = state.turn_W * arms::Turned(slip_rad_);
  return state;
}

ExtraSensors::ExtraSensors(const virtual_sensors::Scene& scene, HeadDevice head,
                           const std::vector<reconstruction::BodySite>& segments,
                           std::uint64_t seed, double step_s)
    : step_s_(step_s) {
  if (head != HeadDevice::kNone) head_.emplace(scene.body, head, HeadErrors{}, seed, step_s);
  for (const reconstruction::BodySite site : segments) {
    BodySensorErrors errors;
    errors.slip_rad = SlipOf(site);
    segments_.emplace_back(scene, site, errors, seed);
  }
}

void ExtraSensors::Advance(const body::Kinematics& at, Eigen::Index column, bool in_t_pose,
                           bool aligns, reconstruction::Inputs& inputs) {
  if (head_) head_->Advance(at, in_t_pose, inputs);
  for (BodySensor& sensor : segments_) {
    inputs.turns[static_cast<std::size_t>(sensor.site())] = sensor.Until(column, step_s_);
    if (aligns) sensor.Align();
  }
}

}  // namespace footing::pose_run
