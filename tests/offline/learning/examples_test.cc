#include "daemon/offline/learning/examples.h"

#include <gtest/gtest.h>

#include "daemon/offline/learning/scaling.h"

namespace footing::learning {
namespace {

Examples Numbered(int rows) {
  Examples examples{.inputs = Eigen::MatrixXd(rows, 4), .targets = Eigen::MatrixXd(rows, 1)};
  for (int row = 0; row < rows; ++row) {
    examples.inputs.row(row).setConstant(row);
    examples.targets(row, 0) = -row;
  }
  return examples;
}

TEST(Examples, AreSplitInTime) {
  const Split split = SplitInTime(Numbered(10), 0.25);
  EXPECT_EQ(split.train.rows(), 8);
  EXPECT_EQ(split.validation.rows(), 2);
  EXPECT_EQ(split.train.inputs(7, 0), 7);
  EXPECT_EQ(split.validation.inputs(0, 0), 8);
  EXPECT_EQ(split.validation.targets(1, 0), -9);
  EXPECT_EQ(SplitInTime(Numbered(10), 0).validation.rows(), 0);
}

TEST(FeedbackNoise, IsSharedWithinAGroupAndLeavesTheRestTrue) {
  const Examples clean = Numbered(2000);
  const Examples noisy = WithFeedbackNoise(
      clean, {.groups = {{0, 1}, {3}}, .common_sd = 0.01, .own_sd = 0.001, .copies = 2}, 5);
  ASSERT_EQ(noisy.rows(), 4000);
  EXPECT_EQ(noisy.targets, clean.targets.replicate(2, 1));
  const Eigen::MatrixXd added = noisy.inputs - clean.inputs.replicate(2, 1);
  EXPECT_EQ(added.col(2), Eigen::VectorXd::Zero(4000));
  const auto sd = [&](const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / 4000); };
  // Four standard errors of a standard deviation are 4 / sqrt(2 x 4000) = 4.5 %.
  EXPECT_NEAR(sd(added.col(0)), std::hypot(0.01, 0.001), 0.045 * 0.01);
  EXPECT_NEAR(sd(added.col(1) - added.col(0)), 0.001 * std::sqrt(2), 0.045 * 0.0015);
  EXPECT_LT(std::abs(added.col(0).dot(added.col(3))) / 4000, 4 * 1e-4 / std::sqrt(4000));
  EXPECT_NE(added.topRows(2000), added.bottomRows(2000));
}

TEST(Scaling, MakesMeanZeroAndDeviationOneButOfAConstant) {
  Eigen::MatrixXd values(4, 2);
  values << 1, 7, 3, 7, 5, 7, 7, 7;
  const Scaling scaling = Scaling::Of(values);
  const Eigen::MatrixXd scaled = scaling.Apply(values);
  EXPECT_NEAR(scaled.col(0).mean(), 0, 1e-15);
  EXPECT_NEAR(scaled.col(0).squaredNorm() / 4, 1, 1e-12);
  EXPECT_EQ(scaled.col(1), Eigen::Vector4d::Zero());
  EXPECT_TRUE(scaled.allFinite());
}

}  // namespace
}  // namespace footing::learning
