#include "daemon/sensor/mounting/mounting.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "common/base/rotation.h"
#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::mounting {
namespace {

using Samples = std::span<const stream::MotionSample>;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSmoothingS = 0.04;  // Either side of an instant, against noise and counts.
constexpr double kMostlyOneAxis = 0.7;

Mounting Refused(std::string problem) {
  Mounting mounting;
  mounting.problem = std::move(problem);
  return mounting;
}

std::string Number(double value) { return text::Fixed(value, 1); }

double Seconds(const stream::MotionSample& sample) {
  return NanosecondsToSeconds(sample.sampled_ns);
}

/// Reason why a stretch is unusable; empty if it is usable.
std::string Unusable(Samples samples, double least_s, const char* what,
                     const MountingConfig& config) {
  const double span_s = samples.size() < 2 ? 0 : Seconds(samples.back()) - Seconds(samples.front());
  if (span_s < least_s) {
    return std::string(what) + ": only " + Number(span_s) + " s of samples, " + Number(least_s) +
           " are needed";
  }
  if (static_cast<double>(samples.size()) < config.least_rate_hz * span_s) {
    return std::string(what) + ": too few samples; is the link good?";
  }
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (Seconds(samples[i]) - Seconds(samples[i - 1]) > config.longest_gap_s) {
      return std::string(what) + ": a gap in the samples; try again";
    }
  }
  return "";
}

Vector3d Mean(Samples samples) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& sample : samples) sum += sample.specific_force_mps2;
  return sum / static_cast<double>(samples.size());
}

double Deviation(Samples samples, const Vector3d& mean) {
  double sum = 0;
  for (const auto& sample : samples) sum += (sample.specific_force_mps2 - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

double AngleBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Horizontal specific force in the levelled frame, smoothed.
std::vector<Vector2d> HorizontalSwing(Samples samples, const Eigen::Quaterniond& level) {
  std::vector<Vector2d> swing;
  std::size_t begin = 0;
  std::size_t end = 0;
  Vector3d sum = Vector3d::Zero();
  for (const auto& sample : samples) {
    while (end < samples.size() && Seconds(samples[end]) <= Seconds(sample) + kSmoothingS) {
      sum += samples[end++].specific_force_mps2;
    }
    while (Seconds(samples[begin]) < Seconds(sample) - kSmoothingS) {
      sum -= samples[begin++].specific_force_mps2;
    }
    swing.emplace_back((level * (sum / static_cast<double>(end - begin))).head<2>());
  }
  return swing;
}

struct Axis {
  Vector2d direction = Vector2d::UnitY();
  double rms_mps2 = 0;
  double ratio = 0;  ///< Variance along it against across.
};

Axis PrincipalAxis(std::span<const Vector2d> swing) {
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& one : swing) mean += one;
  mean /= static_cast<double>(swing.size());
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const Vector2d& one : swing) covariance += (one - mean) * (one - mean).transpose();
  covariance /= static_cast<double>(swing.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const Vector2d values = solver.eigenvalues().cwiseMax(1e-12);
  return {solver.eigenvectors().col(1), std::sqrt(values(1)), values(1) / values(0)};
}

/// +1 or -1: the way of the first movement along the axis that reaches this share of the peak.
int FirstWay(std::span<const Vector2d> swing, const Vector2d& axis, double share) {
  double peak = 0;
  for (const Vector2d& one : swing) peak = std::max(peak, std::abs(axis.dot(one)));
  for (const Vector2d& one : swing) {
    const double along = axis.dot(one);
    if (std::abs(along) >= share * peak) return along > 0 ? 1 : -1;
  }
  return 1;
}

/// Where the first half of the swing's energy ends: halves by time could be one of standing.
std::size_t HalfOfTheSwing(std::span<const Vector2d> swing) {
  double whole = 0;
  for (const Vector2d& one : swing) whole += one.squaredNorm();
  double sum = 0;
  std::size_t i = 0;
  while (i + 2 < swing.size() && sum < whole / 2) sum += swing[i++].squaredNorm();
  return std::max<std::size_t>(i, 2);
}

/// The change of an axis without sign.
double TurnBetween(const Vector2d& a, const Vector2d& b) {
  return std::acos(std::min(1.0, std::abs(a.dot(b))));
}

double FirstWayInM(stream::DeviceRole role) {
  return role == stream::DeviceRole::kLeftHand ? -1 : 1;
}

}  // namespace

