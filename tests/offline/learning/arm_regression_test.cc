#include "daemon/offline/learning/arm_regression.h"

#include <gtest/gtest.h>

#include "common/virtual/devices/random.h"

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
    const double shared = kNoise * random.Normal();  // Of the first two, so that they are alike.
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

}  // namespace
}  // namespace footing::learning
