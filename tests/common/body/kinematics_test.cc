#include <cstdlib>
#include <new>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "common/body/kinematics.h"
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
    Eigen::Matrix3Xd J(3, skeleton.dof);
    PointJacobian(skeleton, at, joint, at.p_WJ[index] + at.R_WJ[index] * point_J, J);
    for (int dof = 0; dof < skeleton.dof; ++dof) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(skeleton.dof, dof);
      ComputeKinematics(skeleton, q + step, after);
      ComputeKinematics(skeleton, q - step, before);
      const Eigen::Vector3d moved = after.p_WJ[index] + after.R_WJ[index] * point_J -
                                    before.p_WJ[index] - before.R_WJ[index] * point_J;
      EXPECT_LT((J.col(dof) - moved / (2 * kStep)).norm(), 1e-8) << dof;
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

namespace {
long allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace footing::body {
namespace {

using test::StandardBody;

/// Point masses that have the same mass, centre and inertia as a rigid body: six, two along each
/// principal axis, at sqrt(3 s / m) with s the second moment along it.
struct Points {
  std::vector<std::size_t> joint;
  std::vector<double> mass_kg;
  std::vector<Eigen::Vector3d> p_J;
};

Points PointMasses(const Body& body) {
  Points points;
  for (std::size_t i = 0; i < body.masses.size(); ++i) {
    const JointMass& mass = body.masses[i];
    if (mass.mass_kg == 0) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(mass.inertia_J);
    const Eigen::Vector3d I = solver.eigenvalues();
    for (int axis = 0; axis < 3; ++axis) {
      const double second = I.sum() / 2 - I(axis);
      const double distance = std::sqrt(3 * second / mass.mass_kg);
      for (double sign : {-1.0, 1.0}) {
        points.joint.push_back(i);
        points.mass_kg.push_back(mass.mass_kg / 6);
        points.p_J.push_back(mass.com_J + sign * distance * solver.eigenvectors().col(axis));
      }
    }
  }
  return points;
}

struct Moving {
  Eigen::VectorXd q, q_dot, q_ddot;

  explicit Moving(int dof, std::uint64_t seed) {
    noise::Random random(seed);
    q = RandomVector(dof, 1, random);
    q_dot = RandomVector(dof, 2, random);
    q_ddot = RandomVector(dof, 5, random);
  }
};

TEST(Momentum, IsTheSumOverPointMasses) {
  const Body body = StandardBody();
  const Moving moving(body.skeleton.dof, 5);
  Kinematics at(body.skeleton);
  JointVelocities velocities(body.skeleton);
  ComputeKinematics(body.skeleton, moving.q, at);
  ComputeVelocities(body.skeleton, at, moving.q_dot, velocities);
  const Points points = PointMasses(body);
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), linear = first, angular = first;
  for (std::size_t i = 0; i < points.joint.size(); ++i) {
    const std::size_t joint = points.joint[i];
    const Eigen::Vector3d arm = at.R_WJ[joint] * points.p_J[i];
    const Eigen::Vector3d p = at.p_WJ[joint] + arm;
    const Eigen::Vector3d v = velocities.v_WJ[joint] + velocities.w_WJ[joint].cross(arm);
    first += points.mass_kg[i] * p;
    linear += points.mass_kg[i] * v;
    angular += points.mass_kg[i] * p.cross(v);
  }
  const Eigen::Vector3d com = first / 70;
  angular -= com.cross(linear);
  const Momentum momentum = ComputeMomentum(body, at, velocities);
  EXPECT_LT((momentum.p_WC - com).norm(), 1e-12);
  EXPECT_LT((momentum.linear_W - linear).norm(), 1e-10);
  EXPECT_LT((momentum.angular_W - angular).norm(), 1e-10);
  EXPECT_LT((CentreOfMass(body, at) - com).norm(), 1e-12);
}

TEST(Momentum, TheCentroidalMatrixTimesTheRatesIsTheMomentum) {
  const Body body = StandardBody();
  const Moving moving(body.skeleton.dof, 6);
  Kinematics at(body.skeleton);
  JointVelocities velocities(body.skeleton);
  CompositeMasses workspace(body.skeleton);
  CentroidalMatrix A(6, body.skeleton.dof);
  ComputeKinematics(body.skeleton, moving.q, at);
  ComputeVelocities(body.skeleton, at, moving.q_dot, velocities);
  const Momentum momentum = ComputeMomentum(body, at, velocities);
  const Eigen::Vector3d com = ComputeCentroidalMatrix(body, at, workspace, A);
  const Eigen::VectorXd product = A * moving.q_dot;
  EXPECT_LT((com - momentum.p_WC).norm(), 1e-12);
  EXPECT_LT((product.head<3>() - momentum.linear_W).norm(), 1e-10);
  EXPECT_LT((product.tail<3>() - momentum.angular_W).norm(), 1e-10);

  Eigen::Matrix3Xd J(3, body.skeleton.dof);
  EXPECT_LT((ComJacobian(body, at, workspace, J) - momentum.p_WC).norm(), 1e-12);
  EXPECT_LT((J - A.topRows<3>() / 70).norm(), 1e-12);
}

TEST(Momentum, TheComJacobianIsTheDifferenceOfCentres) {
  const Body body = StandardBody();
  const Moving moving(body.skeleton.dof, 7);
  Kinematics at(body.skeleton);
  CompositeMasses workspace(body.skeleton);
  Eigen::Matrix3Xd J(3, body.skeleton.dof);
  ComputeKinematics(body.skeleton, moving.q, at);
  ComJacobian(body, at, workspace, J);
  const double h = 1e-6;
  for (int dof = 0; dof < body.skeleton.dof; ++dof) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(body.skeleton.dof, dof);
    ComputeKinematics(body.skeleton, moving.q + step, at);
    const Eigen::Vector3d after = CentreOfMass(body, at);
    ComputeKinematics(body.skeleton, moving.q - step, at);
    EXPECT_LT((J.col(dof) - (after - CentreOfMass(body, at)) / (2 * h)).norm(), 1e-8) << dof;
  }
}

TEST(Momentum, ARigidTurnAboutTheVerticalHasNoLinearMomentumAboutItsCentre) {
  const Body body = StandardBody();
  Kinematics at(body.skeleton);
  JointVelocities velocities(body.skeleton);
  const Eigen::VectorXd pose = TPose(body.skeleton, body.landmarks);
  ComputeKinematics(body.skeleton, pose, at);
  const Eigen::Vector3d com = CentreOfMass(body, at);
  // q_dot: heading turns at 1 rad/s, and the root moves round the centre of mass.
  Eigen::VectorXd q_dot = Eigen::VectorXd::Zero(body.skeleton.dof);
  q_dot(3) = 1;
  q_dot.head<3>() = Eigen::Vector3d::UnitZ().cross(at.p_WJ[0] - com);
  ComputeVelocities(body.skeleton, at, q_dot, velocities);
  const Momentum momentum = ComputeMomentum(body, at, velocities);
  EXPECT_LT(momentum.linear_W.norm(), 1e-10);
  // Symmetric left and right: no product of inertia y z. The turn's moment is that of a person with
  // arms out, between 2 and 5 kg m^2.
  EXPECT_NEAR(momentum.angular_W.y(), 0, 1e-9);
  EXPECT_GT(momentum.angular_W.z(), 2);
  EXPECT_LT(momentum.angular_W.z(), 5);
}

TEST(Momentum, NothingAllocatesOnceTheRoomIsMade) {
  const Body body = StandardBody();
  const Moving moving(body.skeleton.dof, 9);
  Kinematics at(body.skeleton);
  JointVelocities velocities(body.skeleton);
  JointAccelerations accelerations(body.skeleton);
  CompositeMasses workspace(body.skeleton);
  CentroidalMatrix A(6, body.skeleton.dof);
  Eigen::Matrix3Xd J(3, body.skeleton.dof);
  const long before = allocations;
  ComputeKinematics(body.skeleton, moving.q, at);
  ComputeVelocities(body.skeleton, at, moving.q_dot, velocities);
  ComputeAccelerations(body.skeleton, at, moving.q_dot, moving.q_ddot, velocities, accelerations);
  ComputeMomentum(body, at, velocities);
  ComputeCentroidalMatrix(body, at, workspace, A);
  ComJacobian(body, at, workspace, J);
  PointJacobian(body.skeleton, at, 5, at.p_WJ[5], J);
  EXPECT_EQ(allocations - before, 0);
}

Body Person() { return MakeBody(StandardPerson(1.8), {}).value(); }

TEST(Points, TheFistLiesSixTenthsOfTheHandBeyondTheWrist) {
  const Body person = Person();
  Kinematics at(person.skeleton);
  ComputeKinematics(person.skeleton, TPose(person.skeleton, person.landmarks), at);
  for (int side = 0; side < 2; ++side) {
    const Point fist = Fist(person, side);
    const int end = FindJoint(person.skeleton, side == 0 ? "lhand_end" : "rhand_end");
    ASSERT_GE(end, 0);
    const Eigen::Vector3d wrist = at.p_WJ[static_cast<std::size_t>(fist.joint)];
    const Eigen::Vector3d tip = at.p_WJ[static_cast<std::size_t>(end)];
    const Eigen::Vector3d place = Place(fist, at.R_WJ[static_cast<std::size_t>(fist.joint)], wrist);
    EXPECT_LT((place - (wrist + 0.6 * (tip - wrist))).norm(), 1e-9);
    EXPECT_GT(side == 0 ? place.y() : -place.y(), 0.5);
  }
}

TEST(Points, OfTheFootLieBehindEachOther) {
  const Body person = Person();
  Kinematics at(person.skeleton);
  ComputeKinematics(person.skeleton, TPose(person.skeleton, person.landmarks), at);
  const auto x = [&](const Point& point) {
    return at.p_WJ[static_cast<std::size_t>(point.joint)].x();
  };
  for (int side = 0; side < 2; ++side) {
    EXPECT_GT(x(Toe(person, side)), x(Ankle(person, side)) + 0.05);
    EXPECT_GT(x(ToeEnd(person, side)), x(Toe(person, side)) + 0.02);
  }
}

TEST(Points, WithoutToesTheFootIsItsAnkle) {
  Body person = Person();
  person.landmarks.joint[static_cast<std::size_t>(Landmark::kLeftToe)] = -1;
  person.landmarks.joint[static_cast<std::size_t>(Landmark::kLeftToeEnd)] = -1;
  EXPECT_EQ(Toe(person, 0).joint, Ankle(person, 0).joint);
  EXPECT_EQ(ToeEnd(person, 0).joint, Ankle(person, 0).joint);
  EXPECT_NE(Toe(person, 1).joint, Ankle(person, 1).joint);
}

}  // namespace
}  // namespace footing::body
