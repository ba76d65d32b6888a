#include <algorithm>
#include <cmath>

#include "common/body/momentum.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

/// What a frame's pose is solved for.
namespace footing::reconstruction {
namespace {

constexpr double kPaperHandSdM = 0.012, kPaperFootSdM = 0.02;
constexpr double kPaperComSdM = 0.03, kPaperHeightSdM = 0.05, kPaperAngularSd = 2;
constexpr double kKnownAngularSd = 1;
constexpr double kPaperArmSd = 0.2;  // Of an angle of the arm, rad.
constexpr double kHingeM = 0.25;     // At which a turn of the upper arm counts as a way.
constexpr double kMostHandM = 10;    // Nobody's hand is further from the cells.

}  // namespace

void Reconstruction::Remember(const Inputs& inputs) {
  Moment& now = past_[frames_ % kMostLag];
  now.hands = inputs.hands;
  for (HandInput& hand : now.hands) {
    hand.valid = hand.valid && hand.p_W_m.allFinite() && hand.sd_m.allFinite() &&
                 hand.sd_m.minCoeff() > 0 && (hand.p_W_m - origin_m_).norm() < kMostHandM;
  }
  now.arms = inputs.arms;
  for (arms::ArmEstimate& arm : now.arms) {
    const auto fine = [](const Eigen::Vector3d& way, const Eigen::Vector3d& sd) {
      return way.allFinite() && sd.allFinite() && sd.minCoeff() > 0;
    };
    arm.valid = arm.valid && fine(arm.directions.upper, arm.upper_sd) &&
                fine(arm.directions.hinge, arm.hinge_sd) &&
                fine(arm.directions.forearm, arm.forearm_sd);
  }
  if (best_ && options_.use_posture) SeePosture(now.hands);
  now.momentum = output_.momentum;
  now.known = inputs.known;
  ++frames_;
}

/// A pose of hands and feet alone knows nothing of the loads' C, so its errors are its own.
void Reconstruction::SeePosture(const std::array<HandInput, kHands>& hands) {
  if (!hands[0].valid || !hands[1].valid) return;
  targets_ = {};
  for (std::size_t side = 0; side < kHands; ++side) AddHandTarget(side, hands[side]);
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddFootTargets(parts_->feet[f], output_.momentum.feet[f], options_.best.foot, targets_);
  }
  TakeOrigin(targets_);
  posture_.Solve(targets_);
  output_.momentum = best_->SeePosture(origin_m_ + body::CentreOfMass(parts_->body, posture_.at()));
}

void Reconstruction::TakeLagged() {
  const std::size_t back = std::min(frames_, static_cast<std::size_t>(lag_steps_) + 1);
  then_ = past_[(frames_ - back) % kMostLag];
  // The estimator tells places as they were, the rest as it is.
  then_.momentum.p_WC_m = output_.momentum.p_WC_m;
  then_.momentum.position_variance_m2 = output_.momentum.position_variance_m2;
}

void Reconstruction::AdvanceFeatures() {
  for (std::size_t side = 0; side < kHands; ++side) {
    if (then_.hands[side].valid) last_hands_m_[side] = then_.hands[side].p_W_m;
  }
  features_.Advance(last_hands_m_, then_.momentum);
}

void Reconstruction::PlaceTargets() {
  targets_.count = 0;
  targets_.has_com = targets_.has_angular = false;
  for (std::size_t side = 0; side < kHands; ++side) {
    const HandInput& hand = then_.hands[side];
    if (!hand.valid) {
      AddArmTargets(side);
      continue;
    }
    AddHandTarget(side, hand);
  }
  AddFeet();
  HoldFeet();
  AddMomentumTargets();
  TakeOrigin(targets_);
  TakeOrigin(standing_);
}

void Reconstruction::AddHandTarget(std::size_t side, const HandInput& hand) {
  const body::Point& fist = parts_->fists[side];
  pose::PointTarget target{fist.joint, fist.p_J_m, hand.p_W_m, hand.sd_m};
  if (options_.mode == Mode::kPaper) {
    target.sd_m.setConstant(kPaperHandSdM);
  } else {
    target.sd_m = (hand.sd_m.array().square() + std::pow(options_.best.hand_sd_m, 2)).sqrt();
  }
  targets_.Add(target);
}

/// Places in W are told from there.
void Reconstruction::TakeOrigin(pose::PoseTargets& targets) const {
  for (int i = 0; i < targets.count; ++i) {
    pose::PointTarget& point = targets.points[static_cast<std::size_t>(i)];
    if (point.from_joint < 0) point.p_W_m -= origin_m_;
  }
  targets.com_W_m -= origin_m_;
}

