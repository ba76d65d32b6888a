#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>

#include "common/body/kinematics.h"

namespace footing::pose {

/// A point of the body that is known to be somewhere in W, or from the origin of another joint.
struct PointTarget {
  int joint = 0;                                    ///< Whose frame it is fixed to.
  Eigen::Vector3d p_J_m = Eigen::Vector3d::Zero();  ///< In that frame.
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();  ///< Where it should be.
  Eigen::Vector3d sd_m = Eigen::Vector3d::Ones();   ///< Along W's axes, positive.
  int from_joint = -1;  ///< p_W_m is the way from there to the point, along W's axes; -1: from W.
  /// Turns errors over sd_m into independent ones of deviation 1 (WhiteningOf). The identity: they
  /// are independent along W's axes.
  Eigen::Matrix3d whitening = Eigen::Matrix3d::Identity();
};

/// The inverse Cholesky factor of the correlations that belong to these covariances of x and y, x
/// and z, y and z. Correlations count for 0.999 of what they are, so that no direction is known
/// exactly; those that no errors can have do not count.
inline Eigen::Matrix3d WhiteningOf(const Eigen::Vector3d& sd_m,
                                   const Eigen::Vector3d& covariance_m2) {
  if (covariance_m2.isZero(0)) return Eigen::Matrix3d::Identity();
  constexpr double kCounts = 0.999;
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Identity();
  const auto set = [&](int i, int j, double value_m2) {
    correlation(i, j) = correlation(j, i) = kCounts * value_m2 / (sd_m(i) * sd_m(j));
  };
  set(0, 1, covariance_m2.x());
  set(0, 2, covariance_m2.y());
  set(1, 2, covariance_m2.z());
  const Eigen::LLT<Eigen::Matrix3d> factor(correlation);
  if (factor.info() != Eigen::Success) return Eigen::Matrix3d::Identity();
  return factor.matrixL().solve(Eigen::Matrix3d::Identity());
}

/// How far the point is off, in independent deviations.
inline Eigen::Vector3d Whitened(const PointTarget& point, const Eigen::Vector3d& off_m) {
  return point.whitening * off_m.cwiseQuotient(point.sd_m);
}

/// Where it is in a pose, in the same terms as p_W_m.
inline Eigen::Vector3d PlaceOf(const PointTarget& point, const body::Kinematics& at) {
  const auto joint = static_cast<std::size_t>(point.joint);
  const Eigen::Vector3d place_m = at.p_WJ[joint] + at.R_WJ[joint] * point.p_J_m;
  if (point.from_joint < 0) return place_m;
  return place_m - at.p_WJ[static_cast<std::size_t>(point.from_joint)];
}

/// Fists or arms (up to 6), ankles and balls (4), the joints of a skeleton (13), and the directions
/// of a belt (2), with one to spare.
inline constexpr int kMaxPoints = 26;

/// What one frame's pose is solved for: the terms of equation (6), each with its standard
/// deviation. What is not valid is not asked for.
struct PoseTargets {
  std::array<PointTarget, kMaxPoints> points;
  int count = 0;

  bool has_com = false;
  Eigen::Vector3d com_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_sd_m = Eigen::Vector3d::Ones();

  bool has_angular = false;                             ///< Needs a pose before.
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();  ///< kg m^2/s.
  Eigen::Vector3d angular_sd = Eigen::Vector3d::Ones();

  void Add(const PointTarget& point) {
    if (count < kMaxPoints) points[static_cast<std::size_t>(count++)] = point;
  }
};

}  // namespace footing::pose
