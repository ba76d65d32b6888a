#include "daemon/simulation/momentum/contact_loads.h"

#include <algorithm>
#include <cmath>

namespace footing::momentum {
namespace {

constexpr std::size_t kBoardCells = 4;
constexpr double kEdgeLoadN = 50;    // With less the COP is too coarse.
constexpr double kEdgeShare = 0.03;  // Of a foot's load on the cells of the other side.
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

}  // namespace footing::momentum