Mounting SolveMounting(stream::DeviceRole role, Samples still, Samples steps,
                       const MountingConfig& config) {
  if (auto why = Unusable(still, config.least_still_s, "standing still", config); !why.empty()) {
    return Refused(std::move(why));
  }
  if (auto why = Unusable(steps, config.least_steps_s, "steps", config); !why.empty()) {
    return Refused(std::move(why));
  }
  const Vector3d gravity_S = Mean(still);
  const double moved_mps2 = Deviation(still, gravity_S);
  if (moved_mps2 > config.still_sd_mps2) {
    return Refused("moved while standing still (by " + Number(moved_mps2) +
                   " m/s2); stand for two seconds and try again");
  }
  if (std::abs(gravity_S.norm() - kStandardGravityMps2) > config.gravity_tolerance_mps2) {
    return Refused("at rest it feels " + Number(gravity_S.norm()) +
                   " m/s2 and not 9.8; is its calibration right?");
  }
  const Eigen::Quaterniond level = LeastTurn(gravity_S, -Vector3d::UnitZ());
  std::vector<Vector2d> swing = HorizontalSwing(steps, level);
  const Axis axis = PrincipalAxis(swing);
  if (axis.rms_mps2 < config.least_swing_mps2) {
    return Refused("no swing in the steps (" + Number(axis.rms_mps2) +
                   " m/s2); take three whole steps");
  }
  if (axis.ratio < config.least_ratio) {
    return Refused("the steps swing sideways as much as forward; walk straight ahead");
  }
  const int way = FirstWay(swing, axis.direction, config.onset_share);
  if (way != FirstWay(swing, axis.direction, config.sure_share)) {
    return Refused("the first movement is not clear; start from standing, with the left foot");
  }

  Mounting mounting;
  const std::size_t half = still.size() / 2;
  const double drift_rad = AngleBetween(Mean(still.first(half)), Mean(still.last(half)));
  const auto parts = std::span<const Vector2d>(swing);
  const std::size_t middle = HalfOfTheSwing(parts);
  const double turn_rad = TurnBetween(PrincipalAxis(parts.first(middle)).direction,
                                      PrincipalAxis(parts.subspan(middle)).direction);
  mounting.residual_rad = std::max(drift_rad, turn_rad);
  if (mounting.residual_rad > config.most_residual_rad) {
    return Refused("its parts disagree by " + Number(RadiansToDegrees(mounting.residual_rad)) +
                   " degrees; is it tight? walk straight ahead");
  }
  // About the vertical, so that M's front is the axis, with the sign that the role's first way has.
  const Vector2d front = axis.direction * way * FirstWayInM(role);
  const Eigen::AngleAxisd turn(kPi / 2 - std::atan2(front.y(), front.x()), Vector3d::UnitZ());
  mounting.rotation_MS = (Eigen::Quaterniond(turn) * level).normalized();
  mounting.ok = true;
  return mounting;
}

stream::MotionSample Rotated(const Eigen::Quaterniond& rotation_MS,
                             const stream::MotionSample& sample) {
  stream::MotionSample rotated = sample;
  rotated.specific_force_mps2 = rotation_MS * sample.specific_force_mps2;
  rotated.filtered_mps2 = rotation_MS * sample.filtered_mps2;
  rotated.angular_velocity_radps = rotation_MS * sample.angular_velocity_radps;
  rotated.magnetic_field = rotation_MS * sample.magnetic_field;
  rotated.clipped_axes = 0;
  const Eigen::Matrix3d matrix = rotation_MS.toRotationMatrix();
  for (int from = 0; from < 3; ++from) {
    if ((sample.clipped_axes & (1u << from)) == 0) continue;
    for (int to = 0; to < 3; ++to) {
      if (std::abs(matrix(to, from)) >= kMostlyOneAxis) rotated.clipped_axes |= 1u << to;
    }
  }
  return rotated;
}

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kPauseNs = 250'000'000;
constexpr int kLeastSamples = 40;
constexpr double kGravityToleranceMps2 = 1.5;

}  // namespace

void SlipWatch::Clear() {
  count_ = 0;
  sum_.setZero();
  squares_.setZero();
}

void SlipWatch::Advance(const stream::MotionSample& sample_M) {
  const std::int64_t now_ns = sample_M.sampled_ns;
  if (count_ > 0 && (now_ns < last_ns_ || now_ns - last_ns_ > kPauseNs)) {
    Clear();
    wrong_rest_s_ = wrong_swing_s_ = 0;
  }
  if (count_ == 0) begin_ns_ = now_ns;
  last_ns_ = now_ns;
  ++count_;
  sum_ += sample_M.specific_force_mps2;
  squares_ += sample_M.specific_force_mps2 * sample_M.specific_force_mps2.transpose();
  if (now_ns - begin_ns_ < kSecondNs) return;
  if (count_ >= kLeastSamples) CheckSecond();
  Clear();
}

void SlipWatch::CheckSecond() {
  const Eigen::Vector3d mean = sum_ / count_;
  const Eigen::Matrix3d covariance = squares_ / count_ - mean * mean.transpose();
  if (std::sqrt(std::max(0.0, covariance.trace())) < config_.rest_sd_mps2) {
    if (std::abs(mean.norm() - kStandardGravityMps2) > kGravityToleranceMps2) return;
    const double lean_rad = std::atan2(mean.head<2>().norm(), -mean.z());
    const bool leg =
        role_ == stream::DeviceRole::kLeftLeg || role_ == stream::DeviceRole::kRightLeg;
    const bool upper = role_ == stream::DeviceRole::kHead || role_ == stream::DeviceRole::kTrunk;
    const bool wrong =
        (leg && lean_rad > config_.leg_rad) || (upper && lean_rad > config_.upper_rad);
    wrong_rest_s_ = wrong ? wrong_rest_s_ + 1 : 0;
    slipped_ = slipped_ || wrong_rest_s_ >= config_.rest_s;
    return;
  }
  wrong_rest_s_ = 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance.topLeftCorner<2, 2>());
  const Eigen::Vector2d values = solver.eigenvalues().cwiseMax(1e-12);
  if (std::sqrt(values(1)) < config_.swing_mps2 || values(1) < config_.ratio * values(0)) return;
  const Eigen::Vector2d way = solver.eigenvectors().col(1);
  const bool wrong = std::atan2(std::abs(way.x()), std::abs(way.y())) > config_.swing_rad;
  wrong_swing_s_ = wrong ? wrong_swing_s_ + 1 : 0;
  slipped_ = slipped_ || wrong_swing_s_ >= config_.swing_s;
}

}  // namespace footing::mounting
