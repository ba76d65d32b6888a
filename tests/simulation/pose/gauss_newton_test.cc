#include <random>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/pose/targets.h"
#include "tests/simulation/pose/made_poses.h"

namespace footing::pose {
namespace {

using body::Landmark;

TEST(GaussNewton, ALegDoesNotBendBackwards) {
  World world;
  Eigen::VectorXd q = body::TPose(world.person.skeleton, world.person.landmarks);
  PoseTargets targets = world.Targets(q, 0.02);
  PointTarget knee;
  knee.joint = world.person.landmarks[Landmark::kLeftKnee];
  knee.p_W_m = world.At(q, Landmark::kLeftKnee) - Eigen::Vector3d(0.2, 0, 0);
  knee.sd_m.setConstant(0.05);
  targets.Add(knee);
  GaussNewtonOptions options;
  options.prior_weight = 0.1;
  const PoseBasis basis = FitBasis(Poses(world.person, 400, 60, 2), {});  // Any angle may change.
  GaussNewton solver(world.person, basis, options);
  solver.Solve(targets);
  const int dof = world.person.skeleton.joint(knee.joint).first_dof;
  const double limit_rad = body::LowerLimits(world.person.skeleton)(dof);
  EXPECT_GT(solver.q()(dof), limit_rad - 0.1);
}

TEST(GaussNewton, FindsAPoseOfTheSpaceFromHandsFeetAndCentreOfMass) {
  World world;
  for (int i = 0; i < 20; ++i) {
    GaussNewton solver(world.person, world.basis, {});
    const PoseTargets targets = world.Targets(world.poses.col(i), 1e-5);
    solver.Solve(targets);
    EXPECT_LT(world.WorstM(solver.q(), targets), 1e-3) << i;
    EXPECT_LT((solver.q() - world.poses.col(i)).tail(53).cwiseAbs().mean(), 0.01) << i;
  }
}

TEST(GaussNewton, KnowsBestWhatIsMeasured) {
  World world;
  GaussNewton solver(world.person, world.basis, {});
  PoseTargets targets = world.Targets(world.poses.col(3), 0.01);
  targets.has_com = false;
  solver.Solve(targets);
  const int wrist = world.person.landmarks[Landmark::kLeftWrist];
  const double measured_m = solver.JointSd(wrist);
  solver.Reset();
  solver.Solve({});
  const double free_m = solver.JointSd(wrist);
  EXPECT_LT(measured_m, 0.012);  // Not much worse than its own measurement.
  EXPECT_GT(free_m, 3 * measured_m);
}

TEST(GaussNewton, KnowsTheHeightOfTheCentreOfMassBetterWhereItIsMeasured) {
  World world;
  GaussNewton solver(world.person, world.basis, {});
  PoseTargets targets = world.Targets(world.poses.col(3), 0.01);
  targets.com_sd_m << 1, 1, 0.002;
  solver.Solve(targets);
  const double measured_m = solver.ComSd().z();
  targets.com_sd_m.setConstant(1);
  solver.Reset();
  solver.Solve(targets);
  EXPECT_LT(measured_m, 0.002);
  EXPECT_GT(solver.ComSd().z(), 1.5 * measured_m);
}

TEST(GaussNewton, GoesOnFromAPoseThatItIsGiven) {
  World world;
  GaussNewtonOptions options;
  options.smooth_weight = 100;  // Stays where it was.
  GaussNewton solver(world.person, world.basis, options);
  solver.ContinueFrom(world.poses.col(5));
  solver.Solve({});
  EXPECT_LT((solver.q() - world.poses.col(5)).norm(), 1e-2);
}

TEST(GaussNewton, LeavesAMinimumThatIsFarFromTheLikelyPose) {
  World world;
  const int pitch = world.person.skeleton.joint(0).first_dof;
  Eigen::MatrixXd poses = world.poses;
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < poses.cols(); ++i) poses(pitch, i) += 0.5 * normal(engine);
  const PoseBasis basis = FitBasis(poses, {});
  const Eigen::VectorXd truth = world.poses.col(7);
  const PoseTargets targets = world.Targets(truth, 0.01);
  Eigen::VectorXd turned = truth;  // By a whole turn, which moves no joint.
  turned(pitch) += 2 * kPi;
  GaussNewton solver(world.person, basis, {});
  solver.ContinueFrom(turned);
  ASSERT_GT(solver.q()(pitch), truth(pitch) + 5);
  solver.Solve(targets);
  EXPECT_NEAR(solver.q()(pitch), truth(pitch), 0.3);
  EXPECT_LT(world.WorstM(solver.q(), targets), 0.02);
}

TEST(GaussNewton, StaysInAMinimumThatIsNoWorse) {
  World world;
  PoseTargets targets = world.Targets(world.poses.col(7), 0.01);
  targets.points[0].p_W_m.x() += 1;  // A wrist out of reach: no start is near.
  GaussNewton solver(world.person, world.basis, {});
  solver.Solve(targets);  // With more steps than a second start has.
  ASSERT_GT(world.WorstM(solver.q(), targets), 0.3);
  const Eigen::VectorXd settled = solver.q();
  const double settled_m = solver.JointSd(targets.points[0].joint);
  solver.Solve(targets);
  EXPECT_LT((solver.q() - settled).norm(), 0.1);
  EXPECT_NEAR(solver.JointSd(targets.points[0].joint), settled_m, 4e-4);
  body::ComputeKinematics(world.person.skeleton, solver.q(), world.at);
  EXPECT_EQ(solver.at().p_WJ, world.at.p_WJ);  // The joints are those of the pose.
}

TEST(GaussNewton, MovesAsItsPriorsMeanMoves) {
  World world;
  GaussNewtonOptions options;
  options.prior_weight = 0;
  GaussNewton solver(world.person, world.basis, options);
  const Eigen::VectorXd mean = world.basis.mean + 0.5 * world.basis.modes * world.basis.sd;
  solver.Solve({}, world.basis.mean);
  solver.Solve({}, mean);
  EXPECT_LT((solver.q() - mean).norm(), 1e-6);
}

TEST(GaussNewton, WithNothingMeasuredStaysAtThePriorsMean) {
  World world;
  GaussNewton solver(world.person, world.basis, {});
  const Eigen::VectorXd mean = world.basis.mean + 0.5 * world.basis.modes * world.basis.sd;
  solver.Solve({}, mean);
  EXPECT_LT((solver.q() - mean).norm(), 1e-12);
}

TEST(GaussNewton, AngularMomentumMovesWhatHandsAndFeetDoNotShow) {
  World world;
  const double frame_s = 1.0 / 60;
  GaussNewton solver(world.person, world.basis, {.iterations = 8, .smooth_weight = 0});
  const Eigen::VectorXd before = world.poses.col(3), direction = world.basis.modes.col(2);
  const Eigen::VectorXd after = before + 0.1 * world.basis.sd(2) * direction;
  solver.Solve(world.Targets(before, 1e-5));
  PoseTargets targets;
  targets.has_angular = true;
  targets.angular_sd.setConstant(1e-4);
  body::JointVelocities velocities(world.person.skeleton);
  body::ComputeKinematics(world.person.skeleton, after, world.at);
  body::ComputeVelocities(world.person.skeleton, world.at, (after - solver.q()) / frame_s,
                          velocities);
  targets.angular_W = body::ComputeMomentum(world.person, world.at, velocities).angular_W;
  const Eigen::VectorXd was = solver.q();
  solver.Solve(targets);
  body::ComputeKinematics(world.person.skeleton, solver.q(), world.at);
  body::ComputeVelocities(world.person.skeleton, world.at, (solver.q() - was) / frame_s,
                          velocities);
  const Eigen::Vector3d reached =
      body::ComputeMomentum(world.person, world.at, velocities).angular_W;
  EXPECT_LT((reached - targets.angular_W).norm(), 0.02 * targets.angular_W.norm());
}

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

TEST(Basis, MayVaryMoreAlongADirection) {
  World world;
  const auto covariance = [](const PoseBasis& basis) {
    const Eigen::MatrixXd scaled = basis.modes * basis.sd.asDiagonal();
    return Eigen::MatrixXd(scaled * scaled.transpose());
  };
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(world.basis.dof());
  direction(5) = 0.2;
  direction(8) = -0.2;
  const PoseBasis wide = Widened(world.basis, direction);
  const Eigen::MatrixXd expected = covariance(world.basis) + direction * direction.transpose();
  EXPECT_LT((covariance(wide) - expected).norm(), 1e-8);
  EXPECT_EQ(wide.mean, world.basis.mean);
  const Eigen::VectorXd a = Eigen::VectorXd::LinSpaced(wide.size(), -1, 1);
  EXPECT_LT((wide.inverse * (wide.modes * a) - a).norm(), 1e-9);
  for (int i = 1; i < wide.size(); ++i) EXPECT_LE(wide.sd(i), wide.sd(i - 1));
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

/// Mean of equation (6) over a steady motion of two components, with its angular momentum.
double MeanCostOfAMotion(double carry) {
  World world;
  FibonacciOptions options;
  options.carry = carry;
  FibonacciSearch solver(world.person, world.basis, options);
  body::JointVelocities velocities(world.person.skeleton);
  const Eigen::VectorXd step =
      0.03 * (world.basis.modes.leftCols(2) * world.basis.sd.head(2)).eval();
  double sum = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const Eigen::VectorXd q = world.poses.col(7) + frame * step;
    PoseTargets targets = world.Targets(q, 0.02);
    body::ComputeKinematics(world.person.skeleton, q, world.at);
    body::ComputeVelocities(world.person.skeleton, world.at, step / options.frame_s, velocities);
    targets.has_angular = true;
    targets.angular_sd.setConstant(10);
    targets.angular_W = body::ComputeMomentum(world.person, world.at, velocities).angular_W;
    solver.Solve(targets);
    if (frame >= 5) sum += solver.cost() / 15;
  }
  return sum;
}

TEST(FibonacciSearch, FollowsAMotionThatGoesOn) {
  EXPECT_LT(MeanCostOfAMotion(FibonacciOptions().carry), 0.8 * MeanCostOfAMotion(0));
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
