#include "daemon/offline/learning/person_fit.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "daemon/offline/learning/pose_regression.h"

namespace footing::learning {
namespace {

using reconstruction::Features;

constexpr int kPersonDof = 6;

/// Predicts 0 with errors of 0.2 along every degree of freedom.
struct Base {
  reconstruction::PoseRegression regression;
  pose::PoseBasis rest;

  Base() {
    regression.mean = Eigen::VectorXd::Zero(Features::kCount);
    regression.scale = Eigen::VectorXd::Ones(Features::kCount);
    regression.weights = Eigen::MatrixXd::Zero(kPersonDof, Features::kCount);
    regression.offset = Eigen::VectorXd::Zero(kPersonDof);
    rest.mean = Eigen::VectorXd::Zero(kPersonDof);
    rest.modes = rest.inverse = Eigen::MatrixXd::Identity(kPersonDof, kPersonDof);
    rest.sd = Eigen::VectorXd::Constant(kPersonDof, 0.2);
  }
};

/// A minute at 60 Hz, in pieces of 5 s: each entry of a pose is `offset` and `slope` of a feature,
/// with white noise.
PoseExamples MinuteOf(double offset, double slope, double noise) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  PoseExamples examples;
  for (int i = 0; i < 3600; ++i) {
    Features::Values features = Features::Values::Zero();
    for (double& value : features) value = normal(generator);
    Eigen::VectorXd pose(kPersonDof);
    for (double& value : pose) value = offset + slope * features(3) + noise * normal(generator);
    examples.features.push_back(features);
    examples.poses.push_back(pose);
    examples.folds.push_back(i / 300);
    examples.people.push_back(PoseExamples::kOwn);
  }
  return examples;
}

TEST(PersonFit, LearnsAConstantDifference) {
  const Base base;
  const auto fitted = FitCorrection(MinuteOf(0.3, 0, 0.05), base.regression, base.rest);
  EXPECT_NEAR(fitted.correction.offset(4), 0.3, 0.01);
  EXPECT_LT(fitted.error, 0.5 * fitted.error_base);
}

TEST(PersonFit, LearnsHowTheDifferenceDependsOnTheFeatures) {
  const Base base;
  const auto fitted = FitCorrection(MinuteOf(0, 0.3, 0.05), base.regression, base.rest);
  // The data are 3600 frames; the penalty of a feature is that of the offset times the number of
  // features.
  EXPECT_NEAR(fitted.correction.weights(4, 3), 0.3, 0.2);
  EXPECT_LT(fitted.error, 0.8 * fitted.error_base);
}

TEST(PersonFit, CorrectsNextToNothingWhereTheBaseIsRight) {
  const Base base;
  const auto fitted = FitCorrection(MinuteOf(0, 0, 0.1), base.regression, base.rest);
  EXPECT_LT(fitted.correction.offset.norm(), 0.02);
  EXPECT_LT(fitted.correction.weights.norm(), 0.05);
}

TEST(PersonFit, ErrorsAreThoseOfTheBaseAndOfThePerson) {
  const Base base;
  const auto fitted = FitCorrection(MinuteOf(0.3, 0, 0.1), base.regression, base.rest);
  // As many frames of either: (0.2^2 + 0.1^2) / 2 of an angle, 2.5^2 times that of a place.
  EXPECT_NEAR(fitted.correction.rest_variances.tail(3).mean(), 0.025, 0.002);
  reconstruction::PoseRegression regression = base.regression;
  pose::PoseBasis rest = base.rest;
  Correct(fitted.correction, regression, rest);
  const Eigen::MatrixXd axes = rest.modes * rest.sd.asDiagonal();
  const Eigen::VectorXd variances = (axes * axes.transpose()).diagonal();
  EXPECT_NEAR(variances(0), variances(5), 0.005);
}

/// A pose model of random frames.
reconstruction::NamedModel MadeBase() {
  std::mt19937 generator(2);
  std::normal_distribution<double> normal;
  const std::vector<std::string> dofs{"x", "y", "z", "a", "b", "c"};
  Eigen::MatrixXd poses(kPersonDof, 200);
  for (double& value : poses.reshaped()) value = normal(generator);
  reconstruction::NamedModel base{"base.fmodel", {}};
  base.model.kind = "pose";
  AppendTensors(MakeBasis(poses, dofs), base.model);
  base.model.tensors.push_back({.name = "root_height_m", .shape = {1}, .values = {1}});
  const auto fitted =
      FitPoseRegression(MinuteOf(0.1, 0.1, 0.1), Eigen::VectorXd::Ones(kPersonDof), {.count = 4});
  AppendTensors(fitted, base.model);
  AppendTensors(fitted, base.model, reconstruction::kPosturePrefix);
  return base;
}

TEST(PersonFit, ItsModelIsRefusedWithAnotherBase) {
  const reconstruction::NamedModel base = MadeBase();
  const auto models = reconstruction::MakeModels({base});
  ASSERT_TRUE(models.ok()) << models.error().message;
  const auto fitted = FitCorrection(MinuteOf(0.5, 0, 0.05), models->regression, models->rest);
  reconstruction::NamedModel person{"p07.fmodel", {}};
  person.model.kind = "person";
  person.model.provenance.data = {{"pose.fmodel", reconstruction::BaseDigest(base.model)}};
  AppendTensors(fitted.correction, "", person.model);
  AppendTensors(fitted.correction, reconstruction::kPosturePrefix, person.model);

  const auto adapted = reconstruction::MakeModels({base, person});
  ASSERT_TRUE(adapted.ok()) << adapted.error().message;
  EXPECT_LT(
      (adapted->regression.offset - models->regression.offset - fitted.correction.offset).norm(),
      1e-6);
  const auto message = [](const std::vector<reconstruction::NamedModel>& given) {
    const auto made = reconstruction::MakeModels(given);
    return made.ok() ? std::string("fine") : made.error().message;
  };
  reconstruction::NamedModel other = base;
  other.model.tensors.back().values.back() += 1;
  EXPECT_NE(message({other, person}).find("p07.fmodel: was made with another pose model"),
            std::string::npos);
  EXPECT_NE(message({person}).find("no model of kind pose"), std::string::npos);
}

}  // namespace
}  // namespace footing::learning
