#include <gtest/gtest.h>

#include "daemon/offline/learning/mlp.h"
#include "daemon/offline/learning/pose_regression.h"
#include "tests/offline/learning/problems.h"

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

TEST(Mlp, GradientIsThatOfFiniteDifferences) {
  const Examples examples = Curved(40, 0, 1);
  MlpOptions options;
  options.hidden = 4;
  options.epochs_max = 2;
  const Mlp network = TrainMlp(examples, {}, options, 1).network;
  const Eigen::MatrixXd inputs = network.input_scaling.Apply(examples.inputs);
  const Eigen::MatrixXd targets = network.output_scaling.Apply(examples.targets);
  const MlpGradient gradient = Gradient(network, inputs, targets);
  constexpr double kStep = 1e-6;
  const auto check = [&](Eigen::MatrixXd Mlp::*layer, const Eigen::MatrixXd& slopes) {
    for (Eigen::Index i = 0; i < slopes.size(); ++i) {
      Mlp more = network, less = network;
      (more.*layer).data()[i] += kStep;
      (less.*layer).data()[i] -= kStep;
      const double expected =
          (Gradient(more, inputs, targets).error - Gradient(less, inputs, targets).error) /
          (2 * kStep);
      EXPECT_NEAR(slopes.data()[i], expected, 1e-8) << i;
    }
  };
  check(&Mlp::hidden_weights, gradient.hidden_weights);
  check(&Mlp::output_weights, gradient.output_weights);
}

TEST(TrainMlp, LearnsACurvedFunction) {
  const Examples train = Curved(800, 0, 1), validation = Curved(200, 0, 2);
  MlpOptions options;
  options.epochs_max = 150;
  const MlpResult result = TrainMlp(train, validation, options, 1);
  EXPECT_LT(MeanSquaredError(result.network, Curved(300, 0, 3)), 0.003);
  EXPECT_EQ(MeanSquaredError(result.network, validation), result.validation_mse);
}

TEST(TrainMlp, StopsAtItsGoalAndRepeatsItsBits) {
  const Examples train = Curved(300, 0, 1), validation = Curved(100, 0, 2);
  MlpOptions options;
  options.mse_goal = 0.05;
  const MlpResult a = TrainMlp(train, validation, options, 4);
  const MlpResult b = TrainMlp(train, validation, options, 4);
  EXPECT_TRUE(a.goal_reached);
  EXPECT_LT(a.epochs, options.epochs_max);
  EXPECT_LE(a.validation_mse, 0.05);
  EXPECT_EQ(a.network.hidden_weights, b.network.hidden_weights);
  EXPECT_EQ(a.network.output_weights, b.network.output_weights);
}

}  // namespace
}  // namespace footing::learning
