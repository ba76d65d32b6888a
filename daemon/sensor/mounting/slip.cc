#include "daemon/sensor/mounting/slip.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "common/base/units.h"

namespace footing::mounting {
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
