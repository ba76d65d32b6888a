#include "daemon/simulation/pose/arm_tracker.h"

#include <numbers>

#include <Eigen/Dense>

namespace footing::arms {
namespace {

constexpr double kUnmeasuredVariance = 1e6;
/// Along a direction: what is of second order in its errors, and that bones are not straight.
constexpr double kLeastSd = 0.02;

double Squared(double x) { return x * x; }

/// Covariance of a direction that was `rest_W` in the T-pose, turned as the device has turned.
Eigen::Matrix3d TurnedCovariance(const HandState& state, const Eigen::Vector3d& rest_W) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d now_W = state.turn_W * rest_W;
  // About the vertical by the drift of the heading; by a strap that points wrong the axis of the
  // turn is wrong, which shows nothing in the T-pose.
  const Eigen::Vector3d by_drift = up.cross(now_W);
  const Eigen::Vector3d by_strap = by_drift - state.turn_W * up.cross(rest_W);
  return Squared(state.heading_sd_rad) * by_drift * by_drift.transpose() +
         Squared(kStrapHeadingSdRad) * by_strap * by_strap.transpose() +
         Squared(state.inclination_sd_rad) *
             (Eigen::Matrix3d::Identity() - now_W * now_W.transpose());
}

/// Directions measured by the devices; where none measures, the variance is kUnmeasuredVariance.
ArmBelief Measured(std::size_t arm, const SegmentStates& segments) {
  ArmBelief measured;
  measured.covariance *= kUnmeasuredVariance;
  const Eigen::Vector3d outwards = Eigen::Vector3d(0, arm == 0 ? 1 : -1, 0);
  const auto add = [&measured](Eigen::Index first, const HandState& state,
                               const Eigen::Vector3d& rest_W, double more_rad) {
    const Eigen::Vector3d now_W = state.turn_W * rest_W;
    measured.directions.segment<3>(first) = now_W;
    measured.covariance.block<3, 3>(first, first) =
        TurnedCovariance(state, rest_W) +
        Squared(more_rad) * (Eigen::Matrix3d::Identity() - now_W * now_W.transpose()) +
        Squared(kLeastSd) * Eigen::Matrix3d::Identity();
  };
  const HandState& upper = segments[static_cast<std::size_t>(Segment::kUpperArm)];
  const HandState& forearm = segments[static_cast<std::size_t>(Segment::kForearm)];
  if (upper.valid) {
    add(0, upper, outwards, 0);
    add(3, upper, Eigen::Vector3d::UnitZ(), 0);
  }
  if (forearm.valid) add(6, forearm, outwards, kWristSdRad);
  return measured;
}

}  // namespace

ArmBelief RegressedArm(std::size_t arm, const ArmModel& model, const Directions& predicted,
                       const HandState& hand) {
  ArmBelief belief;
  const ArmDirections left = Of(predicted);
  belief.directions = Stacked(arm == 1 ? Mirrored(left) : left);
  Directions mirror = Directions::Ones();
  if (arm == 1) mirror(1) = mirror(4) = mirror(7) = -1;
  belief.covariance = mirror.asDiagonal() * model.covariance * mirror.asDiagonal();
  Directions by_heading;
  for (Eigen::Index first = 0; first < kDirections; first += 3) {
    const Eigen::Vector3d direction = belief.directions.segment<3>(first);
    by_heading.segment<3>(first) = Eigen::Vector3d::UnitZ().cross(direction);
    belief.covariance.block<3, 3>(first, first) +=
        Squared(hand.inclination_sd_rad) *
        (Eigen::Matrix3d::Identity() - direction * direction.transpose());
  }
  belief.covariance += Squared(hand.heading_sd_rad) * by_heading * by_heading.transpose();
  return belief;
}

void Measure(std::size_t arm, const SegmentStates& segments, ArmBelief& belief) {
  if (!segments[0].valid && !segments[1].valid) return;
  const ArmBelief measured = Measured(arm, segments);
  const Eigen::Matrix<double, kDirections, kDirections> gain =
      belief.covariance * (belief.covariance + measured.covariance)
                              .llt()
                              .solve(Eigen::Matrix<double, kDirections, kDirections>::Identity());
  belief.directions += gain * (measured.directions - belief.directions);
  belief.covariance -= (gain * belief.covariance).eval();
}

ArmBelief StrappedArm(std::size_t arm, const SegmentStates& segments) {
  return Measured(arm, segments);
}

