#include "daemon/offline/learning/ridge.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/virtual/devices/random.h"

namespace footing::learning {
namespace {

constexpr std::array<double, 6> kRidges{0.003, 0.01, 0.03, 0.1, 0.3, 1.0};
constexpr double kLeastSpread = 1e-6;  // Of an input that never changes.
constexpr double kMostScaled = 4;

/// Scaled inputs and centred outputs, a column an example, with the sums that ridge regression
/// needs.
struct Prepared {
  Eigen::MatrixXd x, y;
  std::vector<int> folds;
  Eigen::VectorXd weights;
  std::vector<Eigen::MatrixXd> xx, xy;  ///< A fold each.
  std::vector<double> examples;

  int fold_count() const { return static_cast<int>(xx.size()); }
};

void Sum(Prepared& p, int fold_count) {
  for (int fold = 0; fold < fold_count; ++fold) {
    std::vector<Eigen::Index> examples;
    for (Eigen::Index i = 0; i < p.x.cols(); ++i) {
      if (p.folds[static_cast<std::size_t>(i)] == fold) examples.push_back(i);
    }
    const Eigen::MatrixXd x = p.x(Eigen::all, examples);
    const Eigen::VectorXd weights = p.weights(examples);
    const Eigen::MatrixXd weighted = (x * weights.asDiagonal()).transpose();
    p.xx.emplace_back(x * weighted);
    p.xy.emplace_back(weighted.transpose() * p.y(Eigen::all, examples).transpose());
    p.examples.push_back(weights.sum());
  }
}

Eigen::VectorXd MeanOf(const Eigen::MatrixXd& columns, const Eigen::VectorXd& weights) {
  return columns * weights / weights.sum();
}

/// Of errors, a column an example.
double RootMeanSquare(const Eigen::MatrixXd& errors, const Eigen::VectorXd& weights) {
  return std::sqrt(errors.colwise().squaredNorm().dot(weights) / weights.sum());
}

/// Appends them to the scaled inputs, about their mean. Returns the mean.
Eigen::VectorXd AddWaves(const RandomWaves& config, Prepared& p, RidgeFit& fit) {
  noise::Random random(config.seed);
  const Eigen::Index inputs = p.x.rows();
  fit.waves.resize(config.count, inputs);
  fit.phases.resize(config.count);
  const double sd = 1 / (config.kernel_width * std::sqrt(static_cast<double>(inputs)));
  for (double& value : fit.waves.reshaped()) value = sd * random.Normal();
  for (double& value : fit.phases) value = random.Uniform(0, 2 * kPi);
  const Eigen::MatrixXd waved = ((fit.waves * p.x).colwise() + fit.phases).array().cos().matrix();
  const Eigen::VectorXd mean = MeanOf(waved, p.weights);
  p.x.conservativeResize(inputs + config.count, Eigen::NoChange);
  p.x.bottomRows(config.count) = waved.colwise() - mean;
  return mean;
}

/// outputs x inputs, without the examples of one fold (none: -1).
Eigen::MatrixXd Solve(const Prepared& p, int without, double ridge) {
  Eigen::MatrixXd xx = Eigen::MatrixXd::Zero(p.x.rows(), p.x.rows());
  Eigen::MatrixXd xy = Eigen::MatrixXd::Zero(p.x.rows(), p.y.rows());
  double examples = 0;
  for (int fold = 0; fold < p.fold_count(); ++fold) {
    if (fold == without) continue;
    const auto index = static_cast<std::size_t>(fold);
    xx += p.xx[index];
    xy += p.xy[index];
    examples += p.examples[index];
  }
  xx.diagonal().array() += ridge * std::max(examples, 1.0);
  return xx.llt().solve(xy).transpose();
}

/// Errors on every example by the weights that have not seen it.
Eigen::MatrixXd LeftOut(const Prepared& p, double ridge) {
  std::vector<Eigen::MatrixXd> weights;
  for (int fold = 0; fold < p.fold_count(); ++fold) weights.push_back(Solve(p, fold, ridge));
  Eigen::MatrixXd errors(p.y.rows(), p.y.cols());
  for (Eigen::Index i = 0; i < p.y.cols(); ++i) {
    const auto fold = static_cast<std::size_t>(p.folds[static_cast<std::size_t>(i)]);
    errors.col(i) = p.y.col(i) - weights[fold] * p.x.col(i);
  }
  return errors;
}

}  // namespace

RidgeFit FitRidge(Eigen::MatrixXd x, Eigen::MatrixXd y, const std::vector<int>& folds,
                  int fold_count, const Eigen::VectorXd& output_scale, const RandomWaves& waves,
                  const Eigen::VectorXd& weights) {
  FOOTING_CHECK(x.cols() > 0 && x.cols() == y.cols() && fold_count > 0 &&
                folds.size() == static_cast<std::size_t>(x.cols()));
  FOOTING_CHECK(weights.size() == 0 || (weights.size() == x.cols() && weights.minCoeff() > 0));
  RidgeFit fit;
  Prepared p{std::move(x), std::move(y), folds, weights, {}, {}, {}};
  if (weights.size() == 0) p.weights = Eigen::VectorXd::Ones(p.x.cols());
  fit.mean = MeanOf(p.x, p.weights);
  p.x.colwise() -= fit.mean;
  const Eigen::VectorXd sd = MeanOf(p.x.cwiseAbs2(), p.weights).cwiseSqrt();
  fit.scale = (sd.array() > kLeastSpread).select(sd.cwiseInverse(), 0);
  p.x = (fit.scale.asDiagonal() * p.x).cwiseMax(-kMostScaled).cwiseMin(kMostScaled);
  const Eigen::VectorXd wave_mean = AddWaves(waves, p, fit);
  fit.offset = MeanOf(p.y, p.weights);
  p.y.colwise() -= fit.offset;
  Sum(p, fold_count);
  fit.spread = RootMeanSquare(output_scale.asDiagonal() * p.y, p.weights);
  fit.error = std::numeric_limits<double>::infinity();
  for (const double ridge : kRidges) {
    Eigen::MatrixXd errors = output_scale.asDiagonal() * LeftOut(p, ridge);
    const double error = RootMeanSquare(errors, p.weights);
    if (error >= fit.error) continue;
    fit.error = error;
    fit.ridge = ridge;
    fit.errors = std::move(errors);
  }
  const Eigen::MatrixXd solved = Solve(p, -1, fit.ridge);
  fit.weights = solved.leftCols(solved.cols() - waves.count);
  fit.wave_weights = solved.rightCols(waves.count);
  fit.offset -= fit.wave_weights * wave_mean;
  return fit;
}

}  // namespace footing::learning
