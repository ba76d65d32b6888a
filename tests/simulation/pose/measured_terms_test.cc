#include "daemon/simulation/pose/targets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/body/landmarks.h"

namespace footing::pose {
namespace {

constexpr double kFrameS = 1.0 / 60;

/// A fist in W, a knee from its hip, the COM and the angular momentum, none of them where they are.
PoseTargets AllKinds(const body::Body& person) {
  PoseTargets targets;
  PointTarget fist;
  fist.joint = person.landmarks[body::Landmark::kLeftWrist];
  fist.p_J_m << 0.02, 0.05, -0.01;
  fist.p_W_m << 0.3, 0.6, 1.2;
  fist.sd_m << 0.01, 0.02, 0.03;
  fist.whitening = WhiteningOf(fist.sd_m, {0.0001, -0.0002, 0.0003});
  targets.Add(fist);
  PointTarget knee;
  knee.joint = person.landmarks[body::Landmark::kRightKnee];
  knee.from_joint = person.landmarks[body::Landmark::kRightHip];
  knee.p_W_m << 0.1, 0, -0.3;
  knee.sd_m.setConstant(0.05);
  targets.Add(knee);
  targets.has_com = targets.has_angular = true;
  targets.com_W_m << 0.05, 0, 0.9;
  targets.com_sd_m << 0.02, 0.03, 0.04;
  targets.angular_W << 1, 2, 0;
  targets.angular_sd << 1, 2, 3;
  return targets;
}

TEST(MeasuredTerms, TheirBlocksAreTheDerivativesOfWhatIsMeasured) {
  body::PersonParameters parameters;
  parameters.mass_kg = 70;
  parameters.height_m = 1.75;
  const body::Body person = body::MakeBody(body::StandardPerson(1.75), parameters).value();
  const PoseTargets targets = AllKinds(person);
  MeasuredTerms terms(person, kFrameS);
  Eigen::VectorXd q = body::TPose(person.skeleton, person.landmarks);
  for (Eigen::Index i = 3; i < q.size(); ++i) q(i) += 0.1 * std::sin(static_cast<double>(i));
  // No rate: the angular momentum's derivative is then that of the matrix times the step alone.
  const Eigen::VectorXd before = q;
  terms.Measure(targets, q, &before);
  ASSERT_EQ(terms.rows(), 12);
  terms.Differentiate(targets);
  const Eigen::VectorXd residuals = terms.residuals();
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(12, q.size());
  for (int row = 0; row < 12; row += 3) {
    for (const int dof : *terms.block(row).dofs) {
      H.block<3, 1>(row, dof) = terms.block(row).by_q.col(dof);
    }
  }
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    Eigen::VectorXd moved = q;
    moved(i) += kStep;
    terms.Measure(targets, moved, &before);
    // A residual is target less measured: its slope is minus H's column.
    const Eigen::VectorXd slope = (terms.residuals() - residuals) / kStep;
    EXPECT_LT((slope + H.col(i)).norm(), 2e-3 * (1 + H.col(i).norm())) << i;
  }
}

TEST(MeasuredTerms, AnglesBeyondTheirLimitsHaveARowEach) {
  const body::Body person =
      body::MakeBody(body::StandardPerson(1.75), body::PersonParameters()).value();
  MeasuredTerms terms(person, kFrameS);
  Eigen::VectorXd q = body::TPose(person.skeleton, person.landmarks);
  const auto dof_of = [&](body::Landmark landmark) {
    return person.skeleton.joint(person.landmarks[landmark]).first_dof;
  };
  const int knee = dof_of(body::Landmark::kLeftKnee), elbow = dof_of(body::Landmark::kRightElbow);
  const PoseTargets none;
  terms.Measure(none, q, nullptr);
  EXPECT_EQ(terms.rows(), 0);
  q(knee) = body::LowerLimits(person.skeleton)(knee) - 0.3;
  q(elbow) = body::UpperLimits(person.skeleton)(elbow) + 0.2;
  q(dof_of(body::Landmark::kLeftShoulder)) = 3;  // Has limits that people exceed.
  terms.Measure(none, q, nullptr);
  terms.Differentiate(none);
  ASSERT_EQ(terms.rows(), 3);
  const JacobianBlock& block = terms.block(0);
  ASSERT_EQ(*block.dofs, (std::vector<int>{knee, elbow}));
  EXPECT_NEAR(terms.residuals()(0), 3, 1e-9);  // Back by 0.3 rad, over 0.1 rad.
  EXPECT_NEAR(terms.residuals()(1), -2, 1e-9);
  EXPECT_EQ(terms.residuals()(2), 0);
  EXPECT_EQ(block.by_q.col(knee), Eigen::Vector3d(10, 0, 0));
  EXPECT_EQ(block.by_q.col(elbow), Eigen::Vector3d(0, 10, 0));
}

TEST(MeasuredTerms, LeaveTheAngularMomentumOutWithoutAPoseBefore) {
  const body::Body person =
      body::MakeBody(body::StandardPerson(1.75), body::PersonParameters()).value();
  MeasuredTerms terms(person, kFrameS);
  terms.Measure(AllKinds(person), body::TPose(person.skeleton, person.landmarks), nullptr);
  EXPECT_EQ(terms.rows(), 9);
}

}  // namespace
}  // namespace footing::pose
