#include "common/camera/unseen_motion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace footing::sphere::disc {
namespace {

// Hands below 0.05 m/s, which is the noise of travel at 1 m: 258 of 21 140 moments of 18 recorded
// motions (CMU 13, HDM05 bd and bk), 0.3 to 1.2 % by their kind.
constexpr double kRestShare = 0.01;
constexpr int kRings = 12, kAngles = 24;

/// Beyond that nothing is possible: by how fast hands are, by the travel and by the blur seen.
double FarthestPx(const MotionEvidence& evidence, double motion_sd_px) {
  constexpr double kSds = 5;
  const Eigen::Matrix4d noise = evidence.information.inverse();
  const double travel =
      evidence.change.tail<2>().norm() + kSds * std::sqrt(noise.bottomRightCorner<2, 2>().trace());
  const double blur =
      evidence.change.head<2>().norm() + kSds * std::sqrt(noise.topLeftCorner<2, 2>().trace());
  return std::min({kSds * motion_sd_px, travel, std::sqrt(48 * evidence.blur_px * blur)});
}

}  // namespace

Eigen::Matrix3d UnseenMotion(const MotionEvidence& evidence, double motion_sd_px) {
  constexpr double kPi = std::numbers::pi;
  const double farthest = FarthestPx(evidence, motion_sd_px);
  const double variance = motion_sd_px * motion_sd_px;
  const Eigen::Vector4d weighted = evidence.information * evidence.change;
  double sum = kRestShare;  // Likelihoods are those over that of rest.
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (int k = 0; k < kAngles; ++k) {
    const double angle = 2 * kPi * (k + 0.5) / kAngles, c = std::cos(angle), s = std::sin(angle);
    const Eigen::Vector4d blurred(c * c - s * s, 2 * c * s, 0, 0), moved(0, 0, c, s);
    const Eigen::Vector4d by_blur = evidence.information * blurred;
    const double seen_blur = blurred.dot(weighted), seen_travel = moved.dot(weighted);
    const double blur2 = blurred.dot(by_blur), both = moved.dot(by_blur),
                 travel2 = moved.dot(evidence.information * moved) + 1 / variance;
    const Eigen::Vector3d per_px = evidence.per_travel * Eigen::Vector2d(c, s);
    for (int i = 0; i < kRings; ++i) {
      const double root = (i + 0.5) / kRings, r = farthest * root * root;
      // Motion adds (motion . unit)² / 12 to the square of the blur: half of it is even.
      const double blur = r * r / (48 * evidence.blur_px);
      const double log_weight = blur * seen_blur + r * seen_travel -
                                0.5 * (blur * blur * blur2 + r * r * travel2) - blur * r * both;
      const double area = r * 2 * farthest * root / kRings / kAngles / variance;
      const double weight = (1 - kRestShare) * area * std::exp(std::min(700.0, log_weight));
      const Eigen::Vector3d shift = r * per_px - blur * evidence.per_blur;
      sum += weight;
      square += weight * shift * shift.transpose();
    }
  }
  return square / sum;
}

}  // namespace footing::sphere::disc