/// The arm-angle error of equation (6): three of the shoulder, one of the elbow, as ways of the
/// elbow from the shoulder, of a point beside the upper arm, and of the fist from the elbow.
void Reconstruction::AddArmTargets(std::size_t side) {
  const arms::ArmEstimate& told = then_.arms[side];
  if (!told.valid) return;
  const arms::ArmGeometry& arm = parts_->arms[side];
  const bool paper = options_.mode == Mode::kPaper;
  const auto add = [&](int joint, const Eigen::Vector3d& p_J_m, int from, double length_m,
                       const Eigen::Vector3d& way, const Eigen::Vector3d& sd) {
    pose::PointTarget target{joint, p_J_m, length_m * way, length_m * options_.best.arm_spread * sd,
                             from};
    if (paper) target.sd_m.setConstant(length_m * kPaperArmSd);
    targets_.Add(target);
  };
  add(arm.elbow, Eigen::Vector3d::Zero(), arm.shoulder, arm.upper_m, told.directions.upper,
      told.upper_sd);
  add(arm.shoulder, kHingeM * arm.hinge_J, arm.shoulder, kHingeM, told.directions.hinge,
      told.hinge_sd);
  add(arm.fist.joint, arm.fist.p_J_m, arm.elbow, arm.forearm_m, told.directions.forearm,
      told.forearm_sd);
}

void Reconstruction::AddFeet() {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const FootGeometry& geometry = parts_->feet[f];
    if (then_.known.feet) {
      const Known::Foot& foot = (*then_.known.feet)[f];
      targets_.Add({geometry.ankle.joint, geometry.ankle.p_J_m, foot.ankle_W_m,
                    Eigen::Vector3d::Constant(foot.ankle_sd_m)});
      targets_.Add({geometry.toe.joint, geometry.toe.p_J_m, foot.toe_W_m,
                    Eigen::Vector3d::Constant(foot.toe_sd_m)});
    } else if (options_.mode == Mode::kPaper) {
      AddPaperFootTargets(geometry, then_.momentum.feet[f], kPaperFootSdM, targets_);
    } else {
      AddFootTargets(geometry, then_.momentum.feet[f], options_.best.foot, targets_);
    }
  }
}

/// The clean-up goes to where the foot is shown to stand, the solver to where it is most likely.
void Reconstruction::HoldFeet() {
  standing_.count = 0;
  const bool held = options_.mode == Mode::kBest && !then_.known.feet;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    std::array<pose::PointTarget, FootLock::kPoints> points;
    std::array<Eigen::Vector3d, FootLock::kPoints> told, shown;
    std::size_t count = 0;
    for (int i = 0; i < targets_.count && count < points.size(); ++i) {
      const pose::PointTarget& point = targets_.points[static_cast<std::size_t>(i)];
      const FootGeometry& foot = parts_->feet[f];
      if (point.joint != foot.ankle.joint && point.joint != foot.toe.joint) continue;
      const auto joint = static_cast<std::size_t>(point.joint);
      told[count] = point.p_W_m;
      shown[count] =
          body::Place({point.joint, point.p_J_m}, output_.R_WJ[joint], output_.p_WJ_m[joint]);
      points[count++] = point;
    }
    if (count < points.size()) continue;
    if (held) {
      const auto places = locks_[f].Advance(then_.momentum.feet[f].contact, told, shown, step_s_);
      for (std::size_t i = 0; i < count; ++i) points[i].p_W_m = places[i];
    }
    for (const pose::PointTarget& point : points) standing_.Add(point);
  }
}

void Reconstruction::AddMomentumTargets() {
  const momentum::Estimate& told = then_.momentum;
  const Known& known = then_.known;
  const bool paper = options_.mode == Mode::kPaper;
  targets_.has_com = options_.use_momentum || known.com_W_m;
  targets_.com_W_m = told.p_WC_m;
  targets_.has_angular =
      options_.use_angular_momentum && (paper || known.angular_W || options_.best.angular_sd > 0);
  // The solver's masses are the body's, which the cells have weighed anew.
  targets_.angular_W = told.angular_momentum_kgm2ps * (parts_->body.mass_kg / output_.mass_kg);
  if (paper) {
    targets_.com_sd_m << kPaperComSdM, kPaperComSdM, kPaperHeightSdM;
    targets_.angular_sd.setConstant(kPaperAngularSd);
  } else {
    targets_.com_sd_m =
        (told.position_variance_m2.array() + std::pow(options_.best.com_sd_m, 2)).sqrt();
    targets_.angular_sd =
        (told.angular_momentum_variance.array() + std::pow(options_.best.angular_sd, 2)).sqrt();
  }
  if (known.com_W_m) {
    targets_.com_W_m = *known.com_W_m;
    targets_.com_sd_m = known.com_sd_m;
  }
  if (known.angular_W) {
    targets_.angular_W = *known.angular_W;
    targets_.angular_sd.setConstant(kKnownAngularSd);
  }
}

}  // namespace footing::reconstruction
