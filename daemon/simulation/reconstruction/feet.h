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
  body::Point heel;  ///< Under and behind the ankle, on the ground.
  Eigen::Vector3d ankle_F_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d toe_F_m = Eigen::Vector3d::Zero();
  /// From W: turned by shape.yaw_rad.
  Eigen::Matrix3d R_WF = Eigen::Matrix3d::Identity();

  /// How far F is ahead of the heel.
  double RestM() const { return shape.rest_share * shape.length_m; }
};

/// Of both feet, from the body in its T-pose.
std::array<FootGeometry, momentum::kFeet> StandingFeet(const body::Body& body);

/// Of the person on the cells, by the body in its T-pose.
momentum::Subject SubjectOf(const body::Body& body);

/// Where a foot's joints are from its estimate, by how far recorded feet were off it
/// (docs/pose.md); m, and one standard deviation.
struct FootSpread {
  double along = 0.03;  ///< In contact, beside the variance of F itself.
  double across = 0.02;
  double ankle_up = 0.024;
  double toe_up = 0.02;
  double ahead = -0.015;                        ///< Of F, feet of people who move.
  double ankle_rise = 0.015, toe_rise = 0.012;  ///< Feet are not always flat;
  double flat_up = 0.005;     ///< In the T-pose they are: its deviation of both heights,
  double leave_m = 0.3;       ///< and the hands' way out of it with which they rise (StandingRise).
  double lift = 0.22;         ///< In the air, how high the foot is,
  double forward = 0.05;      ///< and how far ahead of where it stood,
  double lift_time_s = 0.12;  ///< with this time constant;
  double air_level = 0.20;    ///< and how far off that it is.
  double air_up = 0.17;
};

/// Adds targets of ankle and ball.
void AddFootTargets(const FootGeometry& geometry, const momentum::FootEstimate& foot,
                    const FootSpread& spread, pose::PoseTargets& targets);

/// The same as the paper has it: stiff constraints at the foot's estimate.
void AddPaperFootTargets(const FootGeometry& geometry, const momentum::FootEstimate& foot,
                         double sd_m, pose::PoseTargets& targets);

}  // namespace footing::reconstruction
