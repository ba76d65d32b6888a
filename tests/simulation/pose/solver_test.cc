#include <gtest/gtest.h>

#include "daemon/simulation/pose/fibonacci.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/pose/leg_ik.h"
#include "tests/simulation/pose/made_poses.h"

namespace footing::pose {
namespace {

using body::Landmark;

TEST(PoseTargets, APointMayBePlacedFromAnotherJoint) {
  World world;
  const Eigen::VectorXd& truth = world.poses.col(7);
  PoseTargets targets = world.Targets(truth, 0.003);
  // The wrists from the shoulders instead of from the world.
  for (const int i : {0, 1}) {
    PointTarget& point = targets.points[static_cast<std::size_t>(i)];
    const Landmark shoulder = i == 0 ? Landmark::kLeftShoulder : Landmark::kRightShoulder;
    point.from_joint = world.person.landmarks[shoulder];
    point.p_W_m -= world.At(truth, shoulder);
  }
  GaussNewton solver(world.person, world.basis, {});
  FibonacciSearch search(world.person, world.basis, {});
  for (int frame = 0; frame < 3; ++frame) {
    solver.Solve(targets);
    search.Solve(targets);
  }
  const auto wrist_error_m = [&](const Eigen::VectorXd& q) {
    body::ComputeKinematics(world.person.skeleton, q, world.at);
    return (targets.points[0].p_W_m - PlaceOf(targets.points[0], world.at)).norm();
  };
  EXPECT_LT(wrist_error_m(solver.q()), 0.005);
  EXPECT_LT(wrist_error_m(search.q()), 0.05);
  EXPECT_GT(wrist_error_m(world.basis.mean), 0.06);
}

TEST(Basis, HoldsThePosesItWasMadeFrom) {
  World world;
  EXPECT_EQ(world.basis.size(), 12);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = world.poses.col(i);
    const Eigen::VectorXd a = world.basis.inverse * (q - world.basis.mean);
    EXPECT_LT((world.basis.mean + world.basis.modes * a - q).norm(), 1e-9);
  }
}

TEST(Basis, ItsComponentsFallInVarianceAndAShareOfItTakesFewer) {
  World world;
  for (int i = 1; i < world.basis.size(); ++i) {
    EXPECT_LE(world.basis.sd(i), world.basis.sd(i - 1));
  }
  const PoseBasis fewer = FitBasis(world.poses, {.variance_share = 0.5});
  EXPECT_LT(fewer.size(), world.basis.size());
  EXPECT_GE(fewer.sd.squaredNorm(), 0.5 * world.basis.sd.squaredNorm());
}

TEST(FibonacciSearch, LowersEquation6FrameByFrame) {
  World world;
  FibonacciSearch solver(world.person, world.basis, {});
  const PoseTargets targets = world.Targets(world.poses.col(7), 0.02);
  const double at_mean_m = world.WorstM(world.basis.mean, targets);
  solver.Solve(targets);
  double cost = solver.cost();
  for (int frame = 0; frame < 30; ++frame) {
    solver.Solve(targets);
    EXPECT_LE(solver.cost(), cost * 1.01 + 1e-6);
    cost = solver.cost();
  }
  EXPECT_LT(world.WorstM(solver.q(), targets), 0.25 * at_mean_m);
}

TEST(FibonacciSearch, KeepsEveryCoefficientWithinItsRange) {
  World world;
  FibonacciSearch solver(world.person, world.basis, {});
  PoseTargets targets = world.Targets(world.poses.col(7), 0.02);
  for (auto& point : targets.points) point.p_W_m *= 3;
  for (int frame = 0; frame < 10; ++frame) solver.Solve(targets);
  const Eigen::ArrayXd sds = solver.coefficients().array().abs() / world.basis.sd.array();
  EXPECT_LE(sds.maxCoeff(), FibonacciOptions().reach);
  EXPECT_GT(sds.maxCoeff(), 0.98 * FibonacciOptions().reach);  // They would go on.
}

TEST(LegIk, BringsTheFootToItsPlaceAndMovesNothingElse) {
  World world;
  const body::Landmarks& landmarks = world.person.landmarks;
  LegIk leg(world.person, landmarks[Landmark::kLeftHip], landmarks[Landmark::kLeftToe]);
  Eigen::VectorXd q = world.poses.col(5);
  PoseTargets targets = world.Targets(q, 0.02);
  targets.has_com = false;
  for (int i = 0; i < targets.count; ++i) {
    targets.points[static_cast<std::size_t>(i)].p_W_m += Eigen::Vector3d(0.03, -0.02, 0.04);
  }
  const Eigen::Vector3d right_before = world.At(q, Landmark::kRightAnkle);
  const Eigen::Vector3d hips_before = world.At(q, Landmark::kHips);
  body::Kinematics at(world.person.skeleton);
  body::ComputeKinematics(world.person.skeleton, q, at);
  leg.Solve(targets, 20, q, at);
  EXPECT_LT((world.At(q, Landmark::kLeftAnkle) - targets.points[2].p_W_m).norm(), 0.01);
  EXPECT_EQ(world.At(q, Landmark::kRightAnkle), right_before);
  EXPECT_EQ(world.At(q, Landmark::kHips), hips_before);
  body::ComputeKinematics(world.person.skeleton, q, world.at);
  EXPECT_EQ(at.p_WJ, world.at.p_WJ);  // It tells where it has brought the joints.
}

}  // namespace
}  // namespace footing::pose
