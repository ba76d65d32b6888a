#include "daemon/offline/learning/basis.h"

#include <gtest/gtest.h>

#include "common/virtual/devices/random.h"

namespace footing::learning {
namespace {

/// Root position and two angles that move as one, and one of their own.
Eigen::MatrixXd Poses(int count) {
  noise::Random random(1);
  Eigen::MatrixXd poses(6, count);
  for (int i = 0; i < count; ++i) {
    const double bend = random.Normal(), twist = 0.1 * random.Normal();
    poses.col(i) << 0.1, 0, 1 - 0.2 * bend, 0.3 + bend, -0.5 * bend, twist;
  }
  return poses;
}

const std::vector<std::string> kDofs = {"x", "y", "z", "a", "b", "c"};

TEST(MakeBasis, FindsWhatMovesTogetherInTheOrderOfItsVariance) {
  const PoseBasis basis = MakeBasis(Poses(4000), kDofs);
  // Scaled (2.5 a metre): (0, 0, -0.5, 1, -0.5, 0) times the bend, of length sqrt(1.5).
  Eigen::VectorXd expected(6);
  expected << 0, 0, -0.5, 1, -0.5, 0;
  EXPECT_LT((basis.components.row(0).transpose() - expected.normalized()).norm(), 0.01);
  EXPECT_NEAR(basis.variances(0), 1.5, 0.1 * 1.5);
  EXPECT_NEAR(basis.variances(1), 0.01, 0.1 * 0.01);
  EXPECT_NEAR(basis.variances.tail(4).sum(), 0, 1e-12);
  EXPECT_EQ(basis.ComponentsFor(0.9), 1);
  EXPECT_EQ(basis.ComponentsFor(0.9999), 2);
}

TEST(MakeBasis, KeepsEveryComponentSoThatAnyPoseCanBeMade) {
  const PoseBasis basis = MakeBasis(Poses(100), kDofs);
  EXPECT_TRUE((basis.components * basis.components.transpose()).isIdentity(1e-9));
  const Eigen::VectorXd pose = Eigen::VectorXd::LinSpaced(6, -1, 2);  // Like none of them.
  const Eigen::VectorXd along = basis.components * basis.scale.cwiseProduct(pose - basis.mean);
  const Eigen::VectorXd again =
      basis.mean + (basis.components.transpose() * along).cwiseQuotient(basis.scale);
  EXPECT_TRUE(again.isApprox(pose, 1e-9));
}

TEST(MakeBasis, SaysInItsTensorsWhichColumnIsWhichDof) {
  model::Model model{.kind = "basis", .provenance = {}, .tensors = {}};
  const PoseBasis basis = MakeBasis(Poses(100), kDofs);
  AppendTensors(basis, model);
  ASSERT_TRUE(model::Check(model, "m").ok());
  const auto components = model::Find(model, "components", {6, 6}, "m");
  ASSERT_TRUE(components.ok());
  EXPECT_EQ((*components)->labels, kDofs);
  EXPECT_FLOAT_EQ((*components)->values[6 * 1 + 5], static_cast<float>(basis.components(1, 5)));
}

}  // namespace
}  // namespace footing::learning
