#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "common/body/kinematics.h"
#include "daemon/offline/learning/cascade.h"
#include "daemon/offline/learning/horizontal_com.h"
#include "daemon/offline/learning/time_alignment.h"

namespace footing::learning {
namespace {

constexpr double kGravityMps2 = 9.80665;
constexpr double kRadps = 2 * std::numbers::pi * 0.5;

body::Body Person() {
  body::PersonParameters person;
  person.mass_kg = 70;
  person.height_m = 1.75;
  return body::MakeBody(body::StandardPerson(1.75), person).value();
}

/// The T-pose carried through `seconds` as a whole.
template <typename Carry>
motion::Motion MovedAsAWhole(const body::Body& person, double seconds, const Carry& carry) {
  motion::Motion motion{.skeleton = person.skeleton, .rate_hz = 120, .start_s = 0, .q = {}};
  const Eigen::VectorXd pose = body::TPose(person.skeleton, person.landmarks);
  motion.q = pose.replicate(1, static_cast<Eigen::Index>(120 * seconds));
  for (Eigen::Index t = 0; t < motion.q.cols(); ++t) {
    motion.q.col(t).head<3>() += carry(static_cast<double>(t) / 120);
  }
  return motion;
}

double Weight(const LoadFrame& frame) {
  return std::accumulate(frame.load.begin(), frame.load.end(), 0.0);
}

constexpr BoardLoadSettings kExact = {.noise_kg = 0, .limited = false};

TEST(BoardLoads, OfABodyStandingStillAreItsWeightUnderItsCom) {
  const body::Body person = Person();
  const motion::Motion still = Aligned(
      MovedAsAWhole(person, 1, [](double) { return Eigen::Vector3d(3, 4, 5); }), person.landmarks);
  for (const LoadFrame& frame : BoardLoads(still, person, kExact, 1)) {
    EXPECT_NEAR(Weight(frame), 1, 1e-9);
    // The sharing between the soles weighs the COP against evenness: it is met within 1 mm.
    EXPECT_LT((*Cop(frame) - frame.c_W_m).norm(), 1e-3);
    EXPECT_NEAR(frame.c_W_m.y(), 0, 1e-3) << "half way between the feet";
    EXPECT_NEAR(frame.load[0] + frame.load[1] + frame.load[2] + frame.load[3], 0.5, 1e-3);
  }
}

TEST(BoardLoads, FollowNewtonWhenTheBodyIsCarriedAsAWhole) {
  // GIVEN 3 cm forward and 5 cm up at 0.5 Hz, without any turning,
  // THEN weight = 1 + z'' / g and COP = c - (height / (g weight)) x''.
  const body::Body person = Person();
  const auto carry = [](double t_s) {
    return Eigen::Vector3d(0.03 * std::sin(kRadps * t_s), 0, 0.05 * std::cos(kRadps * t_s));
  };
  motion::Motion motion = MovedAsAWhole(person, 4, carry);
  const LoadClip clip = BoardLoads(motion, person, kExact, 1);
  ASSERT_GT(clip.size(), 200u);
  body::Kinematics at(person.skeleton);
  ComputeKinematics(person.skeleton, body::TPose(person.skeleton, person.landmarks), at);
  const double height_m = CentreOfMass(person, at).z();
  for (std::size_t i = 10; i + 10 < clip.size(); ++i) {
    const double t_s = static_cast<double>(i) / 60;
    const Eigen::Vector3d a_mps2 = -kRadps * kRadps * carry(t_s);
    EXPECT_NEAR(Weight(clip[i]), 1 + a_mps2.z() / kGravityMps2, 1e-3);
    const double lever_s2 = (height_m + carry(t_s).z()) / (kGravityMps2 + a_mps2.z());
    EXPECT_NEAR(Cop(clip[i])->x(), clip[i].c_W_m.x() - lever_s2 * a_mps2.x(), 1e-3);
  }
}

TEST(BoardLoads, MirroredAreThoseOfTheMirrorImage) {
  const body::Body person = Person();
  const motion::Motion motion = MovedAsAWhole(person, 3, [](double t_s) {
    return Eigen::Vector3d(0.02 * std::sin(kRadps * t_s), 0.04 * std::cos(kRadps * t_s), 0);
  });
  BoardLoadSettings settings = kExact;
  settings.mirrored = true;
  const LoadClip plain = BoardLoads(motion, person, kExact, 1);
  const LoadClip mirrored = BoardLoads(motion, person, settings, 1);
  ASSERT_EQ(mirrored.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_NEAR(mirrored[i].c_W_m.x(), plain[i].c_W_m.x(), 1e-9);
    EXPECT_NEAR(mirrored[i].c_W_m.y(), -plain[i].c_W_m.y(), 1e-9);
    // Left front (0) is right front's (5) image, left rear outside (2) right rear outside (7).
    EXPECT_NEAR(mirrored[i].load[0], plain[i].load[5], 1e-9);
    EXPECT_NEAR(mirrored[i].load[7], plain[i].load[2], 1e-9);
  }
}

TEST(BoardLoads, NoiseIsThatOfTheSettings) {
  const body::Body person = Person();
  const motion::Motion still =
      MovedAsAWhole(person, 20, [](double) { return Eigen::Vector3d::Zero(); });
  BoardLoadSettings settings = kExact;
  settings.noise_kg = 0.1;
  const LoadClip clean = BoardLoads(still, person, kExact, 1);
  const LoadClip noisy = BoardLoads(still, person, settings, 1);
  double square = 0;
  for (std::size_t i = 0; i < clean.size(); ++i)
    square += std::pow(Weight(noisy[i]) - Weight(clean[i]), 2);
  // Eight cells of 0.1 kg under 70 kg. Four standard errors: 4 / sqrt(2 x 1200) = 8 %.
  const double expected = std::sqrt(8) * 0.1 / 70;
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(clean.size())), expected, 0.08 * expected);
}

