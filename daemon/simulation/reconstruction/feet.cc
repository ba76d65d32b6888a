#include "daemon/simulation/reconstruction/feet.h"

#include <algorithm>
#include <cmath>

#include "common/body/kinematics.h"
#include "common/body/momentum.h"

namespace footing::reconstruction {
namespace {

constexpr double kHeelBehindM = 0.045;  // Of the ankle, as the soles of common/virtual/sensors.
constexpr double kMostSpreadM = 0.6;

body::Kinematics InTPose(const body::Body& body) {
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  return at;
}

pose::PointTarget Target(const body::Point& point, const Eigen::Vector3d& p_W_m,
                         const Eigen::Vector3d& sd_m) {
  return {point.joint, point.p_J_m, p_W_m, sd_m};
}

}  // namespace

std::array<FootGeometry, momentum::kFeet> StandingFeet(const body::Body& body) {
  const body::Kinematics at = InTPose(body);
  std::array<FootGeometry, momentum::kFeet> feet;
  for (int side = 0; side < 2; ++side) {
    FootGeometry& foot = feet[static_cast<std::size_t>(side)];
    foot.ankle = body::Ankle(body, side);
    foot.toe = body::Toe(body, side);
    const Eigen::Vector3d ankle = body::Place(foot.ankle, at), toe = body::Place(foot.toe, at);
    const Eigen::Vector3d tip = body::Place(body::ToeEnd(body, side), at);
    const Eigen::Vector2d along = (tip - ankle).head<2>();
    momentum::FootShape& shape = foot.shape;
    if (along.norm() > 0.02) {
      shape.yaw_rad = std::atan2(along.y(), along.x());
      shape.length_m = along.norm() + kHeelBehindM;
    }
    foot.R_WF = body::AxisRotation(body::Axis::kZ, shape.yaw_rad);
    const double to_rest_m = shape.rest_share * shape.length_m - kHeelBehindM;
    foot.ankle_F_m = {-to_rest_m, 0, ankle.z()};
    foot.toe_F_m = foot.ankle_F_m + foot.R_WF.transpose() * (toe - ankle);
    const Eigen::Matrix3d& R_WJ = at.R_WJ[static_cast<std::size_t>(foot.ankle.joint)];
    foot.heel = foot.ankle;
    foot.heel.p_J_m += R_WJ.transpose() * foot.R_WF * Eigen::Vector3d(-kHeelBehindM, 0, -ankle.z());
  }
  return feet;
}

momentum::Subject SubjectOf(const body::Body& body) {
  momentum::Subject subject;
  subject.com_height_m = body::CentreOfMass(body, InTPose(body)).z();
  const auto feet = StandingFeet(body);
  for (std::size_t f = 0; f < feet.size(); ++f) subject.feet[f] = feet[f].shape;
  return subject;
}

void AddFootTargets(const FootGeometry& geometry, const momentum::FootEstimate& foot,
                    const FootSpread& spread, pose::PoseTargets& targets) {
  if (!foot.valid) return;
  const double aloft_s = foot.contact ? 0 : foot.airborne_s;
  const double off = 1 - std::exp(-aloft_s / spread.lift_time_s);  // 0 on the ground, 1 in the air.
  const Eigen::Vector3d place =
      foot.p_WF_m +
      geometry.R_WF * Eigen::Vector3d(spread.ahead + off * spread.forward, 0, off * spread.lift);
  // W's axes serve as the foot's: a foot points ahead, more or less.
  const auto sd = [&](double up_m) {
    const Eigen::Array3d own(spread.along, spread.across, up_m);
    const Eigen::Array3d air(spread.air_level, spread.air_level, spread.air_up);
    const Eigen::Array3d all =
        foot.variance_m2.array() * Eigen::Array3d(1, 1, 0) + own.square() + (off * air).square();
    return Eigen::Vector3d(all.sqrt().min(kMostSpreadM));
  };
  const auto up = [&](double rise_m) { return Eigen::Vector3d(0, 0, (1 - off) * rise_m); };
  targets.Add(Target(geometry.ankle,
                     place + geometry.R_WF * geometry.ankle_F_m + up(spread.ankle_rise),
                     sd(spread.ankle_up)));
  targets.Add(Target(geometry.toe, place + geometry.R_WF * geometry.toe_F_m + up(spread.toe_rise),
                     sd(spread.toe_up)));
}

void AddPaperFootTargets(const FootGeometry& geometry, const momentum::FootEstimate& foot,
                         double sd_m, pose::PoseTargets& targets) {
  if (!foot.valid) return;
  const Eigen::Vector3d sd = Eigen::Vector3d::Constant(sd_m);
  targets.Add(Target(geometry.ankle, foot.p_WF_m + geometry.R_WF * geometry.ankle_F_m, sd));
  targets.Add(Target(geometry.toe, foot.p_WF_m + geometry.R_WF * geometry.toe_F_m, sd));
}

}  // namespace footing::reconstruction
