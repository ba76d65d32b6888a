#include <cmath>

#include <gtest/gtest.h>

#include "daemon/offline/learning/candidates.h"
#include "daemon/offline/learning/cascade.h"
#include "tests/offline/learning/problems.h"

namespace footing::learning {
namespace {

Eigen::MatrixXd Drawn(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  noise::Random random(seed);
  Eigen::MatrixXd values(rows, columns);
  for (double& value : values.reshaped()) value = random.Uniform(-1, 1);
  return values;
}

void ExpectTrueGradient(const CandidateTask<double>& task) {
  const Eigen::MatrixXd weights = 3 * Drawn(5, 4, 3);
  const Eigen::MatrixXd gradient = ScoreGradient(task, Score(task, weights));
  constexpr double kStep = 1e-6;
  for (Eigen::Index c = 0; c < weights.cols(); ++c) {
    for (Eigen::Index i = 0; i < weights.rows(); ++i) {
      Eigen::MatrixXd more = weights, less = weights;
      more(i, c) += kStep;
      less(i, c) -= kStep;
      const double expected =
          (Score(task, more).scores(c) - Score(task, less).scores(c)) / (2 * kStep);
      EXPECT_NEAR(gradient(i, c), expected, 1e-7) << i << " " << c;
    }
  }
}

// 300 rows: more than the block in which the products are made.
TEST(Candidates, GradientOfCovarianceIsThatOfFiniteDifferences) {
  const Eigen::MatrixXd units = Drawn(300, 5, 1);
  ExpectTrueGradient(CandidateTask<double>::Covariance(units, Drawn(300, 2, 2)));
}

TEST(Candidates, GradientOfErrorReductionIsThatOfFiniteDifferences) {
  const Eigen::MatrixXd units = Drawn(300, 5, 1);
  LeastSquares solver(Drawn(300, 2, 2), 5);
  for (Eigen::Index i = 0; i < 5; ++i) solver.Add(units.col(i));
  ExpectTrueGradient(CandidateTask<double>::ErrorReduction(units, solver.errors(), solver.basis()));
}

TEST(Candidates, CovarianceAndItsGradientAreTheSameInSinglePrecision) {
  const Eigen::MatrixXd units = Drawn(300, 5, 1), errors = Drawn(300, 2, 2);
  const Eigen::MatrixXd weights = 3 * Drawn(5, 4, 3);
  const auto twice = CandidateTask<double>::Covariance(units, errors);
  const auto once = CandidateTask<float>::Covariance(units, errors);
  const Scores<double> expected = Score(twice, weights);
  const Scores<float> scores = Score(once, weights);
  EXPECT_TRUE(scores.scores.cast<double>().isApprox(expected.scores, 1e-5));
  EXPECT_TRUE(ScoreGradient(once, scores).isApprox(ScoreGradient(twice, expected), 1e-5));
}

TEST(Candidates, CovarianceIsTheSumOverOutputs) {
  constexpr int kRows = 50;
  const Eigen::MatrixXd units = Drawn(kRows, 3, 4);
  const Eigen::MatrixXd errors = Drawn(kRows, 2, 5);
  const Eigen::MatrixXd weights = Drawn(3, 1, 6);
  double expected = 0, square = 0;
  for (Eigen::Index o = 0; o < 2; ++o) {
    const double mean = errors.col(o).mean();
    double covariance = 0;
    for (int p = 0; p < kRows; ++p) {
      const double value = 1 / (1 + std::exp(-units.row(p).dot(weights.col(0)))) - 0.5;
      covariance += value * (errors(p, o) - mean);
      square += (errors(p, o) - mean) * (errors(p, o) - mean);
    }
    expected += std::abs(covariance);
  }
  expected /= kRows * std::sqrt(square / (2 * kRows));
  const CandidateTask<double> task = CandidateTask<double>::Covariance(units, errors);
  EXPECT_NEAR(Score(task, weights).scores(0), expected, 1e-12);
}

TEST(Candidates, ErrorReductionIsWhatOutputsSolvedAnewLose) {
  const Eigen::MatrixXd units = Drawn(200, 4, 4);
  LeastSquares solver(Drawn(200, 2, 5), 5);
  for (Eigen::Index i = 0; i < 4; ++i) solver.Add(units.col(i));
  const CandidateTask<double> task =
      CandidateTask<double>::ErrorReduction(units, solver.errors(), solver.basis());
  const Scores<double> scores = Score(task, 4 * Drawn(4, 1, 6));
  const double before = solver.errors().squaredNorm();
  solver.Add(scores.values.col(0));
  const double lost = 1 - solver.errors().squaredNorm() / before;
  // The little more of a unit's size is 3e-3^2 of about 0.1^2.
  EXPECT_NEAR(scores.scores(0) * scores.scores(0), lost, 2e-3 * lost);
}

TEST(Candidates, TrainingFindsAUnitThatTheErrorIsMadeOf) {
  Eigen::MatrixXd units = Drawn(400, 4, 7);
  units.col(0).setOnes();
  const Eigen::Vector4d truth(0.2, 3, -2, 4);
  LeastSquares solver(Sigmoid((units * truth).array()).matrix(), 5);
  for (Eigen::Index i = 0; i < 4; ++i) solver.Add(units.col(i));
  const double before = solver.errors().squaredNorm();
  noise::Random random(8);
  const NewUnit unit = TrainCandidates(
      CandidateTask<double>::ErrorReduction(units, solver.errors(), solver.basis()), {}, random);
  EXPECT_EQ(unit.values, Sigmoid((units * unit.weights).array()).matrix());
  EXPECT_GT(unit.epochs, 8);
  solver.Add(unit.values);
  EXPECT_LT(solver.errors().squaredNorm(), 0.05 * before);
}

TEST(Candidates, CovarianceChangesNeitherWithTheErrorsSizeNorWithRowsRepeated) {
  const Eigen::MatrixXd units = Drawn(64, 3, 9), twice = units.replicate(2, 1);
  const Eigen::MatrixXd error = Drawn(64, 1, 10);
  noise::Random first(11), second(11);
  const NewUnit once = TrainCandidates(CandidateTask<double>::Covariance(units, error), {}, first);
  const NewUnit scaled = TrainCandidates(
      CandidateTask<double>::Covariance(twice, 1024 * error.replicate(2, 1)), {}, second);
  EXPECT_EQ(once.epochs, scaled.epochs);
  EXPECT_TRUE(once.weights.isApprox(scaled.weights, 1e-6));
}

Eigen::MatrixXd One(double value) { return Eigen::MatrixXd::Constant(1, 1, value); }

TEST(Quickprop, JumpsToTheLowestPointOfAParabola) {
  // GIVEN f = 2 (w - 3)^2, slope 4 (w - 3), and a first step by the slope alone.
  Quickprop quickprop(1, 1, {.epsilon = 0.4, .growth = 2, .decay = 0});
  Eigen::MatrixXd w = One(0);
  quickprop.Step(One(4 * (0 - 3.0)), w);
  EXPECT_DOUBLE_EQ(w(0), 4.8);  // 0.4 * 12: beyond the lowest point.
  // WHEN the slope has changed its sign, THEN the parabola through both slopes is followed alone.
  quickprop.Step(One(4 * (4.8 - 3)), w);
  EXPECT_NEAR(w(0), 3, 1e-12);
}

TEST(Quickprop, GrowsAStepByAtMostItsFactor) {
  Quickprop quickprop(1, 1, {.epsilon = 1, .growth = 1.75, .decay = 0});
  Eigen::MatrixXd w = One(0);
  quickprop.Step(One(-1), w);
  EXPECT_DOUBLE_EQ(w(0), 1);
  quickprop.Step(One(-0.99), w);  // Nearly as steep: the parabola's lowest point is 99 away.
  EXPECT_DOUBLE_EQ(w(0), 1 + 0.99 + 1.75 * 1);
}

TEST(Quickprop, StaysFiniteOnEqualSlopesAndOnNone) {
  Quickprop quickprop(1, 1, {.epsilon = 1, .growth = 2, .decay = 0});
  Eigen::MatrixXd w = One(1);
  for (const double slope : {1.0, 1.0, 1.0, 0.0, 0.0, -1.0, -1.0, 1e-300, 1e-300}) {
    quickprop.Step(One(slope), w);
    ASSERT_TRUE(std::isfinite(w(0)));
  }
}

TEST(Quickprop, DecayPullsAWeightToZero) {
  Quickprop quickprop(1, 1, {.epsilon = 0.1, .growth = 2, .decay = 0.5});
  Eigen::MatrixXd w = One(8);
  quickprop.Step(One(0), w);
  EXPECT_DOUBLE_EQ(w(0), 8 - 0.1 * 0.5 * 8);
}

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
