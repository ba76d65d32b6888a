#include "daemon/offline/learning/mlp.h"

#include <gtest/gtest.h>

#include "tests/offline/learning/problems.h"

namespace footing::learning {
namespace {

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
