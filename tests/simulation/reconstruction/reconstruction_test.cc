#include "daemon/simulation/reconstruction/reconstruction.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "tests/simulation/allocations.h"
#include "tests/simulation/reconstruction/made_person.h"

namespace footing::reconstruction {
namespace {

/// One person's movement, what is measured of it, and a reconstruction whose basis has seen it.
struct World {
  body::Body person = MadePerson();
  motion::Motion motion = MadeMotion(person, 18);
  std::vector<Inputs> inputs = Measured(person, motion);
  Models models = MakeModels({BasisOf(person, motion)}).value();
  body::Kinematics at{person.skeleton};

  Options AtRate(Mode mode = Mode::kBest, double lag_s = 0) const {
    Options options;
    options.mode = mode;
    options.rate_hz = kMadeRateHz;
    options.lag_s = lag_s;
    return options;
  }
  Reconstruction Made(const Options& options) const {
    return Reconstruction::Create(person, models, options).value();
  }
  /// Mean distance of the joints from where they were `back` frames before frame i.
  double ErrorM(const Output& output, std::size_t i, std::size_t back) {
    body::ComputeKinematics(person.skeleton, motion.q.col(static_cast<Eigen::Index>(i - back)), at);
    double sum = 0;
    for (std::size_t k = 0; k < at.p_WJ.size(); ++k) sum += (output.p_WJ_m[k] - at.p_WJ[k]).norm();
    return sum / static_cast<double>(at.p_WJ.size());
  }
  double MeanErrorM(Reconstruction& reconstruction, std::size_t back) {
    double sum = 0, frames = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const Output& output = reconstruction.Advance(inputs[i]);
      if (!output.calibrated || i < 400) continue;
      sum += ErrorM(output, i, back);
      ++frames;
    }
    return frames > 0 ? sum / frames : std::numeric_limits<double>::infinity();
  }
};

bool Finite(const Output& output) {
  bool finite = output.q.allFinite();
  for (const Eigen::Vector3d& p : output.p_WJ_m) finite = finite && p.allFinite();
  for (const Eigen::Matrix3d& R : output.R_WJ) finite = finite && R.allFinite();
  finite = finite && output.com_W_m.allFinite() && output.com_variance_m2.allFinite() &&
           output.com_variance_m2.minCoeff() > 0;
  for (const double sd : output.joint_sd_m) finite = finite && std::isfinite(sd) && sd >= 0;
  return finite;
}

TEST(Reconstruction, StandsInATPoseUntilItIsCalibrated) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate());
  for (std::size_t i = 0; i < 299; ++i) {
    const Output& output = reconstruction.Advance(world.inputs[i]);
    ASSERT_FALSE(output.calibrated);
    ASSERT_FALSE(output.valid);
    ASSERT_NEAR(output.calibration_progress, static_cast<double>(i + 1) / 300, 0.01);
  }
  EXPECT_EQ(reconstruction.output().q, body::TPose(world.person.skeleton, world.person.landmarks));
  for (std::size_t i = 299; i < 310; ++i) reconstruction.Advance(world.inputs[i]);
  EXPECT_TRUE(reconstruction.output().calibrated);
  EXPECT_TRUE(reconstruction.output().valid);
  EXPECT_NEAR(reconstruction.output().mass_kg, 70, 0.1);
}

TEST(Reconstruction, FollowsAPersonWhoseMovementItKnows) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate());
  EXPECT_LT(world.MeanErrorM(reconstruction, 0), 0.05);
}

TEST(Reconstruction, TheHeightOfCIsThatOfThePoseAndTheRestIsTheLoads) {
  World world;
  for (const double lag_s : {0.0, 0.1}) {
    Reconstruction reconstruction = world.Made(world.AtRate(Mode::kBest, lag_s));
    for (std::size_t i = 0; i < 500; ++i) reconstruction.Advance(world.inputs[i]);
    const Output& output = reconstruction.output();
    body::Kinematics at(world.person.skeleton);
    body::ComputeKinematics(world.person.skeleton, output.q, at);
    EXPECT_NEAR(output.com_W_m.z(), body::CentreOfMass(world.person, at).z(), 1e-12);
    EXPECT_NE(output.com_W_m.z(), output.momentum.p_WC_m.z());
    EXPECT_EQ(output.com_W_m.head<2>(), output.momentum.p_WC_m.head<2>());
    EXPECT_LT(output.com_variance_m2.z(), output.momentum.position_variance_m2.z());
  }
  Reconstruction paper = world.Made(world.AtRate(Mode::kPaper));
  for (std::size_t i = 0; i < 500; ++i) paper.Advance(world.inputs[i]);
  EXPECT_EQ(paper.output().com_W_m, paper.output().momentum.p_WC_m);
}

