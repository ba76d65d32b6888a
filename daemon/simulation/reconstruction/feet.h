#pragma once

#include <Eigen/Core>
#include <array>

#include "common/body/body.h"
#include "common/body/points.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/pose/targets.h"

namespace footing::reconstruction {

/// A foot flat on the ground: where ankle and ball are from F, the point where the centre of
/// pressure rests (momentum::FootShape). Foot frame: x to the toes, y left, z up.
struct FootGeometry {
  momentum::FootShape shape;
  body::Point ankle;
  body::Point toe;
  Eigen::Vector3d ankle_F_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d toe_F_m = Eigen::Vector3d::Zero();
  /// From W: turned by shape.yaw_rad.
  Eigen::Matrix3d R_WF = Eigen::Matrix3d::Identity();
};

/// Of both feet, from the body in its T-pose.
std::array<FootGeometry, momentum::kFeet> StandingFeet(const body::Body& body);

/// What the T-pose of a body tells of who stands on the cells.
momentum::Subject SubjectOf(const body::Body& body);

/// How well a foot's estimate tells where its joints are, one standard deviation, m.
struct FootSpread {
  double along = 0.03;  ///< In contact, beside the variance of F itself.
  double across = 0.02;
  double ankle_up = 0.02;
  double toe_up = 0.012;
  double lift = 0.10;         ///< In the air: how high it is taken to be,
  double lift_time_s = 0.15;  ///< after so long,
  double air_mps = 0.4;       ///< and how fast all spreads grow.
};

/// Adds targets of ankle and ball.
void AddFootTargets(const FootGeometry& geometry, const momentum::FootEstimate& foot,
                    const FootSpread& spread, pose::PoseTargets& targets);

/// The same as the paper has it: stiff constraints at where the foot was told to be.
void AddPaperFootTargets(const FootGeometry& geometry, const momentum::FootEstimate& foot,
                         double sd_m, pose::PoseTargets& targets);

}  // namespace footing::reconstruction
