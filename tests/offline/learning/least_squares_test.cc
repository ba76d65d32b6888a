#include "daemon/offline/learning/cascade.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "common/virtual/devices/noise.h"

namespace footing::learning {
namespace {

Eigen::MatrixXd LeastSquaresDrawn(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  noise::Random random(seed);
  Eigen::MatrixXd values(rows, columns);
  for (double& value : values.reshaped()) value = random.Normal();
  return values;
}

TEST(LeastSquares, AgreesWithHouseholdersAfterEveryColumn) {
  const Eigen::MatrixXd columns = LeastSquaresDrawn(60, 6, 1);
  const Eigen::MatrixXd targets = LeastSquaresDrawn(60, 2, 2);
  LeastSquares solver(targets, 6);
  for (Eigen::Index count = 1; count <= 6; ++count) {
    solver.Add(columns.col(count - 1));
    const Eigen::MatrixXd some = columns.leftCols(count);
    const Eigen::MatrixXd expected = some.householderQr().solve(targets);
    EXPECT_TRUE(solver.Weights().isApprox(expected, 1e-10)) << count;
    EXPECT_TRUE(solver.errors().isApprox(some * expected - targets, 1e-10)) << count;
  }
}

TEST(LeastSquares, TellsColumnsApartThatDifferByAMillionth) {
  const Eigen::VectorXd a = LeastSquaresDrawn(80, 1, 3);
  const Eigen::VectorXd b = a + 1e-6 * LeastSquaresDrawn(80, 1, 4);
  LeastSquares solver(2 * a - 5 * b, 2);
  solver.Add(a);
  solver.Add(b);
  EXPECT_TRUE(solver.Weights().isApprox(Eigen::Vector2d(2, -5), 1e-6)) << solver.Weights();
}

TEST(LeastSquares, AColumnThatTheOthersExplainGetsNoWeight) {
  const Eigen::MatrixXd columns = LeastSquaresDrawn(40, 2, 5);
  LeastSquares solver(columns.col(0) - columns.col(1), 4);
  solver.Add(columns.col(0));
  solver.Add(columns.col(0) * 3);
  solver.Add(Eigen::VectorXd::Zero(40));
  solver.Add(columns.col(1));
  EXPECT_TRUE(solver.Weights().isApprox(Eigen::Vector4d(1, 0, 0, -1), 1e-10));
}

}  // namespace
}  // namespace footing::learning
