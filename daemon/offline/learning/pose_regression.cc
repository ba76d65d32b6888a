#include "daemon/offline/learning/pose_regression.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <utility>

#include "common/base/result.h"
#include "common/virtual/motion/edit.h"
#include "daemon/offline/learning/ridge.h"
#include "daemon/offline/learning/scaling.h"

namespace footing::learning {
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

}  // namespace footing::learning