TEST(Aligned, IsTheSameHoweverTheMotionWasTurnedAndPlaced) {
  const body::Body person = Person();
  motion::Motion motion = MovedAsAWhole(
      person, 1, [](double t_s) { return Eigen::Vector3d(0.1 * t_s, 0.05 * t_s, 0.02 * t_s); });
  motion::Motion turned = motion;
  const double yaw_rad = 2.5;
  const Eigen::Matrix3d R = body::AxisRotation(body::Axis::kZ, yaw_rad);
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    const Eigen::Matrix3d R_WJ = JointRotation(person.skeleton.joint(0), motion.q.col(t));
    SetJointRotation(person.skeleton.joint(0), R * R_WJ, turned.q.col(t));
    turned.q.col(t).head<3>() = R * motion.q.col(t).head<3>() + Eigen::Vector3d(7, -3, 0.4);
  }
  const motion::Motion a = Aligned(motion, person.landmarks);
  const motion::Motion b = Aligned(turned, person.landmarks);
  EXPECT_LT((a.q - b.q).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT((motion.q - turned.q).cwiseAbs().maxCoeff(), 1);
}

TEST(Aligned, UnwrapsAngles) {
  const body::Body person = Person();
  motion::Motion motion = MovedAsAWhole(person, 1, [](double) { return Eigen::Vector3d::Zero(); });
  const int elbow = person.skeleton.dof - 1;
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    motion.q(elbow, t) = std::remainder(0.1 * static_cast<double>(t), 2 * std::numbers::pi);
  }
  const motion::Motion aligned = Aligned(motion, person.landmarks);
  EXPECT_NEAR(aligned.q(elbow, 119) - aligned.q(elbow, 0), 11.9, 1e-9);
}

LoadClip HorizontalComNumbered(int frames) {
  LoadClip clip(static_cast<std::size_t>(frames));
  for (int t = 0; t < frames; ++t) {
    auto& frame = clip[static_cast<std::size_t>(t)];
    for (std::size_t k = 0; k < momentum::kNetworkCells; ++k)
      frame.load[k] = 100 * t + static_cast<int>(k);
    frame.c_W_m = {1000 + t, -1000 - t};
  }
  return clip;
}

TEST(HorizontalExamples, AreThePapersInputsAndOutputOfEachAxis) {
  const std::vector<LoadClip> clips = {HorizontalComNumbered(5), HorizontalComNumbered(3),
                                       HorizontalComNumbered(4)};
  const Examples x = HorizontalExamples(clips, 0), y = HorizontalExamples(clips, 1);
  ASSERT_EQ(x.rows(), 2 + 0 + 1);  // No row reaches from one clip into the next.
  ASSERT_EQ(x.inputs.cols(), 20);
  // Second row: t = 3.
  EXPECT_EQ(x.inputs(1, 0), 200);  // F(t-1), first cell
  EXPECT_EQ(x.inputs(1, 7), 207);
  EXPECT_EQ(x.inputs(1, 8), 300);    // F(t)
  EXPECT_EQ(x.inputs(1, 16), 1001);  // c(t-2)
  EXPECT_EQ(x.inputs(1, 17), 1002);
  EXPECT_EQ(x.inputs(1, 18), 1003);   // c(t)
  EXPECT_EQ(x.inputs(1, 19), -1003);  // The other axis.
  EXPECT_EQ(x.targets(1, 0), 1004);   // c(t+1)
  EXPECT_EQ(y.inputs(1, 16), -1001);
  EXPECT_EQ(y.inputs(1, 19), 1003);
  EXPECT_EQ(y.targets(1, 0), -1004);
}

