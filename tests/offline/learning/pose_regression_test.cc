#include <gtest/gtest.h>

#include "common/virtual/devices/noise.h"
#include "daemon/offline/learning/pose_regression.h"

namespace footing::learning {
namespace {

TEST(ArmRegression, FindsALinearMapAndTheCovarianceOfWhatIsLeft) {
  constexpr double kNoise = 0.1;
  noise::Random random(7);
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(arms::kDirections, arms::ArmFeatures::kCount);
  for (Eigen::Index i = 0; i < map.rows(); ++i) {
    for (Eigen::Index k = 0; k < 5; ++k) map(i, k) = random.Normal();
  }
  ArmExamples examples;
  examples.fold_count = 3;
  for (int i = 0; i < 3000; ++i) {
    arms::ArmFeatures::Values features;
    for (double& value : features) value = random.Normal();
    const double shared = kNoise * random.Normal();  // Makes the first two alike.
    arms::Directions directions = map * features;
    for (Eigen::Index k = 0; k < directions.size(); ++k) {
      directions(k) += k < 2 ? shared : kNoise * random.Normal();
    }
    examples.features.push_back(features);
    examples.directions.push_back(directions);
    examples.folds.push_back(i % 3);
  }
  const FittedArm fitted = FitArm(examples);
  EXPECT_LT(fitted.error, 0.45);  // sqrt(9) times the noise is 0.3.
  EXPECT_GT(fitted.error, 0.3);
  EXPECT_GT(fitted.spread, 4);
  const auto& covariance = fitted.model.covariance;
  EXPECT_NEAR(covariance(0, 1) / covariance(0, 0), 1, 0.3);
  EXPECT_NEAR(covariance(4, 5) / covariance(4, 4), 0, 0.2);
  for (const double variance : covariance.diagonal()) EXPECT_NEAR(variance, 0.013, 0.006);

  arms::ArmFeatures::Values features = examples.features[0];
  const arms::Directions told = fitted.model.Predict(features);
  EXPECT_LT((told - map * examples.features[0]).norm(), 0.5);

  model::Model model{.kind = "arm", .provenance = {}, .tensors = {}};
  AppendTensors(fitted.model, model);
  const auto read = arms::MakeArmModel(model, "made.fmodel");
  ASSERT_TRUE(read.ok()) << read.error().message;
  features = examples.features[0];
  EXPECT_LT((read->Predict(features) - told).norm(), 1e-4);
}

/// Root position and two angles that move as one, and one of their own.
Eigen::MatrixXd Poses(int count) {
  noise::Random random(1);
  Eigen::MatrixXd poses(6, count);
  for (int i = 0; i < count; ++i) {
    const double bend = random.Normal(), twist = 0.1 * random.Normal();
    poses.col(i) << 0.1, 0, 1 - 0.2 * bend, 0.3 + bend, -0.5 * bend, twist;
  }
  return poses;
}

const std::vector<std::string> kDofs = {"x", "y", "z", "a", "b", "c"};

TEST(MakeBasis, FindsWhatMovesTogetherInTheOrderOfItsVariance) {
  const PoseBasis basis = MakeBasis(Poses(4000), kDofs);
  // Scaled (2.5 a metre): (0, 0, -0.5, 1, -0.5, 0) times the bend, of length sqrt(1.5).
  Eigen::VectorXd expected(6);
  expected << 0, 0, -0.5, 1, -0.5, 0;
  EXPECT_LT((basis.components.row(0).transpose() - expected.normalized()).norm(), 0.01);
  EXPECT_NEAR(basis.variances(0), 1.5, 0.1 * 1.5);
  EXPECT_NEAR(basis.variances(1), 0.01, 0.1 * 0.01);
  EXPECT_NEAR(basis.variances.tail(4).sum(), 0, 1e-12);
  EXPECT_EQ(basis.ComponentsFor(0.9), 1);
  EXPECT_EQ(basis.ComponentsFor(0.9999), 2);
}

TEST(MakeBasis, KeepsEveryComponentSoThatAnyPoseCanBeMade) {
  const PoseBasis basis = MakeBasis(Poses(100), kDofs);
  EXPECT_TRUE((basis.components * basis.components.transpose()).isIdentity(1e-9));
  const Eigen::VectorXd pose = Eigen::VectorXd::LinSpaced(6, -1, 2);  // Like none of them.
  const Eigen::VectorXd along = basis.components * basis.scale.cwiseProduct(pose - basis.mean);
  const Eigen::VectorXd again =
      basis.mean + (basis.components.transpose() * along).cwiseQuotient(basis.scale);
  EXPECT_TRUE(again.isApprox(pose, 1e-9));
}

TEST(MakeBasis, SaysInItsTensorsWhichColumnIsWhichDof) {
  model::Model model{.kind = "basis", .provenance = {}, .tensors = {}};
  const PoseBasis basis = MakeBasis(Poses(100), kDofs);
  AppendTensors(basis, model);
  ASSERT_TRUE(model::Check(model, "m").ok());
  const auto components = model::Find(model, "components", {6, 6}, "m");
  ASSERT_TRUE(components.ok());
  EXPECT_EQ((*components)->labels, kDofs);
  EXPECT_FLOAT_EQ((*components)->values[6 * 1 + 5], static_cast<float>(basis.components(1, 5)));
}

constexpr int kDof = 6;
constexpr RandomWaves kWaves{.count = 40};

/// Poses that are a linear map of the features and some noise.
PoseExamples Linear(double noise, std::uint64_t seed, Eigen::MatrixXd& map, int frames = 3000) {
  noise::Random random(seed);
  map = Eigen::MatrixXd::Zero(kDof, reconstruction::Features::kCount);
  for (int i = 0; i < kDof; ++i) {
    for (int k = 0; k < 10; ++k) map(i, k) = random.Normal();
  }
  PoseExamples examples;
  for (int i = 0; i < frames; ++i) {
    reconstruction::Features::Values features;
    for (double& value : features) value = 0.5 * random.Normal();
    Eigen::VectorXd pose = map * features;
    for (double& value : pose) value += noise * random.Normal();
    examples.features.push_back(features);
    examples.poses.push_back(pose);
    examples.folds.push_back(i / 100 % kFolds);
    examples.people.push_back(0);
  }
  return examples;
}

TEST(PoseRegression, FindsALinearMapAndTellsItsErrorOnWhatWasLeftOut) {
  Eigen::MatrixXd map;
  const PoseExamples examples = Linear(0.1, 1, map);
  const auto fitted = FitPoseRegression(examples, Eigen::VectorXd::Ones(kDof), kWaves);
  reconstruction::PoseRegression::Workspace workspace = fitted.regression.MakeWorkspace();
  Eigen::VectorXd pose(kDof);
  double sum = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    fitted.regression.Predict(examples.features[i], workspace, pose);
    sum += (pose - map * examples.features[i]).squaredNorm();
  }
  EXPECT_LT(std::sqrt(sum / 200 / kDof), 0.04);
  // The noise of 0.1 in each of six entries, and a little for what is not quite learned.
  EXPECT_NEAR(fitted.error, 0.1 * std::sqrt(6.0), 0.02);
  EXPECT_NEAR(std::sqrt(fitted.rest_variances.sum()), fitted.error, 1e-9);
  EXPECT_GT(fitted.spread, 5 * fitted.error);
}

TEST(PoseRegression, ItsWavesFindWhatIsNotLinear) {
  noise::Random random(5);
  PoseExamples examples;
  for (int i = 0; i < 1000; ++i) {
    reconstruction::Features::Values features = reconstruction::Features::Values::Zero();
    for (double& value : features.head<3>()) value = random.Normal();
    Eigen::VectorXd pose(2);
    pose << features(0) * features(1), features(2) * features(2);
    examples.features.push_back(features);
    examples.poses.push_back(pose);
    examples.folds.push_back(i / 100 % kFolds);
    examples.people.push_back(0);
  }
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(2);
  const auto linear = FitPoseRegression(examples, scale, {.count = 0});
  const auto waved = FitPoseRegression(examples, scale, {.count = 100, .kernel_width = 0.2});
  EXPECT_GT(linear.error, 0.95 * linear.spread);  // Products know nothing of their factors' signs.
  EXPECT_LT(waved.error, 0.5 * linear.error);
  reconstruction::PoseRegression::Workspace workspace = waved.regression.MakeWorkspace();
  Eigen::VectorXd pose(2);
  waved.regression.Predict(examples.features[7], workspace, pose);
  EXPECT_LT((pose - examples.poses[7]).norm(), 2 * waved.error);
}

TEST(PoseRegression, WithNothingToLearnShrinksAndItsErrorIsTheSpread) {
  Eigen::MatrixXd map;
  PoseExamples examples = Linear(0, 2, map);
  noise::Random random(3);
  for (Eigen::VectorXd& pose : examples.poses) {
    for (double& value : pose) value = random.Normal();
  }
  const auto fitted = FitPoseRegression(examples, Eigen::VectorXd::Ones(kDof), kWaves);
  EXPECT_EQ(fitted.ridge, 1.0);  // The greatest that is tried.
  EXPECT_NEAR(fitted.error / fitted.spread, 1, 0.03);
}

TEST(PoseRegression, PeopleCountAlikeHoweverLongEachWasRecorded) {
  noise::Random random(6);
  PoseExamples examples;
  const auto add = [&](int person, int frames, double angle) {
    for (int i = 0; i < frames; ++i) {
      reconstruction::Features::Values features;
      for (double& value : features) value = random.Normal();
      examples.features.push_back(features);
      examples.poses.push_back(Eigen::VectorXd::Constant(1, angle));
      examples.folds.push_back(person < 0 ? 2 : person);
      examples.people.push_back(person);
    }
  };
  add(0, 900, 1);
  add(1, 100, -1);
  const auto two = FitPoseRegression(examples, Eigen::VectorXd::Ones(1), {.count = 0});
  EXPECT_NEAR(two.regression.offset(0), 0, 1e-9);
  EXPECT_NEAR(two.spread, 1, 1e-9);
  // 1000 frames of one's own count once each, beside as many of the others.
  add(PoseExamples::kOwn, 1000, 3);
  const auto own = FitPoseRegression(examples, Eigen::VectorXd::Ones(1), {.count = 0});
  EXPECT_NEAR(own.regression.offset(0), 1.5, 1e-9);
}

TEST(PoseRegression, ItsTensorsHaveTheShapesThatTheyAreReadBy) {
  Eigen::MatrixXd map;
  const auto fitted =
      FitPoseRegression(Linear(0.1, 4, map, 500), Eigen::VectorXd::Ones(kDof), kWaves);
  model::Model model{.kind = "pose", .provenance = {}, .tensors = {}};
  AppendTensors(fitted, model);
  constexpr auto kFeatures = static_cast<std::uint32_t>(reconstruction::Features::kCount);
  ASSERT_TRUE(model::Check(model, "made").ok());
  const auto weights = model::Find(model, "regression_weights", {kDof, kFeatures}, "made");
  ASSERT_TRUE(weights.ok());
  EXPECT_FLOAT_EQ((*weights)->values[kFeatures + 2],
                  static_cast<float>(fitted.regression.weights(1, 2)));
  EXPECT_TRUE(model::Find(model, "feature_mean", {kFeatures}, "made").ok());
  EXPECT_TRUE(model::Find(model, "waves", {kWaves.count, kFeatures}, "made").ok());
  EXPECT_TRUE(model::Find(model, "wave_phases", {kWaves.count}, "made").ok());
  EXPECT_TRUE(model::Find(model, "wave_weights", {kDof, kWaves.count}, "made").ok());
  EXPECT_TRUE(model::Find(model, "rest_components", {kDof, kDof}, "made").ok());
}

}  // namespace
}  // namespace footing::learning
