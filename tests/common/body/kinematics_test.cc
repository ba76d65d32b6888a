#include "common/body/kinematics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/common/body/poses.h"

namespace footing::body {
namespace {

using test::RandomVector;
constexpr double kStep = 1e-6;  // Central differences: error about 1e-10 of the value.

TEST(Kinematics, ATwoLinkArmIsWhereTrigonometrySays) {
  Joint root, elbow, end;
  root.rotations = {{Axis::kZ}};
  elbow.parent = 0;
  elbow.offset_m = {0.3, 0, 0};
  elbow.rotations = {{Axis::kZ}};
  end.parent = 1;
  end.offset_m = {0.25, 0, 0};
  const Skeleton arm = MakeSkeleton({root, elbow, end});
  Eigen::VectorXd q(5);
  q << 1, 2, 3, 0.5, 0.7;
  Kinematics at(arm);
  ComputeKinematics(arm, q, at);
  // x = 1 + 0.3 cos 0.5 + 0.25 cos 1.2, y = 2 + 0.3 sin 0.5 + 0.25 sin 1.2.
  EXPECT_NEAR(at.p_WJ[2].x(), 1 + 0.3 * std::cos(0.5) + 0.25 * std::cos(1.2), 1e-12);
  EXPECT_NEAR(at.p_WJ[2].y(), 2 + 0.3 * std::sin(0.5) + 0.25 * std::sin(1.2), 1e-12);
  EXPECT_NEAR(at.p_WJ[2].z(), 3, 1e-12);
}

TEST(Kinematics, AgreesWithProductsOfTheJointsRotations) {
  const Skeleton skeleton = StandardPerson(1.7);
  noise::Random random(2);
  const Eigen::VectorXd q = RandomVector(skeleton.dof, 2, random);
  Kinematics at(skeleton);
  ComputeKinematics(skeleton, q, at);
  for (int i = 1; i < skeleton.size(); ++i) {
    const Joint& joint = skeleton.joint(i);
    const auto parent = static_cast<std::size_t>(joint.parent);
    const auto here = static_cast<std::size_t>(i);
    EXPECT_TRUE(at.R_WJ[here].isApprox(at.R_WJ[parent] * JointRotation(joint, q), 1e-12));
    EXPECT_TRUE(at.p_WJ[here].isApprox(at.p_WJ[parent] + at.R_WJ[parent] * joint.offset_m, 1e-12));
  }
}

TEST(Kinematics, JacobiansAreTheDifferencesOfPlaces) {
  const Skeleton skeleton = StandardPerson(1.7);
  noise::Random random(3);
  const Eigen::VectorXd q = RandomVector(skeleton.dof, 1.5, random);
  Kinematics at(skeleton), after(skeleton), before(skeleton);
  ComputeKinematics(skeleton, q, at);
  const Eigen::Vector3d point_J(0.1, -0.05, 0.2);
  for (int joint : {0, FindJoint(skeleton, "ltoes_end"), FindJoint(skeleton, "rhand")}) {
    const auto index = static_cast<std::size_t>(joint);
    Eigen::Matrix3Xd J(3, skeleton.dof), w(3, skeleton.dof);
    PointJacobian(skeleton, at, joint, at.p_WJ[index] + at.R_WJ[index] * point_J, J);
    OrientationJacobian(skeleton, at, joint, w);
    for (int dof = 0; dof < skeleton.dof; ++dof) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(skeleton.dof, dof);
      ComputeKinematics(skeleton, q + step, after);
      ComputeKinematics(skeleton, q - step, before);
      const Eigen::Vector3d moved = after.p_WJ[index] + after.R_WJ[index] * point_J -
                                    before.p_WJ[index] - before.R_WJ[index] * point_J;
      EXPECT_LT((J.col(dof) - moved / (2 * kStep)).norm(), 1e-8) << dof;
      const Eigen::AngleAxisd turn(after.R_WJ[index] * before.R_WJ[index].transpose());
      EXPECT_LT((w.col(dof) - turn.angle() * turn.axis() / (2 * kStep)).norm(), 1e-7) << dof;
    }
  }
}

TEST(Kinematics, VelocitiesAndAccelerationsAreTheDerivativesOfAMovement) {
  const Skeleton skeleton = StandardPerson(1.7);
  noise::Random random(4);
  const Eigen::VectorXd q = RandomVector(skeleton.dof, 1, random);
  const Eigen::VectorXd q_dot = RandomVector(skeleton.dof, 2, random);
  const Eigen::VectorXd q_ddot = RandomVector(skeleton.dof, 5, random);
  Kinematics at(skeleton), after(skeleton), before(skeleton);
  JointVelocities velocities(skeleton);
  JointAccelerations accelerations(skeleton);
  ComputeKinematics(skeleton, q, at);
  ComputeVelocities(skeleton, at, q_dot, velocities);
  ComputeAccelerations(skeleton, at, q_dot, q_ddot, velocities, accelerations);
  const double h = 1e-4;
  const auto moment = [&](double t) { return Eigen::VectorXd(q + t * q_dot + t * t / 2 * q_ddot); };
  ComputeKinematics(skeleton, moment(h), after);
  ComputeKinematics(skeleton, moment(-h), before);
  JointVelocities next(skeleton), last(skeleton);
  ComputeVelocities(skeleton, after, q_dot + h * q_ddot, next);
  ComputeVelocities(skeleton, before, q_dot - h * q_ddot, last);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Eigen::Vector3d v = (after.p_WJ[i] - before.p_WJ[i]) / (2 * h);
    EXPECT_LT((velocities.v_WJ[i] - v).norm(), 1e-4) << i;
    EXPECT_LT((accelerations.a_WJ[i] - (next.v_WJ[i] - last.v_WJ[i]) / (2 * h)).norm(), 1e-3) << i;
    EXPECT_LT((accelerations.alpha_WJ[i] - (next.w_WJ[i] - last.w_WJ[i]) / (2 * h)).norm(), 1e-3)
        << i;
  }
}

}  // namespace
}  // namespace footing::body
