#include "clients/camera/observation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

namespace footing::camera {
namespace {

constexpr double kFarthestM = 10, kLargestSdM = 1;  // Of a hand frame.
constexpr std::int64_t kOldestNs = 1'000'000'000;

stream::TrackedPoint ToPoint(const Eigen::Isometry3d& X_WC, const sphere::Estimate& estimate) {
  stream::TrackedPoint point;
  const Eigen::Matrix3d covariance =
      X_WC.linear() * estimate.covariance_m2 * X_WC.linear().transpose();
  point.position_m = X_WC * estimate.p_C_m;
  point.sd_m = covariance.diagonal().cwiseSqrt();
  if (!(point.position_m.norm() <= kFarthestM) || !point.sd_m.allFinite() ||
      point.sd_m.maxCoeff() > kLargestSdM)
    return stream::TrackedPoint();
  point.covariance_m2 = {covariance(0, 1), covariance(0, 2), covariance(1, 2)};
  point.confidence = estimate.confidence;
  point.saturated = estimate.is_saturated;
  point.occluded = estimate.is_occluded;
  return point;
}

}  // namespace

std::vector<stream::HandFrame> ToHandFrames(
    const frames::CameraFile& camera, const std::optional<Eigen::Isometry3d>& calibrated_X_WC,
    const std::vector<std::optional<sphere::Estimate>>& found, std::int64_t exposed_ns,
    std::int64_t now_ns) {
  const Eigen::Isometry3d X_WC = calibrated_X_WC.value_or(Eigen::Isometry3d::Identity());
  std::vector<stream::HandFrame> frames;
  for (std::size_t i = 0; i < found.size(); ++i) {
    stream::HandFrame frame;
    frame.tracker = "camera";
    frame.tracker_pose =
        stream::TrackerPose{X_WC.translation(), Eigen::Quaterniond(X_WC.rotation())};
    stream::TrackedPoint point = found[i] ? ToPoint(X_WC, *found[i]) : stream::TrackedPoint();
    if (camera.spheres[i].role == stream::DeviceRole::kHead)
      point.joint = stream::BodyJoint::kHead;
    else
      point.role = camera.spheres[i].role;
    frame.points.push_back(point);
    const double row_s = found[i] ? camera.RowTime(found[i]->centre_px.y()) : 0;
    const auto row_ns = static_cast<std::int64_t>(std::llround(1e9 * row_s));
    frame.age_ns = std::clamp<std::int64_t>(now_ns - exposed_ns - row_ns, 0, kOldestNs);
    frame.sent_ns = now_ns;
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace footing::camera
