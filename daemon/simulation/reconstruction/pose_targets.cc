#include "daemon/simulation/reconstruction/pose_targets.h"

#include <cmath>
#include <cstddef>

#include "daemon/simulation/reconstruction/report.h"

namespace footing::reconstruction {
namespace {

constexpr double kPaperHandSdM = 0.012, kPaperFootSdM = 0.02;
constexpr double kPaperComSdM = 0.03, kPaperHeightSdM = 0.05, kPaperAngularSd = 2;
constexpr double kPaperArmSdRad = 0.2;
constexpr double kTrueFootSdM = 0.015, kTrueComSdM = 0.01, kTrueAngularSd = 1;
constexpr double kHingeM = 0.25;  // Distance at which a turn of the upper arm counts as a length.
constexpr int kPelvis = 0;        // The root.
constexpr double kPelvisM = 0.2;  // The same of the pelvis; any length makes the same terms.

pose::PointTarget FistTarget(const body::Point& fist, const HandInput& hand,
                             const Eigen::Vector3d& sd_m) {
  return {fist.joint, fist.p_J_m, hand.p_W_m,
          sd_m,       -1,         pose::WhiteningOf(sd_m, hand.covariance_m2)};
}

/// Three targets, of unit vectors times lengths; `sd_m` maps length and deviation to a deviation.
template <typename SdM>
void AddArmTargets(const arms::ArmGeometry& arm, const arms::ArmEstimate& estimate, SdM sd_m,
                   pose::PoseTargets& targets) {
  if (!estimate.valid) return;
  const auto add = [&](int joint, const Eigen::Vector3d& p_J_m, int from, double length_m,
                       const Eigen::Vector3d& direction, const Eigen::Vector3d& sd) {
    targets.Add({joint, p_J_m, length_m * direction, sd_m(length_m, sd), from});
  };
  const arms::ArmDirections& directions = estimate.directions;
  add(arm.elbow, Eigen::Vector3d::Zero(), arm.shoulder, arm.upper_m, directions.upper,
      estimate.upper_sd);
  add(arm.shoulder, kHingeM * arm.hinge_J, arm.shoulder, kHingeM, directions.hinge,
      estimate.hinge_sd);
  add(arm.fist.joint, arm.fist.p_J_m, arm.elbow, arm.forearm_m, directions.forearm,
      estimate.forearm_sd);
}

void AddJoints(const FootGeometry& geometry, const Eigen::Vector3d& ankle_W_m, double ankle_sd_m,
               const Eigen::Vector3d& toe_W_m, double toe_sd_m, pose::PoseTargets& targets) {
  targets.Add({geometry.ankle.joint, geometry.ankle.p_J_m, ankle_W_m,
               Eigen::Vector3d::Constant(ankle_sd_m)});
  targets.Add(
      {geometry.toe.joint, geometry.toe.p_J_m, toe_W_m, Eigen::Vector3d::Constant(toe_sd_m)});
}

Eigen::Vector3d AngularTarget(const SubjectModel& model, const Measurement& then, double mass_kg) {
  return then.momentum.angular_momentum_kgm2ps * (model.body.mass_kg / mass_kg);
}

}  // namespace

void AddHandTargets(const SubjectModel& model, const Measurement& then, const BestConstants& best,
                    pose::PoseTargets& targets) {
  const auto arm_sd_m = [&](double length_m, const Eigen::Vector3d& sd) {
    return Eigen::Vector3d(length_m * best.arm_spread * sd);
  };
  for (std::size_t side = 0; side < kHands; ++side) {
    const HandInput& hand = then.hands[side];
    if (!hand.valid) {
      AddArmTargets(model.arms[side], then.arms[side], arm_sd_m, targets);
      continue;
    }
    targets.Add(FistTarget(model.fists[side], hand,
                           (hand.sd_m.array().square() + std::pow(best.hand_sd_m, 2)).sqrt()));
  }
}

void AddPaperHandTargets(const SubjectModel& model, const Measurement& then,
                         pose::PoseTargets& targets) {
  const auto arm_sd_m = [](double length_m, const Eigen::Vector3d&) {
    return Eigen::Vector3d(Eigen::Vector3d::Constant(length_m * kPaperArmSdRad));
  };
  for (std::size_t side = 0; side < kHands; ++side) {
    const HandInput& hand = then.hands[side];
    if (!hand.valid) {
      AddArmTargets(model.arms[side], then.arms[side], arm_sd_m, targets);
      continue;
    }
    const body::Point& fist = model.fists[side];
    targets.Add({fist.joint, fist.p_J_m, hand.p_W_m, Eigen::Vector3d::Constant(kPaperHandSdM)});
  }
}

void AddBeltTargets(const SubjectModel& model, const arms::HandState& belt,
                    const BestConstants& best, pose::PoseTargets& targets) {
  if (!belt.valid) return;
  const Eigen::Matrix3d& R_WJ = model.t_pose_at.R_WJ[kPelvis];
  const auto add = [&](const Eigen::Vector3d& was_W, const Eigen::Vector3d& sd_m) {
    targets.Add({kPelvis, kPelvisM * (R_WJ.transpose() * was_W), kPelvisM * (belt.turn_W * was_W),
                 sd_m, kPelvis});
  };
  const double lean_m = kPelvisM * std::hypot(belt.inclination_sd_rad, best.belt_sd_rad);
  const double turn_m = kPelvisM * std::hypot(belt.heading_sd_rad, best.belt_sd_rad);
  add(Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Constant(lean_m));
  // How far it points up is the inclination's, which the first one has.
  add(Eigen::Vector3d::UnitX(), {turn_m, turn_m, kUnknownSdM});
}

void AddFeetTargets(const SubjectModel& model, const Measurement& then, const FootSpread& spread,
                    pose::PoseTargets& targets) {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddFootTargets(model.feet[f], then.momentum.feet[f], spread, targets);
  }
}

