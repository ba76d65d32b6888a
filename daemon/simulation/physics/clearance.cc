#include "daemon/simulation/physics/clearance.h"

#include <algorithm>

namespace footing::physics {
namespace {

/// No point of the mechanism goes as far in one step: 50 m/s at 2 ms. A world that does has
/// diverged.
constexpr double kFarthestStepM = 0.1;

}  // namespace

Clearance::Clearance(const mjModel& model, const std::vector<int>& feet) {
  const int grounds = model.body_geomnum[0];
  ground_.resize(static_cast<std::size_t>(grounds));
  for (int geom = 0; geom < grounds; ++geom) MoveGround(model, geom);
  for (int geom = grounds; geom < model.ngeom; ++geom) {
    if (std::find(feet.begin(), feet.end(), geom) == feet.end()) shells_.push_back(geom);
  }
  pairs_complete_ = model.npair == grounds * static_cast<int>(feet.size());
}

void Clearance::MoveGround(const mjModel& model, int geom) {
  Ground& ground = ground_[static_cast<std::size_t>(geom)];
  mjtNum axes[9];
  mju_quat2Mat(axes, model.geom_quat + 4 * geom);
  ground.up = {axes[2], axes[5], axes[8]};
  const Eigen::Map<const Eigen::Vector3d> centre(model.geom_pos + 3 * geom);
  const double half_m = model.geom_type[geom] == mjGEOM_BOX ? model.geom_size[3 * geom + 2] : 0;
  ground.height_m = ground.up.dot(centre) + half_m;
}

bool Clearance::FeetAlone(const mjModel& model, const mjData& state) const {
  if (!pairs_complete_) return false;
  for (const int shell : shells_) {
    const Eigen::Map<const Eigen::Vector3d> centre(state.geom_xpos + 3 * shell);
    const double reach_m = model.geom_rbound[shell] + kFarthestStepM;
    for (const Ground& ground : ground_) {
      if (ground.up.dot(centre) < ground.height_m + reach_m) return false;
    }
  }
  return true;
}

}  // namespace footing::physics
