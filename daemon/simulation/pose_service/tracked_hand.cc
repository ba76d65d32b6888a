#include "daemon/simulation/pose_service/tracked_hand.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "common/body/held_frame.h"
#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::pose_service {
namespace {

/// A tracker that says less of itself is not believed.
constexpr double kLeastPointSdM = 0.002;
constexpr double kMostPointSdM = 1;
/// The name of the tracker that sees the Moves' spheres.
constexpr char kSphereTracker[] = "camera";
/// From a Move's inertial sensors to the middle of its sphere: 9 cm to the end of the handle
/// (Monado's driver) and the sphere's radius. The simulated body holds its spheres in the middle of
/// its fists, where its devices measure.
constexpr double kSphereAheadM = 0.09 + 0.0225;

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
  matrix_m2 = matrix;
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
  if (inertial_ && source.tracker == kSphereTracker)
    inertial_->See(NanosecondsToSeconds(sample.sampled_ns()), {point.p_W_m, point.matrix_m2});
}

void TrackedHand::Bind(std::optional<std::uint32_t> move) {
  if (move_ == move) return;
  move_ = move;
  inertial_.reset();
}

void TrackedHand::Feel(const v1::MotionSample& sample) {
  if (move_ != sample.device() || !sample.has_angular_velocity_radps() || sample.uncalibrated() ||
      sample.gyroscope_uncalibrated())
    return;
  if (!inertial_) {
    const double ahead_m = sample.simulated() ? 0 : kSphereAheadM;
    inertial_.emplace(Eigen::Vector3d(ahead_m, 0, 0));
  }
  // With the bias that footingd has taken off: the filter follows it itself.
  const Eigen::Vector3d turn_radps = wire::FromProto(sample.angular_velocity_radps()) +
                                     wire::FromProto(sample.gyroscope_bias_radps());
  inertial_->Feel(
      NanosecondsToSeconds(sample.sampled_ns()),
      {body::AsHeld(wire::FromProto(sample.specific_force_mps2())), body::AsHeld(turn_radps),
       sample.clipped_axes() != 0 || sample.angular_velocity_clipped()});
}

reconstruction::HandInput TrackedHand::Inertial(const Source& source, std::int64_t host_ns) const {
  reconstruction::HandInput hand;
  if (!inertial_ || source.tracker != kSphereTracker) return hand;
  const inertial::Track::State state = inertial_->At(NanosecondsToSeconds(host_ns));
  hand.valid = state.valid;
  hand.p_W_m = state.p_W_m;
  hand.sd_m = state.covariance.diagonal().head<3>().cwiseSqrt().cwiseMax(kLeastPointSdM);
  hand.covariance_m2 = {state.covariance(0, 1), state.covariance(0, 2), state.covariance(1, 2)};
  return hand;
}

TrackedHand::Fused TrackedHand::At(std::int64_t now_ns, std::int64_t host_ns) const {
  Fused fused;
  std::array<reconstruction::HandInput, kMostTrackers> hands;
  std::array<Eigen::Matrix3d, kMostTrackers> weights;
  std::size_t count = 0;
  Eigen::Matrix3d weight = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  for (const Source& source : sources_) {
    if (!source.used) continue;
    hands[count] = Inertial(source, host_ns);
    if (!hands[count].valid) {
      if (NanosecondsToSeconds(now_ns - source.seen_ns) > kPointTimeoutS) continue;
      hands[count] = source.track.At(NanosecondsToSeconds(now_ns));
    }
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
