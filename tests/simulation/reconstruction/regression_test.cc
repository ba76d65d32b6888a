#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/simulation/reconstruction/made_world.h"

namespace footing::reconstruction {
namespace {

/// A regression that says: whatever is measured, the pose is that of the T-pose.
NamedModel WithRegression(const World& world) {
  NamedModel named = BasisOf(world.person, world.motion);
  named.model.kind = "pose";
  const auto dof = static_cast<std::uint32_t>(world.person.skeleton.dof);
  constexpr auto kFeatures = static_cast<std::uint32_t>(Features::kCount);
  const Eigen::VectorXd t_pose = body::TPose(world.person.skeleton, world.person.landmarks);
  std::vector<float> offset, identity(std::size_t{dof} * dof, 0);
  for (int i = 0; i < t_pose.size(); ++i) offset.push_back(static_cast<float>(t_pose(i)));
  // The root is told from the centre of mass, in parts of its height.
  offset[0] = offset[1] = offset[2] = 0;
  for (std::size_t i = 0; i < dof; ++i) identity[i * dof + i] = 1;
  named.model.tensors.push_back({"root_height_m", {1}, {static_cast<float>(t_pose(2))}});
  named.model.tensors.push_back({"feature_mean", {kFeatures}, std::vector<float>(kFeatures, 0)});
  named.model.tensors.push_back({"feature_scale", {kFeatures}, std::vector<float>(kFeatures, 1)});
  named.model.tensors.push_back({"regression_weights",
                                 {dof, kFeatures},
                                 std::vector<float>(std::size_t{dof} * kFeatures, 0)});
  named.model.tensors.push_back({"regression_offset", {dof}, offset});
  named.model.tensors.push_back({"rest_components", {dof, dof}, identity});
  named.model.tensors.push_back({"rest_variances", {dof}, std::vector<float>(dof, 1e-8f)});
  return named;
}

TEST(Reconstruction, ACertainRegressionDecidesAndIsLeftOutWithoutHands) {
  World world;
  const Models models = MakeModels({WithRegression(world)}).value();
  Options options = world.AtRate();
  options.clean_up = false;
  options.best.pelvis_sd_rad = 0;  // Certain of the pelvis, too.
  Reconstruction regressed = Reconstruction::Create(world.person, models, options).value();
  const Eigen::VectorXd t_pose = body::TPose(world.person.skeleton, world.person.landmarks);
  for (std::size_t i = 0; i < 460; ++i) regressed.Advance(world.inputs[i]);
  const Eigen::VectorXd with_hands = regressed.output().q;
  // Each angle is certain to 0.006 degrees; the basis alone follows the movement.
  EXPECT_LT((with_hands - t_pose).tail(53).cwiseAbs().mean(), 0.01);
  for (std::size_t i = 460; i < 470; ++i) {
    Inputs inputs = world.inputs[i];
    inputs.hands[0].valid = false;
    ASSERT_TRUE(Finite(regressed.Advance(inputs)));
  }
  EXPECT_GT((regressed.output().q - t_pose).tail(53).cwiseAbs().mean(), 0.03);
}

/// The same of hands and feet alone: nothing is said of the regression with the momentum.
NamedModel WithPosture(const World& world) {
  NamedModel named = WithRegression(world);
  named.model.kind = "basis";
  for (model::Tensor& tensor : named.model.tensors) {
    if (tensor.name.rfind("feature_", 0) == 0 || tensor.name.rfind("regression_", 0) == 0 ||
        tensor.name.rfind("rest_", 0) == 0) {
      tensor.name = kPosturePrefix + tensor.name;
    }
  }
  return named;
}

TEST(Reconstruction, ALearnedPostureDecidesWhereTheMomentumIsLeftOut) {
  World world;
  const Models models = MakeModels({WithPosture(world)}).value();
  ASSERT_FALSE(models.posture.empty());
  EXPECT_TRUE(models.regression.empty());
  const Eigen::VectorXd t_pose = body::TPose(world.person.skeleton, world.person.landmarks);
  Options options = world.AtRate();
  options.clean_up = options.use_momentum = false;
  options.best.pelvis_sd_rad = 0;  // Certain of the pelvis, too.
  double off_rad[2];
  for (const bool use : {false, true}) {
    options.use_posture = use;
    Reconstruction made = Reconstruction::Create(world.person, models, options).value();
    for (std::size_t i = 0; i < 460; ++i) made.Advance(world.inputs[i]);
    off_rad[use ? 1 : 0] = (made.output().q - t_pose).tail(53).cwiseAbs().mean();
  }
  EXPECT_LT(off_rad[1], 0.01);  // It is certain of the T-pose.
  EXPECT_GT(off_rad[0], 0.03);
}

TEST(Reconstruction, ArmsAreTakenWhereHandsAreNotSeen) {
  World world;
  std::vector<Inputs> unseen = world.inputs;
  for (std::size_t i = 0; i < unseen.size(); ++i) {
    body::ComputeKinematics(world.person.skeleton, world.motion.q.col(static_cast<Eigen::Index>(i)),
                            world.at);
    for (const int side : {0, 1}) {
      const auto index = static_cast<std::size_t>(side);
      unseen[i].hands[index].valid = false;
      arms::ArmEstimate& arm = unseen[i].arms[index];
      arm.valid = true;
      arm.directions = arms::ArmGeometry(world.person, side).Directions(world.at);
      arm.upper_sd = arm.hinge_sd = arm.forearm_sd = Eigen::Vector3d::Constant(0.05);
    }
  }
  // Mean distance of the left fist; with a regression that knows nothing but a T-pose too.
  const auto fist_error_m = [&](const std::vector<Inputs>& inputs, Mode mode, bool with_arms) {
    Options options = world.AtRate(mode);
    options.use_angular_momentum = false;
    Reconstruction reconstruction = world.Made(options);
    const body::Point fist = body::Fist(world.person, 0);
    const auto joint = static_cast<std::size_t>(fist.joint);
    double sum = 0, frames = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      Inputs input = inputs[i];
      if (!with_arms) input.arms = {};
      const Output& output = reconstruction.Advance(input);
      EXPECT_TRUE(Finite(output));
      if (i < 400) continue;
      body::ComputeKinematics(world.person.skeleton,
                              world.motion.q.col(static_cast<Eigen::Index>(i)), world.at);
      sum += (output.p_WJ_m[joint] - world.at.p_WJ[joint]).norm();
      ++frames;
    }
    return sum / frames;
  };
  EXPECT_LT(fist_error_m(unseen, Mode::kBest, true), 0.065);
  EXPECT_LT(fist_error_m(unseen, Mode::kPaper, true), 0.15);
  EXPECT_GT(fist_error_m(unseen, Mode::kBest, false), 2 * fist_error_m(unseen, Mode::kBest, true));
}

TEST(Reconstruction, ArmsThatAreNotFiniteAreLeftOut) {
  World world;
  Reconstruction with = world.Made(world.AtRate()), without = world.Made(world.AtRate());
  for (std::size_t i = 0; i < 420; ++i) {
    Inputs input = world.inputs[i];
    input.hands[0].valid = false;
    without.Advance(input);
    input.arms[0].valid = true;
    input.arms[0].directions.upper.x() = std::numeric_limits<double>::quiet_NaN();
    ASSERT_TRUE(Finite(with.Advance(input)));
  }
  EXPECT_EQ(with.output().q, without.output().q);
}

TEST(PoseRegression, AddsTheCosinesThatItsFileHas) {
  World world;
  NamedModel named = WithRegression(world);
  const auto dof = static_cast<std::uint32_t>(world.person.skeleton.dof);
  constexpr auto kFeatures = static_cast<std::uint32_t>(Features::kCount);
  std::vector<float> wave(kFeatures, 0), weights(dof, 0);
  wave[3] = 2;
  weights[7] = 0.5;
  named.model.tensors.push_back({"waves", {1, kFeatures}, wave});
  named.model.tensors.push_back({"wave_phases", {1}, {0.25f}});
  const auto cut = MakeModels({named});
  ASSERT_FALSE(cut.ok());
  EXPECT_NE(cut.error().message.find("wave_weights"), std::string::npos) << cut.error().message;
  named.model.tensors.push_back({"wave_weights", {dof}, weights});
  const PoseRegression regression = MakeModels({named}).value().regression;
  Features::Values features = Features::Values::Zero();
  features(3) = 0.5;
  PoseRegression::Workspace workspace = regression.MakeWorkspace();
  Eigen::VectorXd q(dof);
  regression.Predict(features, workspace, q);
  EXPECT_NEAR(q(7), regression.offset(7) + 0.5 * std::cos(2 * 0.5 + 0.25), 1e-6);
  EXPECT_EQ(q(8), regression.offset(8));
}

TEST(Features, WithoutLoadsOnlyHandsAndFeetCount) {
  momentum::Estimate light, heavy;
  heavy.p_WC_m << 0.1, 0.2, 0.6;
  heavy.v_WC_mps.setConstant(0.3);
  heavy.a_WC_mps2.setConstant(2);
  heavy.angular_momentum_kgm2ps.setConstant(5);
  for (momentum::Estimate* estimate : {&light, &heavy}) {
    estimate->feet[0].p_WF_m.y() = 0.2;
    estimate->feet[0].contact = estimate->feet[1].contact = true;
  }
  heavy.feet[0].load_n = 500;
  heavy.feet[1].cop_valid = true;
  const std::array<Eigen::Vector3d, 2> hands{Eigen::Vector3d(0, 0.7, 1.4),
                                             Eigen::Vector3d(0, -0.7, 1.4)};
  Features a(1 / 60.0, 0.95, 70), b(1 / 60.0, 0.95, 70);
  EXPECT_EQ(a.Advance(hands, WithoutLoads(light.feet, 1)),
            b.Advance(hands, WithoutLoads(heavy.feet, 1)));
  heavy.feet[1].contact = false;
  EXPECT_NE(a.Advance(hands, WithoutLoads(light.feet, 1)),
            b.Advance(hands, WithoutLoads(heavy.feet, 1)));
}

TEST(Features, AreTheSameWhereverThePersonStands) {
  World world;
  Features here(1 / kMadeRateHz, 1, 70), there(1 / kMadeRateHz, 1, 70);
  Reconstruction reconstruction = world.Made(world.AtRate());
  const Eigen::Vector3d away(3, -2, 0);
  for (std::size_t i = 0; i < 500; ++i) {
    const Output& output = reconstruction.Advance(world.inputs[i]);
    if (!output.calibrated) continue;
    momentum::Estimate moved = output.momentum;
    moved.p_WC_m += away;
    for (momentum::FootEstimate& foot : moved.feet) {
      foot.p_WF_m += away;
      foot.p_WP_m += away;
    }
    const auto& hands = world.inputs[i].hands;
    const auto a = here.Advance({hands[0].p_W_m, hands[1].p_W_m}, output.momentum);
    const auto b = there.Advance({hands[0].p_W_m + away, hands[1].p_W_m + away}, moved);
    ASSERT_LT((a - b).cwiseAbs().maxCoeff(), 1e-9);
    ASSERT_GT(a.norm(), 0.1);
  }
}

}  // namespace
}  // namespace footing::reconstruction