TEST(Reconstruction, WithALagTellsThePoseOfBefore) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate(Mode::kBest, 0.2));
  const double then_m = world.MeanErrorM(reconstruction, 12);
  reconstruction = world.Made(world.AtRate(Mode::kBest, 0.2));
  const double now_m = world.MeanErrorM(reconstruction, 0);
  EXPECT_LT(then_m, 0.05);
  EXPECT_GT(now_m, 1.25 * then_m);
  EXPECT_NEAR(reconstruction.output().lag_s, 0.2, 1e-9);
}

TEST(Reconstruction, PaperModeFollowsToo) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate(Mode::kPaper));
  EXPECT_LT(world.MeanErrorM(reconstruction, 0), 0.15);
}

TEST(Reconstruction, HasNoModeOrOptionThatIsNotFinite) {
  World world;
  for (const Mode mode : {Mode::kBest, Mode::kPaper}) {
    for (const int bits : {0, 1, 2, 4, 8, 15}) {
      Options options = world.AtRate(mode);
      options.use_momentum = (bits & 1) != 0;
      options.use_angular_momentum = (bits & 2) != 0;
      options.clean_up = (bits & 4) != 0;
      options.use_basis = (bits & 8) != 0;
      Reconstruction reconstruction = world.Made(options);
      for (std::size_t i = 0; i < 380; ++i) reconstruction.Advance(world.inputs[i]);
      EXPECT_TRUE(reconstruction.output().valid) << bits;
      EXPECT_TRUE(Finite(reconstruction.output())) << bits;
    }
  }
}

TEST(Reconstruction, StaysFiniteWithInputsThatAreNot) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  World world;
  for (const Mode mode : {Mode::kBest, Mode::kPaper}) {
    Reconstruction reconstruction = world.Made(world.AtRate(mode));
    for (std::size_t i = 0; i < 600; ++i) {
      Inputs inputs = world.inputs[i];
      if (i >= 400 && i < 500) {
        if (i % 3 == 0) inputs.hands[0].p_W_m.x() = kNaN;
        if (i % 5 == 0) inputs.loads.feet[1].cells[2].load_n = kNaN;
        if (i % 7 == 0) inputs.loads.feet[0].valid = false;
        if (i % 11 == 0) inputs.loads.time_s = kNaN;
        inputs.hands[1].valid = false;
      }
      const Output& output = reconstruction.Advance(inputs);
      ASSERT_TRUE(Finite(output)) << i;
      ASSERT_TRUE(std::isfinite(output.time_s));
      if (i >= 400 && i < 500 && i % 7 == 0) {
        ASSERT_FALSE(output.valid);
      }
    }
    EXPECT_TRUE(reconstruction.output().valid);
  }
}

