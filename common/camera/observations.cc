#include "common/camera/observations.h"

#include <Eigen/Dense>
#include <cmath>

#include "common/base/number.h"

namespace footing::camera_pose {
namespace {

/// A hand that holds a sphere against a board trembles by less than this, per axis.
constexpr double kTrembleM = 0.001;
/// Scatter over what noise and trembling explain, as a ratio of variances. The greatest of three
/// directions of 30 frames of noise stays below it (chi-squared, one in 10^4).
constexpr double kMostScatter = 2.5;

}  // namespace

Result<SeenPoint> MeanAtRest(const std::vector<SeenPoint>& frames) {
  if (frames.size() < kLeastFrames)
    return InvalidData("the sphere was seen in " + std::to_string(frames.size()) + " frames, " +
                       std::to_string(kLeastFrames) +
                       " are needed: turn it towards the camera and keep the hand behind it");
  const double count = static_cast<double>(frames.size());
  SeenPoint mean;
  for (const SeenPoint& frame : frames) {
    mean.p_C_m += frame.p_C_m / count;
    mean.covariance_m2 += frame.covariance_m2 / count;
  }
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const SeenPoint& frame : frames) {
    const Eigen::Vector3d off = frame.p_C_m - mean.p_C_m;
    scatter += off * off.transpose() / (count - 1);
  }
  const Eigen::Matrix3d expected =
      mean.covariance_m2 + kTrembleM * kTrembleM * Eigen::Matrix3d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> ratio(scatter, expected);
  if (!(ratio.eigenvalues().maxCoeff() <= kMostScatter))
    return InvalidData("the sphere moved by " + text::Fixed(1e3 * std::sqrt(scatter.trace()), 1) +
                       " mm while it was measured: hold it on the mark and keep still");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> common(mean.covariance_m2 - scatter);
  const Eigen::Matrix3d axes = common.eigenvectors();
  mean.covariance_m2 =
      scatter / count + axes * common.eigenvalues().cwiseMax(0).asDiagonal() * axes.transpose();
  return mean;
}

}  // namespace footing::camera_pose
