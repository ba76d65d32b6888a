#include "daemon/simulation/reconstruction/reconstruction.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "tests/simulation/allocations.h"
#include "tests/simulation/reconstruction/made_world.h"

namespace footing::reconstruction {
namespace {

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
      // Some of them fit badly, and say so.
      EXPECT_EQ(reconstruction.output().valid, reconstruction.output().misfit < 2) << bits;
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

TEST(Reconstruction, IsNotValidWhileWhatIsMeasuredFitsNoPose) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate());
  const auto chest_sd_m = [&] {
    const int joint = world.person.landmarks[body::Landmark::kNeck];
    return reconstruction.output().joint_sd_m[static_cast<std::size_t>(joint)];
  };
  constexpr std::size_t kFar = 400, kBack = 460;  // Hands beyond any reach of these feet, for 1 s.
  for (std::size_t i = 0; i < kFar; ++i) reconstruction.Advance(world.inputs[i]);
  EXPECT_LT(reconstruction.output().misfit, 1);
  EXPECT_TRUE(reconstruction.output().valid);
  const double sure_m = chest_sd_m();
  for (std::size_t i = kFar; i < kBack; ++i) {
    Inputs inputs = world.inputs[i];
    for (HandInput& hand : inputs.hands) hand.p_W_m.x() += 0.8;
    reconstruction.Advance(inputs);
  }
  EXPECT_GT(reconstruction.output().misfit, 2);
  EXPECT_FALSE(reconstruction.output().valid);
  EXPECT_GT(chest_sd_m(), 1.5 * sure_m);
  // The mean over half a second of at most 25 at once is under 2 after 0.5 s ln(25 / 2) = 1.3 s.
  for (std::size_t i = kBack; i < kBack + 90; ++i) reconstruction.Advance(world.inputs[i]);
  EXPECT_TRUE(reconstruction.output().valid);
}

TEST(Reconstruction, IsNotValidWhileAFootHasJustSteppedAhead) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate());
  constexpr std::size_t kStep = 400;
  for (std::size_t i = 0; i < kStep; ++i) reconstruction.Advance(world.inputs[i]);
  EXPECT_TRUE(reconstruction.output().valid);
  for (std::size_t i = kStep; i < kStep + 6; ++i) {
    Inputs inputs = world.inputs[i];
    for (momentum::Cell& cell : inputs.loads.feet[0].cells) cell.p_WS_m.x() += 0.5;
    reconstruction.Advance(inputs);
  }
  EXPECT_TRUE(reconstruction.output().momentum.trusted);
  EXPECT_LT(reconstruction.output().misfit, 2) << "fits, so far";
  EXPECT_FALSE(reconstruction.output().valid);
}

TEST(Reconstruction, InFlightTheBodyMayBeWhereTheHandsAre) {
  World world;
  Reconstruction reconstruction = world.Made(world.AtRate());
  constexpr std::size_t kTakeOff = 400, kFlightFrames = 12;  // 0.2 s, at 0.6 m/s.
  constexpr double kFrameM = 0.01;
  for (std::size_t i = 0; i < kTakeOff; ++i) reconstruction.Advance(world.inputs[i]);
  const Output stood = reconstruction.output();
  for (std::size_t i = 1; i <= kFlightFrames; ++i) {
    Inputs inputs = world.inputs[kTakeOff];
    inputs.loads.time_s = world.inputs[kTakeOff + i - 1].loads.time_s;
    for (momentum::FootLoads& foot : inputs.loads.feet) {
      for (std::size_t k = 0; k < 4; ++k) foot.cells[k].load_n = 0;
    }
    for (HandInput& hand : inputs.hands) hand.p_W_m.x() += kFrameM * static_cast<double>(i);
    reconstruction.Advance(inputs);
  }
  const Output& flown = reconstruction.output();
  const double gone_m = stood.com_W_m.x() + kFrameM * kFlightFrames - flown.com_W_m.x();
  EXPECT_GT(gone_m, 0.08) << "nothing but the hands shows it";
  EXPECT_LT(gone_m, 2 * std::sqrt(flown.com_variance_m2.x()));
  EXPECT_LT(std::sqrt(stood.com_variance_m2.x()), 0.05);
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
