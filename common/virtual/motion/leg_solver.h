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
  double thigh_turn_rad = 0;  ///< As ThighTurn; LegAim::kWhole only.
};

/// Target beside the place of the ankle.
enum class LegAim {
  /// Where the foot points (x of its frame), with the last angle of the ankle.
  kFoot,
  /// Where the foot points (from ankle to toe, so that toes stay where they are when the sole
  /// rolls), and how the thigh is turned about itself, which says where the knee is. How the sole
  /// rolls comes last: an ankle that has an angle for it brings it flat. The skeletons of CMU have
  /// none, so their soles roll with the shank, as in their recordings.
  kWhole,
};

/// Puts a foot at its place by the joints from hip to ankle: the ankle's origin and where the foot
/// points are met exactly when they are in reach.
class LegSolver {
 public:
  /// `body` must outlive it. `left`: which leg.
  LegSolver(const body::Body& body, bool left, LegAim aim = LegAim::kFoot);

  /// Moves the leg's angles in `q`, beginning at those that stand there; from a bent knee it stays
  /// bent to the same side. Returns what is left of the distance, m.
  double Solve(const FootPlace& place, Eigen::Ref<Eigen::VectorXd> q);
  /// How the thigh is turned about itself against the pelvis, from where the least turn from the
  /// T-pose would bring it; about the line from knee to hip, rad.
  double ThighTurn(const body::Kinematics& at) const;
  /// Bends the knee further, ahead.
  void BendKnee(double angle_rad, Eigen::Ref<Eigen::VectorXd> q);

  /// Thigh and shank, m.
  double thigh_m() const { return thigh_m_; }
  double shank_m() const { return shank_m_; }
  int hip() const { return hip_; }
  int ankle() const { return ankle_; }
  int knee_dof() const { return body_.skeleton.joint(knee_).first_dof; }

 private:
  struct Equations;
  struct Thigh {  ///< In the pelvis.
    Eigen::Vector3d along_P;
    Eigen::Matrix3d R_PH;
  };
  std::size_t pelvis() const { return static_cast<std::size_t>(body_.skeleton.joint(hip_).parent); }
  Thigh ThighOf(const body::Kinematics& at) const;
  /// The rotation of the T-pose, brought into the direction of `thigh` by the least turn.
  Eigen::Matrix3d Untwisted(const Thigh& thigh) const;
  Eigen::Matrix3Xd Columns(int joint, const Eigen::Vector3d& p_W);
  /// Adds the correction for the thigh, and for a point of the foot; returns the distance left, m.
  double AddThigh(double turn_rad, Equations& equations);
  double AddFoot(const FootPlace& place, const Eigen::Vector3d& p_A, double weight,
                 Equations& equations);

  const body::Body& body_;
  LegAim aim_;
  int hip_, knee_, ankle_;
  Eigen::Vector3d ahead_A_;  ///< A point of the foot where it points.
  double thigh_m_, shank_m_;
  Thigh t_pose_;
  std::vector<int> dofs_;
  body::Kinematics at_;
  Eigen::Matrix<double, 3, Eigen::Dynamic> J_;
};

}  // namespace footing::motion