TEST(Reconstruction, TellsALegInTheAirLessSurelyTheLongerItIsThere) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate());
  const auto sd_m = [&](body::Landmark landmark) {
    const int joint = world.person.landmarks[landmark];
    return reconstruction.output().joint_sd_m[static_cast<std::size_t>(joint)];
  };
  constexpr std::size_t kUp = 360, kDown = 420;  // The right foot is off for a second.
  double stood_m = 0, quarter_m = 0, left_m = 0, hip_m = 0;
  for (std::size_t i = 0; i < kDown; ++i) {
    Inputs inputs = world.inputs[i < kUp ? i : kUp];
    inputs.loads.time_s = world.inputs[i].loads.time_s;
    for (std::size_t k = 0; k < 4 && i >= kUp; ++k) {
      inputs.loads.feet[0].cells[k].load_n = 0.25 * 70 * 9.80665;
      inputs.loads.feet[1].cells[k].load_n = 0;
    }
    reconstruction.Advance(inputs);
    if (i + 1 == kUp) {
      stood_m = sd_m(body::Landmark::kRightAnkle);
      left_m = sd_m(body::Landmark::kLeftAnkle);
      hip_m = sd_m(body::Landmark::kRightHip);
    }
    if (i == kUp + 15) quarter_m = sd_m(body::Landmark::kRightAnkle);
  }
  const BestConstants constants;
  // 1 - exp(-t / tau) of it, whatever the linearised terms say.
  EXPECT_GT(quarter_m, 0.7 * constants.aloft_sd_m);
  EXPECT_GT(sd_m(body::Landmark::kRightAnkle), quarter_m + 0.2 * constants.aloft_sd_m);
  EXPECT_GT(sd_m(body::Landmark::kRightKnee), 0.98 * constants.aloft_sd_m);
  EXPECT_LT(sd_m(body::Landmark::kRightHip), hip_m + 0.03);
  EXPECT_LT(sd_m(body::Landmark::kLeftAnkle), left_m + 0.03);
  for (std::size_t i = kUp; i < kUp + 60; ++i) reconstruction.Advance(world.inputs[i]);
  EXPECT_LT(sd_m(body::Landmark::kRightAnkle), stood_m + 0.03);
}

TEST(Reconstruction, ACopyGoesOnAsTheOriginalAndApartFromIt) {
  World world;
  Reconstruction original = world.Made(world.AtRate());
  for (std::size_t i = 0; i < 500; ++i) original.Advance(world.inputs[i]);
  Reconstruction copy = original;
  for (std::size_t i = 500; i < 520; ++i) copy.Advance(world.inputs[i]);
  const Eigen::VectorXd q = copy.output().q;
  EXPECT_NE(original.output().q, q);
  for (std::size_t i = 500; i < 520; ++i) original.Advance(world.inputs[i]);
  EXPECT_EQ(original.output().q, q);
}

TEST(Reconstruction, ForgetsItsTPose) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate());
  for (std::size_t i = 0; i < 400; ++i) reconstruction.Advance(world.inputs[i]);
  reconstruction.Recalibrate();
  EXPECT_FALSE(reconstruction.output().calibrated);
  EXPECT_EQ(reconstruction.output().q, body::TPose(world.person.skeleton, world.person.landmarks));
  for (std::size_t i = 0; i < 310; ++i) reconstruction.Advance(world.inputs[i]);
  EXPECT_TRUE(reconstruction.output().calibrated);
}

TEST(Reconstruction, AdvancesWithoutAllocating) {
  if (!test::CountsAllocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  World world;
  for (const Mode mode : {Mode::kBest, Mode::kPaper}) {
    Reconstruction reconstruction = world.Made(world.AtRate(mode, 0));
    long before = test::Allocations();
    const auto probe = std::make_unique<int>(1);
    ASSERT_GT(test::Allocations(), before) << "the counter does not count";
    before = test::Allocations();
    for (const Inputs& inputs : world.inputs) reconstruction.Advance(inputs);
    EXPECT_EQ(test::Allocations(), before);
  }
}

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
  EXPECT_LT(fist_error_m(unseen, Mode::kBest, true), 0.06);
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
  PoseRegression::Room room = regression.MakeRoom();
  Eigen::VectorXd q(dof);
  regression.Predict(features, room, q);
  EXPECT_NEAR(q(7), regression.offset(7) + 0.5 * std::cos(2 * 0.5 + 0.25), 1e-6);
  EXPECT_EQ(q(8), regression.offset(8));
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

TEST(Reconstruction, RefusesOptionsThatMakeNoSense) {
  World world;
  Options options = world.AtRate();
  options.lag_s = 0.3;
  EXPECT_FALSE(Reconstruction::Create(world.person, world.models, options).ok());
  options.lag_s = 0.1;
  options.mode = Mode::kPaper;
  EXPECT_FALSE(Reconstruction::Create(world.person, world.models, options).ok());
  options = world.AtRate();
  options.rate_hz = 0;
  EXPECT_FALSE(Reconstruction::Create(world.person, world.models, options).ok());
}

}  // namespace
}  // namespace footing::reconstruction
