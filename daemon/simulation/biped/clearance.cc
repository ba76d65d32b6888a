#include "daemon/simulation/biped/clearance.h"

#include <algorithm>
#include <cmath>

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
  ground.centre_W_m = Eigen::Map<const Eigen::Vector3d>(model.geom_pos + 3 * geom);
  mjtNum R_WG[9];
  mju_quat2Mat(R_WG, model.geom_quat + 4 * geom);
  ground.R_GW = Eigen::Map<const Eigen::Matrix3d>(R_WG);  // Of row order: the transpose.
  const bool box = model.geom_type[geom] == mjGEOM_BOX;
  ground.half_size_m =
      box ? Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(model.geom_size + 3 * geom))
          : Eigen::Vector3d(INFINITY, INFINITY, 0);
}

/// Whether a sphere may touch the ground: one beyond any of its faces does not.
bool Clearance::Reaches(const Ground& ground, const Eigen::Vector3d& centre_W_m, double radius_m) {
  const Eigen::Vector3d offset_W_m = centre_W_m - ground.centre_W_m;
  for (const int axis : {2, 0, 1}) {  // Mostly it is above.
    const double along_m = ground.R_GW.row(axis).dot(offset_W_m);
    const double reach_m = ground.half_size_m[axis] + radius_m;
    if (along_m > reach_m) return false;
    if (along_m < -reach_m && std::isfinite(ground.half_size_m.x())) return false;
  }
  return true;
}

bool Clearance::FeetAlone(const mjModel& model, const mjData& state) const {
  if (!pairs_complete_) return false;
  for (const int shell : shells_) {
    const Eigen::Vector3d centre_W_m =
        Eigen::Map<const Eigen::Vector3d>(state.geom_xpos + 3 * shell);
    const double radius_m = model.geom_rbound[shell] + kFarthestStepM;
    for (const Ground& ground : ground_) {
      if (Reaches(ground, centre_W_m, radius_m)) return false;
    }
  }
  return true;
}

}  // namespace footing::physics
