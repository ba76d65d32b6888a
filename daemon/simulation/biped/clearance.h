#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <vector>

namespace footing::physics {

/// Which pairs of geoms the next step has to look at.
///
/// Upright, only the feet can touch the ground; the other geoms of the mechanism (its shells) are
/// half a metre above it. MuJoCo would nevertheless sort the bodies by their boxes and compare
/// each shell with each geom of the ground, every step. Where the model lists each foot with each
/// geom of the ground as a pair, a world whose shells are clear of the ground looks at these pairs
/// alone. The contacts, and their order, are the same: a pair has the numbers of its geoms.
class Clearance {
 public:
  Clearance() = default;
  /// `feet`: geoms. Geoms of the world body must be boxes or planes.
  Clearance(const mjModel& model, const std::vector<int>& feet);

  /// Reads geom `geom` of the ground again, after it was moved or changed.
  void MoveGround(const mjModel& model, int geom);
  /// True when no shell can touch the ground within the step to come, as of the positions that
  /// `state` has.
  bool FeetAlone(const mjModel& model, const mjData& state) const;

 private:
  /// A box, or a plane as a box without ends below its face.
  struct Ground {
    Eigen::Vector3d centre_W_m = Eigen::Vector3d::Zero();
    Eigen::Matrix3d R_GW = Eigen::Matrix3d::Identity();
    Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
  };
  static bool Reaches(const Ground& ground, const Eigen::Vector3d& centre_W_m, double radius_m);

  std::vector<Ground> ground_;  ///< By geom; the world body's are the model's first ones.
  std::vector<int> shells_;
  bool pairs_complete_ = false;
};

}  // namespace footing::physics