ArmEstimate ToEstimate(const ArmBelief& belief) {
  ArmEstimate estimate;
  estimate.directions = Of(belief.directions);
  const Directions sd = belief.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  estimate.upper_sd = sd.segment<3>(0);
  estimate.hinge_sd = sd.segment<3>(3);
  estimate.forearm_sd = sd.segment<3>(6);
  return estimate;
}

namespace {

/// Before any reading. A strapped device points along the arm, which a T-pose has to its side.
HandAttitude Unaligned(std::size_t arm, Place place) {
  if (place == Place::kFist) return HandAttitude();
  return HandAttitude((arm == 0 ? 0.5 : -0.5) * std::numbers::pi);
}

}  // namespace

ArmTracker::ArmTracker(const std::optional<ArmModel>& model,
                       const std::optional<arm_network::ArmNetwork>& network)
    : model_(model), network_(network) {
  for (std::size_t arm = 0; arm < kArms; ++arm) {
    for (const Place place : {Place::kFist, Place::kUpperArm, Place::kForearm}) Lose(arm, place);
  }
  estimates_[1].directions = Mirrored(estimates_[1].directions);
}

void ArmTracker::Add(std::size_t arm, const HandReading& reading, double step_s, Place place) {
  devices_[arm][static_cast<std::size_t>(place)].Advance(reading, step_s);
}

void ArmTracker::BeginTPose() {
  for (auto& devices : devices_) {
    for (HandAttitude& device : devices) device.BeginTPose();
  }
}

void ArmTracker::Lose(std::size_t arm, Place place) {
  devices_[arm][static_cast<std::size_t>(place)] = Unaligned(arm, place);
}

void ArmTracker::Align() {
  for (auto& devices : devices_) {
    for (HandAttitude& device : devices) device.Align();
  }
  features_ = {};
  network_poses_ = {};
  network_s_ = 0;
}

HandState ArmTracker::StateOf(std::size_t arm, Place place, const Heard& heard) const {
  HandState state = hand(arm, place);
  state.valid = state.valid && heard[arm][static_cast<std::size_t>(place)];
  return state;
}

ArmEstimate ArmTracker::Estimate(std::size_t arm, const Heard& heard) {
  const SegmentStates segments{StateOf(arm, Place::kUpperArm, heard),
                               StateOf(arm, Place::kForearm, heard)};
  const HandState fist = StateOf(arm, Place::kFist, heard);
  ArmEstimate estimate = estimates_[arm];
  estimate.valid = true;
  if (uses_network_ && network_ && fist.valid) {
    estimate = NetworkEstimate(arm);
  } else if (!uses_network_ && model_ && fist.valid) {
    features_.Compute(arm, values_);
    const bool other_known = StateOf(1 - arm, Place::kFist, heard).valid;
    ArmBelief belief = RegressedArm(arm, *model_, model_->Predict(values_, other_known), fist);
    Measure(arm, segments, belief);
    estimate = ToEstimate(belief);
    estimate.valid = true;
  } else if (segments[0].valid && segments[1].valid) {
    estimate = ToEstimate(StrappedArm(arm, segments));
    estimate.valid = true;
  } else {
    estimate.valid = false;
  }
  return estimate;
}

ArmEstimate ArmTracker::NetworkEstimate(std::size_t arm) const {
  const ArmDirections left = arm_network::ToDirections(network_poses_[arm], network_->elbow_axis_U);
  ArmEstimate estimate;
  estimate.valid = true;
  estimate.directions = arm == 1 ? Mirrored(left) : left;
  return estimate;
}

void ArmTracker::AdvanceNetwork(double step_s) {
  constexpr double kStepS = 1 / arm_network::kRateHz;
  for (network_s_ += step_s; network_s_ >= (1 - 1e-3) * kStepS; network_s_ -= kStepS) {
    for (std::size_t arm = 0; arm < kArms; ++arm) {
      if (!hand(arm).valid) continue;
      const auto input = arm_network::MakeInput(arm, hand(arm), features_);
      network_poses_[arm] = network_->Next(network_poses_[arm], input, kStepS);
    }
  }
}

const std::array<ArmEstimate, kArms>& ArmTracker::Advance(double step_s, const Heard& heard) {
  const bool any = hand(0).valid || hand(1).valid;
  if (any) features_.Advance({hand(0), hand(1)}, step_s);
  if (any && network_) AdvanceNetwork(step_s);
  for (std::size_t arm = 0; arm < kArms; ++arm) estimates_[arm] = Estimate(arm, heard);
  return estimates_;
}

}  // namespace footing::arms