TEST(MakeSway, ObeysThePendulumWithinTheNoise) {
  const LoadClip clip = MakeSway({.seconds = 20, .rate_hz = 60, .noise_sd = 0}, 3);
  ASSERT_EQ(clip.size(), 1200u);
  double worst_m = 0;
  for (std::size_t t = 1; t + 1 < clip.size(); ++t) {
    const double weight = std::accumulate(clip[t].load.begin(), clip[t].load.end(), 0.0);
    const auto sum = [&](std::initializer_list<int> cells) {
      double loads = 0;
      for (const int k : cells) loads += clip[t].load[static_cast<std::size_t>(k)];
      return loads;
    };
    const double cop_x_m = 0.119 * (sum({0, 1, 4, 5}) - sum({2, 3, 6, 7})) / weight;
    const Eigen::Vector2d acceleration_mps2 =
        (clip[t + 1].c_W_m - 2 * clip[t].c_W_m + clip[t - 1].c_W_m) * 3600;
    // c - cop = height / (g weight) c'': between heights of 0.6 m and 1.4 m.
    const double lever_m = (clip[t].c_W_m.x() - cop_x_m) * 9.80665 * weight;
    const double low_m = 0.6 * acceleration_mps2.x(), high_m = 1.4 * acceleration_mps2.x();
    worst_m =
        std::max({worst_m, std::min(low_m, high_m) - lever_m, lever_m - std::max(low_m, high_m)});
  }
  EXPECT_LT(worst_m, 0.01);
  EXPECT_NE(MakeSway({}, 3)[100].c_W_m, MakeSway({}, 4)[100].c_W_m);
}

TEST(ClosedLoop, DivergesWithoutNoiseInTrainingAndComesBackWithIt) {
  // Section 4.2 says nothing of this: a network with a perfect past is a double integrator.
  const LoadClip train = MakeSway({.seconds = 40, .rate_hz = 60, .noise_sd = 0.0013}, 1);
  const LoadClip fresh = MakeSway({.seconds = 40, .rate_hz = 60, .noise_sd = 0.0013}, 2);
  CascadeOptions options;
  options.hidden_max = 3;
  const auto trained = [&](int axis, double noise_m) {
    const Examples examples = WithFeedbackNoise(
        HorizontalExamples({&train, 1}, axis),
        {.groups = FeedbackColumns(), .common_sd = noise_m, .own_sd = noise_m / 10, .copies = 1},
        5);
    return TrainCascade(examples, {}, options, 6).network;
  };
  const auto x_clean = trained(0, 0), y_clean = trained(1, 0);
  EXPECT_LT(MeanSquaredError(x_clean, HorizontalExamples({&fresh, 1}, 0)), 1e-8) << "0.1 mm a step";
  const Eigen::Vector2d clean_m = ClosedLoopError({x_clean, y_clean}, fresh);
  EXPECT_GT(clean_m.maxCoeff(), 0.2);
  const Eigen::Vector2d noisy_m = ClosedLoopError({trained(0, 0.02), trained(1, 0.02)}, fresh);
  EXPECT_LT(noisy_m.maxCoeff(), 0.06);
  EXPECT_TRUE(clean_m.allFinite() && noisy_m.allFinite());
}

TEST(RolledOutExamples, HaveTheNetworksOwnPastAndTheTrueFuture) {
  const LoadClip clip = MakeSway({.seconds = 8, .rate_hz = 60, .noise_sd = 0.0013}, 1);
  CascadeOptions options;
  options.hidden_max = 0;
  const auto trained = [&](int axis) {
    return TrainCascade(HorizontalExamples({&clip, 1}, axis), {}, options, 6).network;
  };
  const Networks networks{trained(0), trained(1)};
  const Examples truth = HorizontalExamples({&clip, 1}, 0);
  const Examples own = RolledOutExamples(networks, {&clip, 1}, 0, 2);
  ASSERT_EQ(own.rows(), truth.rows());
  EXPECT_EQ(own.targets, truth.targets);
  EXPECT_EQ(own.inputs.leftCols(16), truth.inputs.leftCols(16)) << "loads";
  for (const Eigen::Index start : {0, 120, 240}) {
    EXPECT_EQ(own.inputs.row(start), truth.inputs.row(start)) << "begun from the truth";
  }
  // The row after a start has the network's answer to the start as c(t).
  std::vector<float> inputs;
  for (const double value : own.inputs.row(120)) inputs.push_back(static_cast<float>(value));
  std::array<float, 1> answer{};
  networks[0].Evaluate(inputs, answer);
  EXPECT_NEAR(own.inputs(121, 18), answer[0], 1e-6);
  EXPECT_NE(own.inputs(121, 18), truth.inputs(121, 18));
}

TEST(PartsInPlace, AreTheLongRunsNearTheOrigin) {
  LoadClip clip(600);
  clip[100].c_W_m = {0.5, 0};    // 100 frames before it: under three seconds.
  clip[350].c_W_m = {0, -0.41};  // 249 and 249 around it.
  const auto parts = PartsInPlace(clip);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].size(), 249u);
  EXPECT_EQ(parts[1].size(), 249u);
}

}  // namespace
}  // namespace footing::learning