void AddPaperFeetTargets(const SubjectModel& model, const Measurement& then,
                         pose::PoseTargets& targets) {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddPaperFootTargets(model.feet[f], then.momentum.feet[f], kPaperFootSdM, targets);
  }
}

void AddFeetTargets(const SubjectModel& model, const std::array<FootPrior, momentum::kFeet>& feet,
                    pose::PoseTargets& targets) {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddJoints(model.feet[f], feet[f].ankle_W_m, feet[f].ankle_sd_m, feet[f].toe_W_m,
              feet[f].toe_sd_m, targets);
  }
}

void AddFeetTargets(const SubjectModel& model, const std::array<Truth::Foot, momentum::kFeet>& feet,
                    pose::PoseTargets& targets) {
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    AddJoints(model.feet[f], feet[f].ankle_W_m, kTrueFootSdM, feet[f].toe_W_m, kTrueFootSdM,
              targets);
  }
}

void SetMomentumTargets(const SubjectModel& model, const Measurement& then, double mass_kg,
                        const Options& options, pose::PoseTargets& targets) {
  const momentum::Estimate& estimate = then.momentum;
  targets.has_com = options.use_momentum;
  targets.com_W_m = estimate.p_WC_m;
  targets.com_sd_m =
      (estimate.position_variance_m2.array() + std::pow(options.best.com_sd_m, 2)).sqrt();
  if (!estimate.trusted) targets.com_sd_m.z() = kUnknownSdM;
  if (!estimate.whole_weight) targets.com_sd_m.setConstant(kUnknownSdM);
  targets.has_angular = options.use_angular_momentum && options.best.angular_sd > 0;
  targets.angular_W = AngularTarget(model, then, mass_kg);
  targets.angular_sd =
      (estimate.angular_momentum_variance.array() + std::pow(options.best.angular_sd, 2)).sqrt();
}

void SetPaperMomentumTargets(const SubjectModel& model, const Measurement& then, double mass_kg,
                             const Options& options, pose::PoseTargets& targets) {
  targets.has_com = options.use_momentum;
  targets.com_W_m = then.momentum.p_WC_m;
  targets.com_sd_m << kPaperComSdM, kPaperComSdM, kPaperHeightSdM;
  targets.has_angular = options.use_angular_momentum;
  targets.angular_W = AngularTarget(model, then, mass_kg);
  targets.angular_sd.setConstant(kPaperAngularSd);
}

void SetMomentumTargets(const std::optional<WalkPrior::Com>& com, pose::PoseTargets& targets) {
  targets.has_angular = false;
  targets.has_com = com.has_value();
  if (!com) return;
  targets.com_W_m = com->p_W_m;
  targets.com_sd_m = com->sd_m;
}

void OverrideMomentumTargets(const Truth& truth, const Options& options,
                             pose::PoseTargets& targets) {
  if (truth.com_W_m) {
    targets.has_com = true;
    targets.com_W_m = *truth.com_W_m;
    targets.com_sd_m.setConstant(kTrueComSdM);
  }
  if (truth.angular_W) {
    targets.has_angular = options.use_angular_momentum;
    targets.angular_W = *truth.angular_W;
    targets.angular_sd.setConstant(kTrueAngularSd);
  }
}

void Clear(pose::PoseTargets& targets) {
  targets.count = 0;
  targets.has_com = targets.has_angular = false;
  targets.com_W_m.setZero();
}

void MoveOrigin(const Eigen::Vector3d& origin_m, pose::PoseTargets& targets) {
  for (int i = 0; i < targets.count; ++i) {
    pose::PointTarget& point = targets.points[static_cast<std::size_t>(i)];
    if (point.from_joint < 0) point.p_W_m -= origin_m;
  }
  targets.com_W_m -= origin_m;
}

std::optional<FootPoints> PointsOf(const FootGeometry& foot, const pose::PoseTargets& targets) {
  FootPoints points;
  std::size_t count = 0;
  for (int i = 0; i < targets.count && count < points.size(); ++i) {
    const pose::PointTarget& point = targets.points[static_cast<std::size_t>(i)];
    if (point.joint == foot.ankle.joint || point.joint == foot.toe.joint) points[count++] = point;
  }
  if (count < points.size()) return std::nullopt;
  return points;
}

}  // namespace footing::reconstruction
