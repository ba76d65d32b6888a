#include "common/virtual/devices/insole_cells.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace footing::virtual_sensors {
namespace {

constexpr int kCellRows = 8;
constexpr double kHalfWidthM = 0.03;
constexpr double kInsideM = 0.005;
constexpr int kNewtonSteps = 30;

}  // namespace

SolePlace PlaceOfSole(const BodyCourse& course, std::size_t foot, Eigen::Index frame) {
  const auto& sole = course.sole_m[foot];
  const Eigen::Vector2d heel = 0.5 * (sole[0].col(frame) + sole[1].col(frame)).head<2>();
  const Eigen::Vector2d ball = 0.5 * (sole[2].col(frame) + sole[3].col(frame)).head<2>();
  const Eigen::Vector2d along = ball - heel;
  return {heel, std::atan2(along.y(), along.x()), along.norm()};
}

std::array<Eigen::Vector2d, kInsoleCells> InsolePlaces(double length_m) {
  std::array<Eigen::Vector2d, kInsoleCells> places;
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = {length_m * static_cast<double>(i / 2) / (kCellRows - 1),
                 i % 2 == 0 ? kHalfWidthM : -kHalfWidthM};
  return places;
}

std::array<double, kInsoleCells> LoadInsole(
    const std::array<Eigen::Vector2d, kInsoleCells>& places_m, const SolePlace& sole,
    const FootForce& foot) {
  std::array<double, kInsoleCells> loads{};
  if (foot.load_n <= 0) return loads;
  const Eigen::Vector2d off = foot.cop_m - sole.heel_m;
  const double c = std::cos(sole.yaw_rad), s = std::sin(sole.yaw_rad);
  const Eigen::Vector2d cop_F(
      std::clamp(c * off.x() + s * off.y(), kInsideM, places_m.back().x() - kInsideM),
      std::clamp(-s * off.x() + c * off.y(), -kHalfWidthM + kInsideM, kHalfWidthM - kInsideM));
  // Newton on the dual: share_i = exp(k . p_i) / sum, with mean cop_F. The Jacobian of the mean is
  // the covariance of the shares.
  Eigen::Vector2d k = Eigen::Vector2d::Zero();
  std::array<double, kInsoleCells> shares{};
  for (int step = 0; step < kNewtonSteps; ++step) {
    double most = -1e300, sum = 0;
    for (const auto& p : places_m) most = std::max(most, k.dot(p - cop_F));
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    for (std::size_t i = 0; i < places_m.size(); ++i) {
      const Eigen::Vector2d p = places_m[i] - cop_F;
      shares[i] = std::exp(k.dot(p) - most);
      sum += shares[i];
      mean += shares[i] * p;
      square += shares[i] * p * p.transpose();
    }
    for (double& share : shares) share /= sum;
    mean /= sum;
    if (mean.norm() < 1e-9) break;
    const Eigen::Matrix2d covariance =
        square / sum - mean * mean.transpose() + 1e-9 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d change = -covariance.inverse() * mean;
    // No step further than the shares change by e^3 over a sole.
    const double longest = 3 / std::max(0.01, places_m.back().x());
    if (change.norm() > longest) change *= longest / change.norm();
    k += change;
  }
  for (std::size_t i = 0; i < loads.size(); ++i) loads[i] = foot.load_n * shares[i];
  return loads;
}

}  // namespace footing::virtual_sensors
