#include "daemon/offline/training/pose_regression.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <limits>

#include "common/result/result.h"
#include "daemon/offline/training/scaling.h"

namespace footing::training {
namespace {

constexpr std::array<double, 6> kRidges{0.003, 0.01, 0.03, 0.1, 0.3, 1.0};
constexpr double kLeastSpread = 1e-6;  // Of a feature that never changes.

/// Scaled features and poses, a column a frame, with the sums that ridge regression needs.
struct Prepared {
  Eigen::VectorXd mean, scale, offset;
  Eigen::MatrixXd x, y;
  std::vector<Eigen::MatrixXd> xx, xy;  ///< A fold each.
  std::vector<double> frames;
};

Prepared Prepare(const PoseExamples& examples) {
  Prepared p;
  const auto count = static_cast<Eigen::Index>(examples.poses.size());
  p.x.resize(reconstruction::Features::kCount, count);
  p.y.resize(examples.poses.front().size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    p.x.col(i) = examples.features[static_cast<std::size_t>(i)];
    p.y.col(i) = examples.poses[static_cast<std::size_t>(i)];
  }
  p.mean = p.x.rowwise().mean();
  p.x.colwise() -= p.mean;
  const Eigen::VectorXd sd = (p.x.rowwise().squaredNorm() / static_cast<double>(count)).cwiseSqrt();
  p.scale = (sd.array() > kLeastSpread).select(sd.cwiseInverse(), 0);
  p.x = (p.scale.asDiagonal() * p.x).cwiseMax(-4).cwiseMin(4);
  p.offset = p.y.rowwise().mean();
  p.y.colwise() -= p.offset;
  for (int fold = 0; fold < kFolds; ++fold) {
    p.xx.emplace_back(Eigen::MatrixXd::Zero(p.x.rows(), p.x.rows()));
    p.xy.emplace_back(Eigen::MatrixXd::Zero(p.x.rows(), p.y.rows()));
    p.frames.push_back(0);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto fold = static_cast<std::size_t>(examples.folds[static_cast<std::size_t>(i)]);
    p.xx[fold].noalias() += p.x.col(i) * p.x.col(i).transpose();
    p.xy[fold].noalias() += p.x.col(i) * p.y.col(i).transpose();
    p.frames[fold] += 1;
  }
  return p;
}

/// dof x features, without the frames of one fold (none: -1).
Eigen::MatrixXd Solve(const Prepared& p, int without, double ridge) {
  Eigen::MatrixXd xx = Eigen::MatrixXd::Zero(p.x.rows(), p.x.rows());
  Eigen::MatrixXd xy = Eigen::MatrixXd::Zero(p.x.rows(), p.y.rows());
  double frames = 0;
  for (int fold = 0; fold < kFolds; ++fold) {
    if (fold == without) continue;
    const auto index = static_cast<std::size_t>(fold);
    xx += p.xx[index];
    xy += p.xy[index];
    frames += p.frames[index];
  }
  xx.diagonal().array() += ridge * std::max(frames, 1.0);
  return xx.llt().solve(xy).transpose();
}

/// Errors on every frame by the weights that have not seen it.
Eigen::MatrixXd LeftOut(const Prepared& p, const PoseExamples& examples, double ridge) {
  std::vector<Eigen::MatrixXd> weights;
  for (int fold = 0; fold < kFolds; ++fold) weights.push_back(Solve(p, fold, ridge));
  Eigen::MatrixXd errors(p.y.rows(), p.y.cols());
  for (Eigen::Index i = 0; i < p.y.cols(); ++i) {
    const auto fold = static_cast<std::size_t>(examples.folds[static_cast<std::size_t>(i)]);
    errors.col(i) = p.y.col(i) - weights[fold] * p.x.col(i);
  }
  return errors;
}

}  // namespace

FittedPoseRegression FitPoseRegression(const PoseExamples& examples, const Eigen::VectorXd& scale) {
  FOOTING_CHECK(!examples.poses.empty() && examples.features.size() == examples.poses.size() &&
                examples.folds.size() == examples.poses.size());
  const Prepared p = Prepare(examples);
  const auto frames = static_cast<double>(p.y.cols());
  FittedPoseRegression fitted;
  fitted.spread = std::sqrt((scale.asDiagonal() * p.y).squaredNorm() / frames);
  fitted.error = std::numeric_limits<double>::infinity();
  Eigen::MatrixXd best;
  for (const double ridge : kRidges) {
    const Eigen::MatrixXd errors = scale.asDiagonal() * LeftOut(p, examples, ridge);
    const double error = std::sqrt(errors.squaredNorm() / frames);
    if (error >= fitted.error) continue;
    fitted.error = error;
    fitted.ridge = ridge;
    best = errors;
  }
  const Eigen::MatrixXd covariance = best * best.transpose() / frames;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  fitted.rest_variances = solver.eigenvalues().reverse().cwiseMax(0);
  fitted.rest_components = solver.eigenvectors().rowwise().reverse().transpose();
  fitted.regression = {p.mean, p.scale, Solve(p, -1, fitted.ridge), p.offset};
  return fitted;
}

void AppendTensors(const FittedPoseRegression& fitted, model::Model& model) {
  const auto add = [&model](const char* name, const Eigen::MatrixXd& rows) {
    std::vector<std::uint32_t> shape{static_cast<std::uint32_t>(rows.rows())};
    if (rows.cols() > 1) shape.push_back(static_cast<std::uint32_t>(rows.cols()));
    model.tensors.push_back({.name = name, .shape = shape, .values = ToFloats(rows.transpose())});
  };
  add("feature_mean", fitted.regression.mean);
  add("feature_scale", fitted.regression.scale);
  add("regression_weights", fitted.regression.weights);
  add("regression_offset", fitted.regression.offset);
  add("rest_components", fitted.rest_components);
  add("rest_variances", fitted.rest_variances);
}

}  // namespace footing::training
