#include "daemon/offline/learning/board_loads.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "daemon/offline/learning/alignment.h"

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

}  // namespace
}  // namespace footing::learning
