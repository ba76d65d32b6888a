#include "daemon/offline/learning/cascade.h"

#include <gtest/gtest.h>

#include <array>

#include "daemon/offline/learning/mlp.h"
#include "daemon/offline/learning/pose_regression.h"
#include "tests/offline/learning/problems.h"

namespace footing::learning {
namespace {

Examples None(const Examples& like) {
  return {.inputs = Eigen::MatrixXd(0, like.inputs.cols()),
          .targets = Eigen::MatrixXd(0, like.targets.cols())};
}

/// Part of the rows whose output has the target's sign.
double PartRight(const cascade::CascadeNetwork& network, const Examples& examples) {
  int right = 0;
  std::vector<float> inputs(static_cast<std::size_t>(examples.inputs.cols()));
  std::array<float, 1> output;
  for (Eigen::Index row = 0; row < examples.rows(); ++row) {
    Eigen::RowVectorXf::Map(inputs.data(), examples.inputs.cols()) =
        examples.inputs.row(row).cast<float>();
    network.Evaluate(inputs, output);
    right += output[0] * examples.targets(row, 0) > 0 ? 1 : 0;
  }
  return right / static_cast<double>(examples.rows());
}

CascadeOptions Classify() {
  CascadeOptions options;
  options.outputs = Outputs::kSigmoid;
  options.hidden_max = 40;
  return options;
}

bool SameBits(const cascade::NetworkWeights& a, const cascade::NetworkWeights& b) {
  return a.hidden == b.hidden && a.hidden_weights == b.hidden_weights &&
         a.output_weights == b.output_weights && a.input_mean == b.input_mean;
}

TEST(TrainCascade, SolvesTheTwoSpiralsWithAsManyUnitsAsFahlmanAndLebiere) {
  // 1990, section 3.1: 100 of 100 trials, 12 to 19 hidden units, 15.2 on average, 1700 epochs.
  const Examples spirals = TwoSpirals(), between = TwoSpirals(4);
#ifdef FOOTING_SANITIZED
  constexpr int kTrials = 2;  // Ten take minutes there.
#else
  constexpr int kTrials = 10;
#endif
  double hidden = 0, epochs = 0, right = 0;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    const CascadeResult result = TrainCascade(spirals, None(spirals), Classify(), seed);
    EXPECT_TRUE(result.goal_reached) << seed;
    EXPECT_EQ(PartRight(result.network, spirals), 1) << seed;
    hidden += result.hidden_units;
    epochs += result.epochs;
    right += PartRight(result.network, between);
  }
  EXPECT_GE(hidden / kTrials, 12);
  EXPECT_LE(hidden / kTrials, 17);
  EXPECT_LE(epochs / kTrials, 2000);
  EXPECT_GE(right / kTrials, 0.88) << "between the points it was taught";
}

TEST(TrainCascade, SolvesParityOfEightBits) {
  // Section 3.2 of the same: 4 to 5 hidden units.
  const Examples parity = Parity(8);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const CascadeResult result = TrainCascade(parity, None(parity), Classify(), seed);
    EXPECT_TRUE(result.goal_reached);
    EXPECT_LE(result.hidden_units, 9) << seed;
    EXPECT_EQ(PartRight(result.network, parity), 1) << seed;
  }
}

TEST(TrainCascade, LearnsACurvedFunctionDownToItsNoise) {
  const Examples train = Curved(1500, 0.02, 1), validation = Curved(500, 0.02, 2);
  const CascadeResult result = TrainCascade(train, validation, {}, 3);
  // The noise is 0.02^2 = 4e-4; the best linear function leaves far more.
  EXPECT_LT(result.validation_mse, 2 * 4e-4);
  CascadeOptions linear;
  linear.hidden_max = 0;
  EXPECT_GT(TrainCascade(train, validation, linear, 3).validation_mse, 0.01);
  // Fresh rows that chose nothing.
  EXPECT_LT(MeanSquaredError(result.network, Curved(500, 0.02, 4)), 2 * 4e-4);
}

TEST(TrainCascade, GivesTheSameBitsForTheSameSeedAndOthersForAnother) {
  const Examples train = Curved(300, 0.01, 1), validation = Curved(100, 0.01, 2);
  CascadeOptions options;
  options.hidden_max = 6;
  const auto a = TrainCascade(train, validation, options, 7);
  const auto b = TrainCascade(train, validation, options, 7);
  const auto c = TrainCascade(train, validation, options, 8);
  EXPECT_TRUE(SameBits(a.network.weights(), b.network.weights()));
  EXPECT_FALSE(SameBits(a.network.weights(), c.network.weights()));
}

TEST(TrainCascade, StopsWhereValidationGetsNoBetter) {
  // Only noise to learn: what follows it in training is worth nothing in validation.
  Examples train = Curved(60, 0, 1), validation = Curved(60, 0, 2);
  noise::Random random(3);
  for (double& target : train.targets.reshaped()) target = random.Normal();
  for (double& target : validation.targets.reshaped()) target = random.Normal();
  const CascadeResult result = TrainCascade(train, validation, {}, 4);
  EXPECT_LE(result.hidden_units, 8);
  EXPECT_LT(result.validation_mse, 2);
}

TEST(TrainCascade, KeepsTheFewestUnitsThatAreAskedFor) {
  Examples train = Curved(60, 0, 1), validation = Curved(60, 0, 2);
  noise::Random random(3);
  for (double& target : train.targets.reshaped()) target = random.Normal();
  for (double& target : validation.targets.reshaped()) target = random.Normal();
  CascadeOptions options;
  const int chosen = TrainCascade(train, validation, options, 4).hidden_units;
  options.hidden_min = chosen + 2;
  EXPECT_GE(TrainCascade(train, validation, options, 4).hidden_units, chosen + 2);
  options.hidden_min = options.hidden_max = 3;
  EXPECT_EQ(TrainCascade(train, validation, options, 4).hidden_units, 3);
}

TEST(TrainCascade, StopsAtItsGoal) {
  const Examples train = Curved(500, 0, 1);
  CascadeOptions options;
  options.mse_goal = 0.01;
  const CascadeResult result = TrainCascade(train, None(train), options, 1);
  EXPECT_TRUE(result.goal_reached);
  EXPECT_LE(result.train_mse, 0.01 * 1.001);
  EXPECT_GE(result.hidden_units, 1);
}

TEST(TrainCascade, SurvivesConstantInputsAndTargets) {
  Examples train = Curved(50, 0, 1);
  train.inputs.col(1).setConstant(4);
  train.targets.setConstant(-3);
  CascadeOptions options;
  options.hidden_max = 3;
  const CascadeResult result = TrainCascade(train, None(train), options, 1);
  EXPECT_NEAR(result.train_mse, 0, 1e-10);
}

TEST(TrainCascade, LearnsSeveralOutputsAtOnce) {
  Examples train = Curved(800, 0, 1), other = Curved(800, 0, 5);
  Examples both{.inputs = train.inputs, .targets = Eigen::MatrixXd(800, 2)};
  both.targets << train.targets, 100 * train.inputs.col(0).cwiseProduct(train.inputs.col(1));
  const CascadeResult result = TrainCascade(both, None(both), {}, 2);
  Examples fresh{.inputs = other.inputs, .targets = Eigen::MatrixXd(800, 2)};
  fresh.targets << other.targets, 100 * other.inputs.col(0).cwiseProduct(other.inputs.col(1));
  // 100 a b has a variance of 1e4 / 9.
  EXPECT_LT(MeanSquaredError(result.network, fresh), 0.02 * 1e4 / 9);
}

}  // namespace
}  // namespace footing::learning
