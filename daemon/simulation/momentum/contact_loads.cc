#include "daemon/simulation/momentum/contact_loads.h"

#include <algorithm>
#include <cmath>

namespace footing::momentum {
namespace {

constexpr std::size_t kBoardCells = 4;
constexpr double kEdgeLoadN = 50;    // With less the COP is too coarse.
constexpr double kEdgeShare = 0.03;  // Most load on the cells of the other side, over the foot's.
constexpr double kCellNoiseN = 3;

struct Sum {
  double total_n = 0;
  Eigen::Vector3d moment_nm = Eigen::Vector3d::Zero();

  void Add(const FootLoads& foot) {
    if (!foot.valid || foot.count > kMaxCells) return;
    for (std::size_t i = 0; i < foot.count; ++i) {
      const Cell& cell = foot.cells[i];
      if (!std::isfinite(cell.load_n) || !cell.p_WS_m.allFinite()) continue;
      total_n += cell.load_n;
      moment_nm += cell.load_n * cell.p_WS_m;
    }
  }

  Pressure Divide(double least_n) const {
    if (total_n < least_n) return {total_n, false, Eigen::Vector3d::Zero()};
    return {total_n, true, moment_nm / total_n};
  }
};

}  // namespace

Pressure PressureOf(const FootLoads& foot, double least_n) {
  Sum sum;
  sum.Add(foot);
  return sum.Divide(least_n);
}

Pressure PressureOf(const ContactLoads& loads, double least_n) {
  Sum sum;
  for (const FootLoads& foot : loads.feet) sum.Add(foot);
  return sum.Divide(least_n);
}

bool AtEdge(const FootLoads& foot) {
  const Pressure pressure = PressureOf(foot, kEdgeLoadN);
  if (!foot.valid || foot.count != kBoardCells || !pressure.cop_valid) return false;
  const double least_n = kEdgeShare * pressure.total_n;
  for (std::size_t i = 0; i < kBoardCells; ++i) {
    if (foot.cells[i].load_n < -least_n - kCellNoiseN) return false;
  }
  constexpr std::array<std::array<std::size_t, 2>, 4> kSides{{{0, 1}, {2, 3}, {0, 2}, {1, 3}}};
  return std::any_of(kSides.begin(), kSides.end(), [&](const auto& side) {
    return foot.cells[side[0]].load_n + foot.cells[side[1]].load_n <= least_n;
  });
}

bool IsFinite(const ContactLoads& loads) {
  if (!std::isfinite(loads.time_s)) return false;
  for (const FootLoads& foot : loads.feet) {
    if (foot.count > kMaxCells) return false;
    for (std::size_t i = 0; i < foot.count; ++i)
      if (!std::isfinite(foot.cells[i].load_n) || !foot.cells[i].p_WS_m.allFinite()) return false;
  }
  return true;
}

bool FootContact::Advance(double total_n, double step_s) {
  const double load = total_n - tare_n_;
  const bool now = contact_ ? load > config_.off_n : load > config_.on_n;
  since_s_ = now == contact_ ? since_s_ + step_s : 0;
  contact_ = now;
  if (!contact_) {
    const double share = std::min(1.0, step_s / config_.tare_time_s);
    tare_n_ = std::clamp(tare_n_ + share * load, -config_.most_tare_n, config_.most_tare_n);
  }
  return contact_;
}

namespace {

// A foot of 26 cm on a plate of 32 cm cannot stand further away from where it stood.
constexpr double kStepM = 0.2;
// Time constant of the mean: the filters need as long to find the body again.
constexpr double kStoodS = 3;

}  // namespace

void StepWatch::Start(const std::array<double, kFeet>& forward_m) {
  mean_m_ = forward_m;
  stepped_ = false;
}

void StepWatch::Advance(const std::array<double, kFeet>& forward_m, double step_s) {
  const double part = 1 - std::exp(-step_s / kStoodS);
  double most_m = 0;
  for (std::size_t f = 0; f < kFeet; ++f) {
    mean_m_[f] += part * (forward_m[f] - mean_m_[f]);
    most_m = std::max(most_m, std::abs(forward_m[f] - mean_m_[f]));
  }
  stepped_ = most_m > kStepM;
}

namespace {

constexpr double kTimeS = 0.5;  // Time constant of each of two smoothings.
constexpr double kMostShare = 5;
constexpr double kLeast = 0.75, kMost = 1.4;            // Beyond it is not the whole weight,
constexpr double kLeastAgain = 0.87, kMostAgain = 1.2;  // within it is again.

}  // namespace

void LoadShare::Advance(double share, double step_s) {
  const double part = step_s / (kTimeS + step_s);
  early_ += part * (std::clamp(share, 0.0, kMostShare) - early_);
  share_ += part * (early_ - share_);
  whole_ = whole_ ? share_ > kLeast && share_ < kMost : share_ > kLeastAgain && share_ < kMostAgain;
}

}  // namespace footing::momentum
