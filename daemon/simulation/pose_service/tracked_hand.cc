#include "daemon/simulation/pose_service/tracked_hand.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "common/units/units.h"
#include "common/wire/wire.h"

namespace footing::pose_service {
namespace {

/// A tracker that says less of itself is not believed.
constexpr double kLeastPointSdM = 0.002;
constexpr double kMostPointSdM = 1;

bool IsFinite(const v1::Vector3& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

/// The identity says that the tracker is not calibrated; none, that it has no frame of its own.
bool IsCalibrated(const v1::HandSample& sample) {
  if (!sample.has_tracker_pose()) return true;
  const v1::TrackerPose& pose = sample.tracker_pose();
  return pose.x_m() != 0 || pose.y_m() != 0 || pose.z_m() != 0 || pose.qx() != 0 ||
         pose.qy() != 0 || pose.qz() != 0;
}

Eigen::Matrix3d Matrix(const Eigen::Vector3d& sd_m, const Eigen::Vector3d& covariance_m2) {
  Eigen::Matrix3d matrix = sd_m.cwiseAbs2().asDiagonal();
  matrix(0, 1) = matrix(1, 0) = covariance_m2.x();
  matrix(0, 2) = matrix(2, 0) = covariance_m2.y();
  matrix(1, 2) = matrix(2, 1) = covariance_m2.z();
  return matrix;
}

}  // namespace

bool IsSeenInWorld(const v1::HandSample& sample) {
  return sample.confidence() > 0 && IsFinite(sample.position_m()) && IsFinite(sample.sd_m()) &&
         IsFinite(sample.covariance_m2()) && IsCalibrated(sample);
}

CountedPoint::CountedPoint(const v1::HandSample& sample)
    : p_W_m(wire::FromProto(sample.position_m())) {
  Eigen::Matrix3d matrix =
      Matrix(wire::FromProto(sample.sd_m()), wire::FromProto(sample.covariance_m2()));
  matrix /= std::min(1.0, sample.confidence());
  sd_m = matrix.diagonal().cwiseMax(0).cwiseSqrt().cwiseMax(kLeastPointSdM);
  covariance_m2 = {matrix(0, 1), matrix(0, 2), matrix(1, 2)};
  // Scaled as a whole, so that it stays a covariance.
  const double scale = std::min(1.0, kMostPointSdM / sd_m.maxCoeff());
  sd_m = (scale * sd_m).cwiseMax(kLeastPointSdM);
  covariance_m2 *= scale * scale;
}

TrackedHand::Source& TrackedHand::SourceOf(const std::string& tracker) {
  for (Source& source : sources_) {
    if (source.used && source.tracker == tracker) return source;
  }
  Source& oldest =
      *std::min_element(sources_.begin(), sources_.end(), [](const Source& a, const Source& b) {
        return a.used != b.used ? !a.used : a.seen_ns < b.seen_ns;
      });
  oldest = {};
  oldest.used = true;
  oldest.tracker = tracker;
  return oldest;
}

void TrackedHand::Add(const v1::HandSample& sample, double exposed_s, std::int64_t now_ns) {
  Source& source = SourceOf(sample.tracker());
  source.seen_ns = now_ns;
  source.simulated = sample.simulated();
  const CountedPoint point(sample);
  source.track.Add(exposed_s, point.p_W_m, point.sd_m, point.covariance_m2);
}

TrackedHand::Fused TrackedHand::At(std::int64_t now_ns) const {
  Fused fused;
  std::array<reconstruction::HandInput, kMostTrackers> hands;
  std::array<Eigen::Matrix3d, kMostTrackers> weights;
  std::size_t count = 0;
  Eigen::Matrix3d weight = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  for (const Source& source : sources_) {
    if (!source.used || NanosecondsToSeconds(now_ns - source.seen_ns) > kPointTimeoutS) continue;
    hands[count] = source.track.At(NanosecondsToSeconds(now_ns));
    weights[count] = Matrix(hands[count].sd_m, hands[count].covariance_m2).inverse();
    weight += weights[count];
    weighted += weights[count] * hands[count].p_W_m;
    ++count;
    fused.simulated |= source.simulated;
    fused.trackers.insert(source.tracker);
  }
  if (count == 0) return fused;
  fused.hand = hands[0];
  const Eigen::Matrix3d covariance = weight.inverse();
  if (count == 1 || !covariance.allFinite()) return fused;
  fused.hand.p_W_m = covariance * weighted;
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d off_m = hands[i].p_W_m - fused.hand.p_W_m;
    squares += off_m.dot(weights[i] * off_m);
  }
  const double ratio = std::max(1.0, squares / (3 * static_cast<double>(count - 1)));
  fused.hand.sd_m = (ratio * covariance.diagonal()).cwiseSqrt();
  fused.hand.covariance_m2 =
      ratio * Eigen::Vector3d(covariance(0, 1), covariance(0, 2), covariance(1, 2));
  return fused;
}

}  // namespace footing::pose_service
