#pragma once

#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/skeleton.h"

namespace footing::body {

/// Places of all joints in one pose. The caller owns it; made once for a skeleton, then nothing
/// below allocates.
struct Kinematics {
  explicit Kinematics(const Skeleton& skeleton);

  std::vector<Eigen::Matrix3d> R_WJ;
  std::vector<Eigen::Vector3d> p_WJ;    ///< m.
  std::vector<Eigen::Vector3d> axis_W;  ///< Axis of motion of each degree of freedom.
};

/// Velocities of all joints' frames, of their origins.
struct JointVelocities {
  explicit JointVelocities(const Skeleton& skeleton);

  std::vector<Eigen::Vector3d> w_WJ;  ///< rad/s.
  std::vector<Eigen::Vector3d> v_WJ;  ///< m/s.
};

/// Accelerations of all joints' frames, of their origins.
struct JointAccelerations {
  explicit JointAccelerations(const Skeleton& skeleton);

  std::vector<Eigen::Vector3d> alpha_WJ;  ///< rad/s^2.
  std::vector<Eigen::Vector3d> a_WJ;      ///< m/s^2.
};

/// Forward kinematics. `q` has skeleton.dof entries.
void ComputeKinematics(const Skeleton& skeleton, PoseRef q, Kinematics& out);
/// The same for these joints alone, parents first; what is not among them is in `out` already.
void ComputeKinematics(const Skeleton& skeleton, PoseRef q, std::span<const int> joints,
                       Kinematics& out);

/// `q_dot` is the time derivative of the coordinates, entry for entry (of Euler angles: not the
/// angular velocity).
void ComputeVelocities(const Skeleton& skeleton, const Kinematics& at, PoseRef q_dot,
                       JointVelocities& out);
void ComputeAccelerations(const Skeleton& skeleton, const Kinematics& at, PoseRef q_dot,
                          PoseRef q_ddot, const JointVelocities& velocities,
                          JointAccelerations& out);

/// A matrix of three rows and a column a degree of freedom, or a block of one.
using JacobianRef = Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>, 0, Eigen::OuterStride<>>;

/// d p_W / dq of a point fixed to the frame of `joint` that is now at `p_W`. For the joint's own
/// origin `p_W` is at.p_WJ[joint].
void PointJacobian(const Skeleton& skeleton, const Kinematics& at, int joint,
                   const Eigen::Vector3d& p_W, JacobianRef out);

// Points of the body that sensors measure.

/// A point fixed to a joint's frame.
struct Point {
  int joint = 0;
  Eigen::Vector3d p_J_m = Eigen::Vector3d::Zero();
};

/// Middle of the fist, of side 0 (left) or 1: 0.6 of the way from the wrist to where the hand ends
/// (its landmark, or the end point that hangs on the wrist); the wrist itself where there is
/// neither.
Point Fist(const Body& body, int side);

/// Joint of the ankle.
Point Ankle(const Body& body, int side);

/// Ball of the foot; the tip of the toes where the skeleton has no ball, the ankle where it has
/// neither.
Point Toe(const Body& body, int side);

/// Tip of the toes, else as Toe.
Point ToeEnd(const Body& body, int side);

/// Where it is: `R_WJ` and `p_WJ` of its joint.
inline Eigen::Vector3d Place(const Point& point, const Eigen::Matrix3d& R_WJ,
                             const Eigen::Vector3d& p_WJ) {
  return p_WJ + R_WJ * point.p_J_m;
}
/// The same where the joints are `at`.
inline Eigen::Vector3d Place(const Point& point, const Kinematics& at) {
  const auto joint = static_cast<std::size_t>(point.joint);
  return Place(point, at.R_WJ[joint], at.p_WJ[joint]);
}

/// A point of the skeleton that should be at a place.
struct PointTarget {
  int joint = 0;
  Eigen::Vector3d p_J = Eigen::Vector3d::Zero();  ///< Fixed to the joint's frame, m.
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< Where it should be, m.
  double weight = 1;                              ///< Not negative.
};

/// Settings of a pose fit: its end, and a pull of coordinates towards a neutral pose.
struct FitOptions {
  int iterations = 10;  ///< At most.
  /// Cost for a coordinate to be away from `neutral`, against the points: m/rad (of the root's
  /// position: 1). Coordinates that no point shows go there. Null: 0.01 each.
  const Eigen::VectorXd* hold = nullptr;
  const Eigen::VectorXd* neutral = nullptr;  ///< Null: the pose at the start.
  double still = 1e-7;  ///< It has arrived when the cost falls by less than this part of itself.
};

/// Least squares of a pose to points by Gauss-Newton with damping (Levenberg-Marquardt). The caller
/// owns it; made once for a skeleton, Fit allocates nothing but for the first time with more
/// points.
class PoseFit {
 public:
  explicit PoseFit(const Skeleton& skeleton);

