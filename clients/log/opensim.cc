#include "clients/log/opensim.h"

#include <cmath>
#include <cstddef>
#include <string>

namespace footing::log_client {
namespace {

/// A millionth of a second.
double Rounded(double value) { return std::round(value * 1e6) / 1e6; }

}  // namespace

motion::Table ForceTable(const std::vector<FootForces>& forces, double rate_hz) {
  motion::Table table;
  table.columns = {"time"};
  for (const char* side : {"r", "l"}) {
    const std::string force = std::string("ground_force_") + side + "_";
    for (const char* part : {"vx", "vy", "vz", "px", "py", "pz"}) {
      table.columns.push_back(force + part);
    }
    for (const char* part : {"x", "y", "z"}) {
      table.columns.push_back(std::string("ground_torque_") + side + "_" + part);
    }
  }
  table.values.setZero(static_cast<Eigen::Index>(forces.size()),
                       static_cast<Eigen::Index>(table.columns.size()));
  for (std::size_t i = 0; i < forces.size(); ++i) {
    auto row = table.values.row(static_cast<Eigen::Index>(i));
    row(0) = Rounded(static_cast<double>(i) / rate_hz);
    for (const int side : {1, 0}) {
      const FootForce& foot = forces[i][static_cast<std::size_t>(side)];
      const Eigen::Index first = side == 1 ? 1 : 10;
      row(first + 1) = foot.load_n;
      row(first + 3) = foot.cop_W.x();
      row(first + 4) = foot.cop_W.z();
      row(first + 5) = -foot.cop_W.y();
    }
  }
  return table;
}

}  // namespace footing::log_client
