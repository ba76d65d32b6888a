#include "daemon/simulation/reconstruction/measurement.h"

#include <cmath>

#include "common/body/momentum.h"
#include "daemon/simulation/reconstruction/pose_targets.h"
#include "daemon/simulation/reconstruction/report.h"
#include "daemon/simulation/reconstruction/skeleton.h"

namespace footing::reconstruction {
namespace {

constexpr double kMostHandM = 10;  // No part of a person is further from the cells.

bool IsUsable(const PointInput& point, const Eigen::Vector3d& origin_m) {
  return point.valid && point.p_W_m.allFinite() && point.sd_m.allFinite() &&
         point.covariance_m2.allFinite() && point.sd_m.minCoeff() > 0 &&
         (point.p_W_m - origin_m).norm() < kMostHandM;
}

bool UsableDirection(const Eigen::Vector3d& direction, const Eigen::Vector3d& sd) {
  return direction.allFinite() && sd.allFinite() && sd.minCoeff() > 0;
}

}  // namespace

bool Measurement::skeleton() const { return IsSkeleton(joints); }

std::array<HandInput, kHands> UsableHands(const std::array<HandInput, kHands>& hands,
                                          const Eigen::Vector3d& origin_m) {
  std::array<HandInput, kHands> usable = hands;
  for (HandInput& hand : usable) hand.valid = IsUsable(hand, origin_m);
  return usable;
}

JointInputs UsableJoints(const JointInputs& joints, const Eigen::Vector3d& origin_m) {
  JointInputs usable = joints;
  for (JointInput& joint : usable) joint.valid = IsUsable(joint, origin_m);
  return usable;
}

std::array<arms::ArmEstimate, kHands> UsableArms(
    const std::array<arms::ArmEstimate, kHands>& arms) {
  std::array<arms::ArmEstimate, kHands> usable = arms;
  for (arms::ArmEstimate& arm : usable) {
    arm.valid = arm.valid && UsableDirection(arm.directions.upper, arm.upper_sd) &&
                UsableDirection(arm.directions.hinge, arm.hinge_sd) &&
                UsableDirection(arm.directions.forearm, arm.forearm_sd);
  }
  return usable;
}

arms::HandState UsableBelt(const arms::HandState& belt) {
  constexpr double kRounding = 1e-3;
  arms::HandState usable = belt;
  const Eigen::Matrix3d square = belt.turn_W.transpose() * belt.turn_W;
  usable.valid = belt.valid && square.isIdentity(kRounding) && belt.turn_W.determinant() > 0 &&
                 std::isfinite(belt.heading_sd_rad) && std::isfinite(belt.inclination_sd_rad) &&
                 belt.heading_sd_rad >= 0 && belt.inclination_sd_rad >= 0;
  return usable;
}

void ReportTPose(const SubjectModel& model, const Options& options, Output& output) {
  const auto joints = static_cast<std::size_t>(model.body.skeleton.size());
  output.calibrated = false;
  output.calibration_progress = 0;
  output.valid = false;
  output.lag_s = options.lag_steps() * options.step_s();
  output.mass_kg = model.body.mass_kg;
  output.momentum = {};
  output.R_WJ.resize(joints);
  output.p_WJ_m.resize(joints);
  ReportPose(model.t_pose, model.t_pose_at, output);
  output.com_W_m = body::CentreOfMass(model.body, model.t_pose_at);
  output.com_variance_m2.setConstant(kUnknownSdM * kUnknownSdM);
  output.joint_sd_m.assign(joints, kUnknownSdM);
}

bool Calibrate(const Inputs& inputs, double step_s, momentum::TPoseCalibration& calibration,
               Output& output) {
  const bool complete = calibration.Advance(inputs.loads, step_s);
  output.calibration_progress = calibration.progress();
  output.calibration_restarts = calibration.restarts();
  if (!complete) return false;
  output.mass_kg = calibration.result().mass_kg;
  output.calibrated = true;
  return true;
}

BestEstimate::BestEstimate(const SubjectModel& model, const Options& options)
    : model_(&model),
      options_(options),
      likely_(model, options.step_s()),
      plain_(model.body, model.basis, PostureSolverOptions(options)) {
  if (!model.posture.empty()) {
    learned_.emplace(model.body, model.posture.rest, PostureSolverOptions(options));
  }
}

void BestEstimate::Start(const momentum::TPose& pose, const Eigen::Vector3d& origin_m) {
  momentum::BestConfig config;
  config.lag_s = options_.lag_steps() * options_.step_s();
  if (!model_->posture.empty()) config.height_posture = momentum::LearnedHeightPosture();
  estimator_.emplace(config, model_->subject, pose, options_.step_s());
  likely_.Start();
  plain_.Reset();
  if (learned_) learned_->Reset();
  origin_m_ = origin_m;
}

Measurement BestEstimate::Advance(const Inputs& inputs, const JointPoints& points) {
  Measurement now{UsableHands(inputs.hands, origin_m_), UsableArms(inputs.arms),
                  estimator_->Advance(inputs.loads), UsableJoints(inputs.joints, origin_m_),
                  UsableBelt(inputs.belt)};
  if (options_.use_posture && now.both_hands()) {
    SeePosture(points, now);
  }
  return now;
}

void BestEstimate::SeePosture(const JointPoints& points, Measurement& now) {
  likely_.Advance({now.hands[0].p_W_m, now.hands[1].p_W_m}, now.momentum);
  targets_ = {};
  AddHandTargets(*model_, now, options_.best, targets_);
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddFootTargets(model_->feet[f], now.momentum.feet[f], options_.best.foot, targets_);
  }
  MoveOrigin(origin_m_, targets_);
  plain_.Solve(targets_);
  const Eigen::Vector3d plain_m = body::CentreOfMass(model_->body, plain_.at());
  now.posture_com_W_m = origin_m_ + plain_m;
  if (learned_) {
    AddExtraTargets(now, points);
    learned_->Solve(targets_, likely_.Predict(origin_m_));
    now.posture_com_W_m = origin_m_ + body::CentreOfMass(model_->body, learned_->at());
  }
  now.momentum = estimator_->SeePosture(origin_m_.y() + plain_m.y(), *now.posture_com_W_m);
}

void BestEstimate::AddExtraTargets(const Measurement& now, const JointPoints& points) {
  pose::PoseTargets extra;
  if (!now.skeleton()) AddJointTargets(points, now.joints, extra);
  AddBeltTargets(*model_, now.belt, options_.best, extra);
  MoveOrigin(origin_m_, extra);
  for (int i = 0; i < extra.count; ++i) targets_.Add(extra.points[static_cast<std::size_t>(i)]);
}

void PaperEstimate::Start(const momentum::TPose& pose, const Eigen::Vector3d& origin_m) {
  estimator_.emplace(momentum::PaperConfig{}, model_->subject, pose, step_s_);
  if (model_->horizontal) horizontal_.emplace(*model_->horizontal, pose, step_s_);
  origin_m_ = origin_m;
}

Measurement PaperEstimate::Advance(const Inputs& inputs) {
  std::optional<Eigen::Vector2d> com_m;
  if (horizontal_) com_m = horizontal_->Advance(inputs.loads);
  return {UsableHands(inputs.hands, origin_m_), UsableArms(inputs.arms),
          estimator_->Advance(inputs.loads, com_m)};
}

}  // namespace footing::reconstruction
