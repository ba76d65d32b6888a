#include "daemon/offline/learning/pose_regression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/edit.h"

namespace footing::learning {
namespace {

constexpr std::array<double, 6> kRidges{0.003, 0.01, 0.03, 0.1, 0.3, 1.0};
constexpr double kLeastSpread = 1e-6;  // An input below this never changes.
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

/// Weighted root mean square of errors, a column an example.
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

namespace {

/// People weigh the same, each frame of one person as much as another, and all of them together as
/// their frames are.
Eigen::VectorXd EqualWeights(const std::vector<int>& people) {
  std::map<int, double> frames;
  for (const int person : people) ++frames[person];
  const double own = frames.count(PoseExamples::kOwn) > 0 ? frames[PoseExamples::kOwn] : 0;
  const double others = static_cast<double>(frames.size()) - (own > 0 ? 1 : 0);
  const double each = (static_cast<double>(people.size()) - own) / std::max(others, 1.0);
  Eigen::VectorXd weights(static_cast<Eigen::Index>(people.size()));
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    const int person = people[static_cast<std::size_t>(i)];
    weights(i) = person == PoseExamples::kOwn ? 1 : each / frames[person];
  }
  return weights;
}

}  // namespace

void PoseExamples::Add(const reconstruction::Reconstruction& made, PoseCues cues,
                       const Eigen::VectorXd& q, int fold, int person) {
  const body::Body& body = made.body();
  Eigen::VectorXd pose =
      motion::NearestPose(body.skeleton, q, Eigen::VectorXd::Zero(body.skeleton.dof));
  const bool posture = cues == PoseCues::kPosture;
  const Eigen::Vector3d from_m =
      posture ? made.posture().middle_W_m() : made.output().momentum.p_WC_m;
  pose.head<3>() = (pose.head<3>() - from_m) / body::TPose(body.skeleton, body.landmarks)(2);
  features.push_back(posture ? made.posture().features().values() : made.features().values());
  poses.push_back(std::move(pose));
  folds.push_back(fold);
  people.push_back(person);
}

void PoseExamples::Append(const PoseExamples& other) {
  features.insert(features.end(), other.features.begin(), other.features.end());
  poses.insert(poses.end(), other.poses.begin(), other.poses.end());
  folds.insert(folds.end(), other.folds.begin(), other.folds.end());
  people.insert(people.end(), other.people.begin(), other.people.end());
}

FittedPoseRegression FitPoseRegression(const PoseExamples& examples, const Eigen::VectorXd& scale,
                                       const RandomWaves& waves) {
  FOOTING_CHECK(!examples.poses.empty() && examples.features.size() == examples.poses.size() &&
                examples.folds.size() == examples.poses.size() &&
                examples.people.size() == examples.poses.size());
  const auto count = static_cast<Eigen::Index>(examples.poses.size());
  Eigen::MatrixXd x(reconstruction::Features::kCount, count);
  Eigen::MatrixXd y(examples.poses.front().size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    x.col(i) = examples.features[static_cast<std::size_t>(i)];
    y.col(i) = examples.poses[static_cast<std::size_t>(i)];
  }
  const Eigen::VectorXd weights = EqualWeights(examples.people);
  const int folds = 1 + *std::max_element(examples.folds.begin(), examples.folds.end());
  const RidgeFit fit =
      FitRidge(std::move(x), std::move(y), examples.folds, folds, scale, waves, weights);
  FittedPoseRegression fitted;
  fitted.spread = fit.spread;
  fitted.error = fit.error;
  fitted.ridge = fit.ridge;
  const Eigen::MatrixXd covariance =
      fit.errors * weights.asDiagonal() * fit.errors.transpose() / weights.sum();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  fitted.rest_variances = solver.eigenvalues().reverse().cwiseMax(0);
  fitted.rest_components = solver.eigenvectors().rowwise().reverse().transpose();
  fitted.regression = {fit.mean,
                       fit.scale,
                       fit.weights,
                       fit.offset,
                       reconstruction::StripMatrix(fit.waves.cast<float>()),
                       fit.phases.cast<float>(),
                       reconstruction::StripMatrix(fit.wave_weights.cast<float>())};
  return fitted;
}

void AppendTensors(const FittedPoseRegression& fitted, model::Model& model,
                   const std::string& prefix) {
  const auto add = [&](const std::string& name, const Eigen::MatrixXd& rows) {
    std::vector<std::uint32_t> shape{static_cast<std::uint32_t>(rows.rows())};
    if (rows.cols() > 1) shape.push_back(static_cast<std::uint32_t>(rows.cols()));
    model.tensors.push_back(
        {.name = prefix + name, .shape = shape, .values = ToFloats(rows.transpose())});
  };
  add("feature_mean", fitted.regression.mean);
  add("feature_scale", fitted.regression.scale);
  add("regression_weights", fitted.regression.weights);
  add("regression_offset", fitted.regression.offset);
  if (fitted.regression.phases.size() > 0) {
    add("waves", fitted.regression.waves.Dense().cast<double>());
    add("wave_phases", fitted.regression.phases.cast<double>());
    add("wave_weights", fitted.regression.wave_weights.Dense().cast<double>());
  }
  add("rest_components", fitted.rest_components);
  add("rest_variances", fitted.rest_variances);
}

FittedArm FitArm(const ArmExamples& examples) {
  FOOTING_CHECK(!examples.features.empty() && examples.fold_count >= 2 &&
                examples.features.size() == examples.directions.size());
  const auto count = static_cast<Eigen::Index>(examples.features.size());
  Eigen::MatrixXd x(arms::ArmFeatures::kCount, count), y(arms::kDirections, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    x.col(i) = examples.features[static_cast<std::size_t>(i)];
    y.col(i) = examples.directions[static_cast<std::size_t>(i)];
  }
  RidgeFit fit = FitRidge(std::move(x), std::move(y), examples.folds, examples.fold_count,
                          Eigen::VectorXd::Ones(arms::kDirections));
  FittedArm fitted;
  fitted.ridge = fit.ridge;
  fitted.error = fit.error;
  fitted.spread = fit.spread;
  fitted.model = {fit.mean, fit.scale, std::move(fit.weights), fit.offset,
                  fit.errors * fit.errors.transpose() / static_cast<double>(count)};
  return fitted;
}

void AppendTensors(const arms::ArmModel& fitted, model::Model& model) {
  const auto add = [&model](const char* name, const Eigen::MatrixXd& rows) {
    std::vector<std::uint32_t> shape{static_cast<std::uint32_t>(rows.rows())};
    if (rows.cols() > 1) shape.push_back(static_cast<std::uint32_t>(rows.cols()));
    model.tensors.push_back({.name = name, .shape = shape, .values = ToFloats(rows.transpose())});
  };
  add("feature_mean", fitted.mean);
  add("feature_scale", fitted.scale);
  add("regression_weights", fitted.weights);
  add("regression_offset", fitted.offset);
  add("error_covariance", fitted.covariance);
}

Scaling Scaling::Of(const Eigen::MatrixXd& values) {
  const auto rows = static_cast<double>(values.rows());
  Scaling scaling{.mean = values.colwise().mean(), .scale = {}};
  const Eigen::RowVectorXd sd =
      ((values.rowwise() - scaling.mean).colwise().squaredNorm() / rows).cwiseSqrt();
  // Below this a column varies by rounding alone.
  const Eigen::RowVectorXd least = 1e-12 * (1 + scaling.mean.array().abs());
  scaling.scale = (sd.array() > least.array()).select(sd.cwiseInverse(), 0);
  return scaling;
}

Scaling Scaling::None(Eigen::Index columns) {
  return {.mean = Eigen::RowVectorXd::Zero(columns), .scale = Eigen::RowVectorXd::Ones(columns)};
}

Eigen::MatrixXd Scaling::Apply(const Eigen::MatrixXd& values) const {
  return ((values.rowwise() - mean).array().rowwise() * scale.array()).matrix();
}

std::vector<float> ToFloats(const Eigen::MatrixXd& values) {
  const Eigen::MatrixXf floats = values.cast<float>();
  return {floats.data(), floats.data() + floats.size()};
}

namespace {

constexpr double kRadiansOfMetre = 2.5;

}  // namespace

int PoseBasis::ComponentsFor(double fraction) const {
  double sum = 0;
  const double enough = fraction * variances.sum();
  for (int k = 0; k < variances.size(); ++k) {
    sum += variances(k);
    if (sum >= enough) return k + 1;
  }
  return static_cast<int>(variances.size());
}

PoseBasis MakeBasis(const Eigen::MatrixXd& poses, std::vector<std::string> dofs) {
  FOOTING_CHECK(poses.cols() > 0 && poses.rows() == static_cast<Eigen::Index>(dofs.size()));
  PoseBasis basis{.dofs = std::move(dofs),
                  .mean = poses.rowwise().mean(),
                  .scale = Eigen::VectorXd::Ones(poses.rows()),
                  .components = {},
                  .variances = {}};
  basis.scale.head(3).setConstant(kRadiansOfMetre);  // The root's position.
  const Eigen::MatrixXd scaled =
      ((poses.colwise() - basis.mean).array().colwise() * basis.scale.array()).matrix();
  const Eigen::MatrixXd covariance =
      scaled * scaled.transpose() / static_cast<double>(poses.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  FOOTING_CHECK(solver.info() == Eigen::Success);
  basis.variances = solver.eigenvalues().reverse().cwiseMax(0);
  basis.components = solver.eigenvectors().rowwise().reverse().transpose();
  for (Eigen::Index k = 0; k < basis.components.rows(); ++k) {
    Eigen::Index greatest = 0;
    basis.components.row(k).cwiseAbs().maxCoeff(&greatest);
    if (basis.components(k, greatest) < 0) basis.components.row(k) *= -1;
  }
  return basis;
}

void AppendTensors(const PoseBasis& basis, model::Model& model) {
  const auto dof = static_cast<std::uint32_t>(basis.mean.size());
  const auto add = [&](const char* name, std::vector<std::uint32_t> shape,
                       const Eigen::MatrixXd& values, std::vector<std::string> labels) {
    model.tensors.push_back({.name = name,
                             .shape = std::move(shape),
                             .values = ToFloats(values),
                             .labels = std::move(labels)});
  };
  add("mean", {dof}, basis.mean, basis.dofs);
  add("scale", {dof}, basis.scale, basis.dofs);
  add("components", {dof, dof}, basis.components.transpose(), basis.dofs);
  add("variances", {dof}, basis.variances, {});
}

}  // namespace footing::learning