  /// Moves `q` so that the points come near their places. Returns the root of the weighted mean
  /// square of their distances, m; `q` is no worse than it was.
  double Fit(const std::vector<PointTarget>& targets, const FitOptions& options,
             Eigen::Ref<Eigen::VectorXd> q);

 private:
  /// Where the descent has come to.
  struct Descent {
    double points = 0;   ///< Cost of the points, m².
    double cost = 0;     ///< The same and what holds the coordinates.
    double gain = 0;     ///< By which the last step lowered the cost.
    double damping = 0;  ///< Damping of the next step, relative to H's diagonal.
  };

  void SetHold(const FitOptions& options, const Eigen::Ref<const Eigen::VectorXd>& q);
  double PointCost(const std::vector<PointTarget>& targets, const Eigen::VectorXd& q);
  double HoldCost(const Eigen::VectorXd& q) const;
  /// Sets H_ and gradient_ at the pose.
  void Linearise(const std::vector<PointTarget>& targets,
                 const Eigen::Ref<const Eigen::VectorXd>& q);
  /// Raises the damping until a step does not raise the cost, and takes it; false if none does.
  bool Step(const std::vector<PointTarget>& targets, Descent& descent,
            Eigen::Ref<Eigen::VectorXd> q);

  const Skeleton& skeleton_;
  Kinematics at_;
  Eigen::MatrixXd J_, H_, damped_;
  Eigen::VectorXd residuals_, gradient_, hold_, neutral_, trial_, step_;
  Eigen::LLT<Eigen::MatrixXd> solver_;
};

/// Centre of mass C and momentum of the whole body. Angular momentum is about C.
struct Momentum {
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();       ///< m.
  Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();   ///< kg m/s.
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();  ///< kg m^2/s.
};

/// Six rows (linear, then angular about C) and a column a degree of freedom.
using CentroidalMatrix = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Workspace for the composites of ComputeCentroidalMatrix; the caller owns it.
struct CompositeMasses {
  explicit CompositeMasses(const Skeleton& skeleton);

  std::vector<double> mass_kg;
  std::vector<Eigen::Vector3d> first_W;    ///< Mass times centre, from the body's C; kg m.
  std::vector<Eigen::Matrix3d> inertia_W;  ///< About the body's C; kg m^2.
};

/// Centre of mass of the whole body in W, m.
Eigen::Vector3d CentreOfMass(const Body& body, const Kinematics& at);

/// Momentum in a pose, from the velocities of the joints' frames.
Momentum ComputeMomentum(const Body& body, const Kinematics& at, const JointVelocities& velocities);

/// Centroidal momentum matrix A, (linear, angular) = A q_dot, by composites of the subtrees (Orin,
/// Goswami and Lee 2013, "Centroidal dynamics of a humanoid robot"). `out` has dof columns. Returns
/// C.
Eigen::Vector3d ComputeCentroidalMatrix(const Body& body, const Kinematics& at,
                                        CompositeMasses& workspace, CentroidalMatrix& out);

/// d p_WC / dq: the linear rows of A over the mass.
Eigen::Vector3d ComJacobian(const Body& body, const Kinematics& at, CompositeMasses& workspace,
                            JacobianRef out);

}  // namespace footing::body
