#include "common/camera/samples.h"

#include "common/stream/hand_covariance.h"

namespace footing::camera_pose {
namespace {

Eigen::Isometry3d ToIsometry(const stream::TrackerPose& pose) {
  Eigen::Isometry3d X_WT = Eigen::Isometry3d::Identity();
  X_WT.linear() = pose.rotation.normalized().toRotationMatrix();
  X_WT.translation() = pose.position_m;
  return X_WT;
}

}  // namespace

std::optional<SeenPoint> InTrackerFrame(const stream::HandSample& sample) {
  if (sample.confidence == 0 || !sample.tracker_pose) return {};
  const Eigen::Isometry3d X_TW = ToIsometry(*sample.tracker_pose).inverse();
  return SeenPoint{X_TW * sample.position_m,
                   X_TW.linear() * stream::CovarianceOf(sample) * X_TW.linear().transpose()};
}

stream::HandSample Recalibrated(const stream::HandSample& sample, const Eigen::Isometry3d& X_WC) {
  stream::HandSample other = sample;
  if (!sample.tracker_pose) return other;
  other.tracker_pose = {X_WC.translation(), Eigen::Quaterniond(X_WC.rotation())};
  const auto seen = InTrackerFrame(sample);
  if (!seen) return other;
  const Eigen::Matrix3d covariance =
      X_WC.linear() * seen->covariance_m2 * X_WC.linear().transpose();
  other.position_m = X_WC * seen->p_C_m;
  other.sd_m = covariance.diagonal().cwiseSqrt();
  other.covariance_m2 = {covariance(0, 1), covariance(0, 2), covariance(1, 2)};
  return other;
}

}  // namespace footing::camera_pose
