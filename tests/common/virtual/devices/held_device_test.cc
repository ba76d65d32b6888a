#include "common/virtual/devices/held_device.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/kinematics.h"

namespace footing::virtual_sensors {
namespace {

body::Body Person() { return body::MakeBody(body::StandardPerson(1.75), {}).value(); }

TEST(HeldCourse, ATPoseThatSpinsFeelsGravityAndIsPulledInwards) {
  const body::Body person = Person();
  motion::Motion motion;
  motion.skeleton = person.skeleton;
  motion.rate_hz = 100;
  const Eigen::VectorXd pose = body::TPose(person.skeleton, person.landmarks);
  constexpr double kSpinRadps = 2;
  motion.q.resize(pose.size(), 400);
  Eigen::VectorXd q = pose;
  for (Eigen::Index i = 0; i < 400; ++i) {
    const double angle = kSpinRadps * static_cast<double>(i) / motion.rate_hz;
    body::SetJointRotation(person.skeleton.joint(0),
                           body::AxisRotation(body::Axis::kZ, angle) *
                               body::JointRotation(person.skeleton.joint(0), pose),
                           q);
    motion.q.col(i) = q;
  }
  body::Kinematics at(person.skeleton);
  body::ComputeKinematics(person.skeleton, pose, at);
  for (const int side : {0, 1}) {
    const HeldCourse course = FollowFist(person, motion, side);
    ASSERT_EQ(course.specific_force_S_mps2.cols(), 400);
    const body::Point fist = body::Fist(person, side);
    const auto joint = static_cast<std::size_t>(fist.joint);
    const Eigen::Vector3d from_axis =
        body::Place(fist, at.R_WJ[joint], at.p_WJ[joint]) - at.p_WJ[0];
    Eigen::Vector3d force = -kSpinRadps * kSpinRadps * from_axis;
    force.z() = kStandardGravityMps2;
    EXPECT_LT((course.specific_force_S_mps2.col(200) - force).norm(), 0.02);
    EXPECT_LT((course.angular_velocity_S_radps.col(200) - Eigen::Vector3d(0, 0, kSpinRadps)).norm(),
              0.001);
  }
}

TEST(HeldCourse, AStrappedDevicePointsOutwardsInTheTPose) {
  const body::Body person = Person();
  motion::Motion motion;
  motion.skeleton = person.skeleton;
  motion.rate_hz = 100;
  motion.q = body::TPose(person.skeleton, person.landmarks).replicate(1, 300);
  // The whole body rolls to its right about the axis ahead.
  constexpr double kRollRadps = 0.5;
  for (Eigen::Index i = 0; i < 300; ++i) {
    Eigen::VectorXd q = motion.q.col(i);
    body::SetJointRotation(
        person.skeleton.joint(0),
        body::AxisRotation(body::Axis::kX, kRollRadps * static_cast<double>(i) / motion.rate_hz) *
            body::JointRotation(person.skeleton.joint(0), q),
        q);
    motion.q.col(i) = q;
  }
  for (const int side : {0, 1}) {
    for (const ArmSegment segment : {ArmSegment::kUpperArm, ArmSegment::kForearm}) {
      const HeldCourse course = FollowSegment(person, motion, side, segment);
      // The axis ahead is to the right of what points left, and to the left of what points right.
      const Eigen::Vector3d turn(0, side == 0 ? -kRollRadps : kRollRadps, 0);
      EXPECT_LT((course.angular_velocity_S_radps.col(150) - turn).norm(), 0.001);
      // At first level: gravity along z but for the pull to the middle, less than 1 m away.
      EXPECT_NEAR(course.specific_force_S_mps2(2, 20), kStandardGravityMps2, 0.3);
      EXPECT_LT(std::abs(course.specific_force_S_mps2(1, 20)), 0.01);
    }
  }
}

HeldErrorConfig None() { return HeldErrors::None(); }

TEST(HeldErrors, EndAtTheRangeAndSaySo) {
  HeldErrors errors(None());
  const Eigen::Vector3d turn(1, -2, 3);
  HeldReading reading = errors.Advance({1, 2, 3}, turn, 0.01);
  EXPECT_EQ(reading.specific_force_S_mps2, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(reading.angular_velocity_S_radps, turn);
  EXPECT_FALSE(reading.clipped);
  reading = errors.Advance({1, -100, 3}, turn, 0.01);
  EXPECT_NEAR(reading.specific_force_S_mps2.y(), -3.6 * kStandardGravityMps2, 1e-9);
  EXPECT_TRUE(reading.clipped);
}

TEST(HeldErrors, AGripTurnsBothVectorsAlikeAndSeedsDiffer) {
  HeldErrorConfig config = None();
  config.grip_tilt_rad = 0.2;
  const Eigen::Vector3d force(1, 2, 9);
  Eigen::Vector3d seen[2];
  for (const std::uint64_t seed : {1u, 2u}) {
    config.seed = seed;
    HeldErrors errors(config);
    const HeldReading reading = errors.Advance(force, 0.1 * force, 0.01);
    seen[seed - 1] = reading.specific_force_S_mps2;
    EXPECT_NEAR(reading.specific_force_S_mps2.norm(), force.norm(), 1e-9);
    EXPECT_LT((reading.specific_force_S_mps2 - 10 * reading.angular_velocity_S_radps).norm(), 1e-9);
  }
  EXPECT_GT((seen[0] - seen[1]).norm(), 0.1);
}

TEST(HeldErrors, NoiseAndTheBiasWalkAreAsLargeAsSaid) {
  HeldErrorConfig config = None();
  config.turn_noise_radps = 0.006;
  config.turn_walk_radps_rt_s = 0.0003;
  double noise = 0, walk = 0;
  constexpr int kDevices = 200;
  for (std::uint64_t seed = 0; seed < kDevices; ++seed) {
    config.seed = seed;
    HeldErrors errors(config);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    noise += errors.Advance(zero, zero, 0.01).angular_velocity_S_radps.squaredNorm();
    for (int i = 0; i < 99; ++i) errors.Advance(zero, zero, 1);  // 99 s: 3 mrad/s.
    for (int i = 0; i < 100; ++i)
      sum += errors.Advance(zero, zero, 0.0001).angular_velocity_S_radps;
    walk += (sum / 100).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(noise / 3 / kDevices), 0.006, 0.0006);
  EXPECT_NEAR(std::sqrt(walk / 3 / kDevices), 0.003, 0.0004);
}

}  // namespace
}  // namespace footing::virtual_sensors
