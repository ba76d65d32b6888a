#include "daemon/offline/learning/sigmoid_outputs.h"

#include <gtest/gtest.h>

#include "tests/offline/learning/problems.h"

namespace footing::learning {
namespace {

TEST(SigmoidOutputs, LearnWhatALineDivides) {
  Eigen::MatrixXd units(5, 3);
  units << 1, 0, 0, 1, 0, 1, 1, 1, 0, 1, 1, 1, 1, 2, 3;
  Eigen::MatrixXd targets(5, 1);
  targets << -0.5, -0.5, -0.5, 0.5, 0.5;  // x + y > 1.5
  SigmoidOutputs layer{.weights = Eigen::MatrixXd::Zero(3, 1), .values = {}, .errors = {}};
  OutputOptions options;
  options.quickprop.epsilon = 10;
  EXPECT_LT(layer.Train(units, targets, 0.4, options), options.epochs_max);
  EXPECT_LT(layer.Worst(targets), 0.4);
}

TEST(SigmoidOutputs, GiveUpWhereNothingChanges) {
  const Examples exclusive_or = Parity(2);
  Eigen::MatrixXd units(4, 3);
  units << Eigen::Vector4d::Ones(), exclusive_or.inputs;
  SigmoidOutputs layer{.weights = Eigen::MatrixXd::Zero(3, 1), .values = {}, .errors = {}};
  OutputOptions options;
  EXPECT_LE(layer.Train(units, exclusive_or.targets, 0.4, options), options.patience + 1);
  EXPECT_NEAR(layer.Worst(exclusive_or.targets), 0.5, 1e-9);
}

TEST(SigmoidOutputs, ErrorsAreTheSlopesOfTheSquaredErrorButForTheOffset) {
  // d/dx of (s(x) - t)^2 / 2 is (s - t) s', by finite differences.
  constexpr double kX = 0.7, kTarget = 0.5, kStep = 1e-6;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1), target = kTarget * one;
  const auto half_square = [&](double x) {
    SigmoidOutputs layer{.weights = x * one, .values = {}, .errors = {}};
    layer.Evaluate(one, target);
    return 0.5 * (layer.values - target).squaredNorm();
  };
  SigmoidOutputs layer{.weights = kX * one, .values = {}, .errors = {}};
  layer.Evaluate(one, target);
  const double slope = (half_square(kX + kStep) - half_square(kX - kStep)) / (2 * kStep);
  EXPECT_NEAR(layer.errors(0), slope + 0.1 * (layer.values(0) - kTarget), 1e-8);
}

}  // namespace
}  // namespace footing::learning
