#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"

namespace footing::motion {

/// Where a foot is to be: the frame of the ankle joint in W.
struct FootPlace {
  Eigen::Vector3d p_WA = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WA = Eigen::Matrix3d::Identity();
};

/// What of a foot's orientation is asked for.
enum class FootAim {
  /// Where it points, with the last angle of the ankle. The skeletons of CMU have no angle that
  /// would roll the sole against the shank, so it rolls with it, some degrees.
  kAhead,
  kFlat,  ///< All of it, as far as the angles of the ankle allow.
};

/// Puts a foot at its place by the joints from hip to ankle: the ankle's origin and where the foot
/// points are met exactly when they are in reach.
class LegSolver {
 public:
  /// `body` must outlive it. `left`: which leg.
  LegSolver(const body::Body& body, bool left, FootAim aim = FootAim::kAhead);

  /// Moves the leg's angles in `q`, beginning at those that stand there. Returns what is left of
  /// the distance, m.
  double Solve(const FootPlace& place, Eigen::Ref<Eigen::VectorXd> q);

  /// Thigh and shank, m.
  double thigh_m() const { return thigh_m_; }
  double shank_m() const { return shank_m_; }
  int hip() const { return hip_; }
  int ankle() const { return ankle_; }
  int knee_dof() const { return body_.skeleton.joint(knee_).first_dof; }

 private:
  const body::Body& body_;
  FootAim aim_;
  int hip_, knee_, ankle_;
  double thigh_m_, shank_m_;
  std::vector<int> dofs_;
  body::Kinematics at_;
  Eigen::Matrix<double, 3, Eigen::Dynamic> J_;
};

}  // namespace footing::motion
