#include "daemon/simulation/momentum/foot_place.h"

#include <algorithm>
#include <cmath>

#include "daemon/simulation/momentum/linear_filter.h"

namespace footing::momentum {
namespace {

constexpr double kStartSpreadM = 0.01;
constexpr double kSoleMarginM = 0.005;  // The COP's own error at the edge of the sole.
constexpr double kFootLimitLoadN = 60;  // Below, the COP is too coarse for a limit.
constexpr double kMostSpreadM = 0.5;
constexpr double kNoBoundM = 1e3;
constexpr double kAddedVarianceM2 = 1e-5;

}  // namespace

FootPlace::FootPlace(const FootShape& shape, const FootPlaceConfig& config)
    : shape_(shape),
      config_(config),
      along_(std::cos(shape.yaw_rad), std::sin(shape.yaw_rad)),
      across_(-std::sin(shape.yaw_rad), std::cos(shape.yaw_rad)) {
  Start(Eigen::Vector3d::Zero());
}

void FootPlace::Start(const Eigen::Vector3d& p_WF_m) {
  height_m_ = p_WF_m.z();
  Unbound();
  const std::array<double, 2> wander{config_.along_spread_m, config_.across_spread_m};
  const std::array<double, 2> at{along_.dot(p_WF_m.head<2>()), across_.dot(p_WF_m.head<2>())};
  for (std::size_t i = 0; i < 2; ++i) {
    estimate_[i] = {at[i], kStartSpreadM * kStartSpreadM};
    axes_[i].Start(
        {at[i], 0},
        Eigen::Vector2d(kStartSpreadM * kStartSpreadM, wander[i] * wander[i]).asDiagonal());
  }
}

void FootPlace::Advance(const Pressure& pressure, bool contact, bool landed, double step_s) {
  const std::array<double, 2> wander{config_.along_spread_m, config_.across_spread_m};
  const std::array<double, 2> ahead{(1 - shape_.rest_share) * shape_.length_m,
                                    0.5 * shape_.width_m};
  const std::array<double, 2> behind{shape_.rest_share * shape_.length_m, 0.5 * shape_.width_m};
  if (!contact || landed) Unbound();
  const double keep = std::exp(-step_s / config_.wander_time_s);
  for (std::size_t i = 0; i < 2; ++i) {
    Filter& axis = axes_[i];
    const double spread = std::sqrt(axis.p()(0, 0));
    double growth = config_.slip_mps * config_.slip_mps * step_s;
    if (!contact && spread < kMostSpreadM) {
      const double grown = spread + config_.lift_growth_mps * step_s;
      growth = grown * grown - spread * spread;
    }
    if (landed) growth += config_.step_spread_m * config_.step_spread_m;
    Eigen::Matrix2d a = Eigen::Vector2d(1, landed ? 0 : keep).asDiagonal();
    const double stays = a(1, 1);
    const Eigen::Matrix2d q =
        Eigen::Vector2d(growth, wander[i] * wander[i] * (1 - stays * stays)).asDiagonal();
    axis.Predict(a, Eigen::Vector2d::Zero(), q);
    if (!contact || !pressure.cop_valid) continue;
    const double cop = (i == 0 ? along_ : across_).dot(pressure.p_WP_m.head<2>());
    const double shift = i == 0 ? config_.ahead_m : 0;
    const double noise = config_.cop_noise_n_m / std::max(pressure.total_n, 1.0);
    axis.Update(Filter::Row(1, 1), cop - shift, noise * noise);
    if (pressure.total_n < kFootLimitLoadN) continue;
    low_[i] = std::max(low_[i], cop - ahead[i] - kSoleMarginM);
    high_[i] = std::min(high_[i], cop + behind[i] + kSoleMarginM);
  }
  for (std::size_t i = 0; i < 2; ++i) Estimate(i, config_.loosen_mps * step_s);
  if (contact && pressure.cop_valid) height_m_ = pressure.p_WP_m.z();
}

void FootPlace::Unbound() {
  low_.fill(-kNoBoundM);
  high_.fill(kNoBoundM);
}

/// The filter knows nothing of the bounds, so that no frame counts twice by them.
void FootPlace::Estimate(std::size_t axis, double loosen_m) {
  double& low = low_[axis];
  double& high = high_[axis];
  low -= loosen_m;
  high += loosen_m;
  if (low > high) low = high = 0.5 * (low + high);  // The foot has moved, or is longer.
  Moments inside = Below({axes_[axis].x()(0), axes_[axis].p()(0, 0)}, high);
  inside = Below({-inside.mean, inside.variance}, -low);
  estimate_[axis] = {std::clamp(-inside.mean, low, high), inside.variance + kAddedVarianceM2};
}

Eigen::Vector3d FootPlace::position_m() const {
  const Eigen::Vector2d p = estimate_[0].mean * along_ + estimate_[1].mean * across_;
  return {p.x(), p.y(), height_m_};
}

Eigen::Vector3d FootPlace::variance_m2() const {
  const Eigen::Vector2d v =
      estimate_[0].variance * along_.cwiseAbs2() + estimate_[1].variance * across_.cwiseAbs2();
  return {v.x(), v.y(), 1e-6};
}

}  // namespace footing::momentum
