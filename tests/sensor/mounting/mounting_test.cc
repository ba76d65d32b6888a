#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "common/base/units.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/devices/noise.h"
#include "daemon/sensor/mounting/mounting.h"

namespace footing::mounting {
namespace {

using Eigen::Vector3d;
using stream::DeviceRole;

Eigen::Quaterniond RandomRotation(noise::Random& random) {
  return Eigen::Quaterniond(random.Normal(), random.Normal(), random.Normal(), random.Normal())
      .normalized();
}

/// Samples at 100 Hz of a sensor mounted by `rotation_MS` that feels `force_M(t)` in M.
std::vector<stream::MotionSample> Record(const std::function<Vector3d(double)>& force_M,
                                         const Eigen::Quaterniond& rotation_MS, double seconds,
                                         std::uint64_t seed) {
  noise::Random random(seed);
  wrists::SensorModel sensor;
  sensor.quantum_mps2 = 0.092;
  std::vector<stream::MotionSample> samples;
  for (int i = 0; i < static_cast<int>(seconds * 100); ++i) {
    const auto reading = Read(sensor, rotation_MS.conjugate() * force_M(0.01 * i), random);
    stream::MotionSample sample;
    sample.sampled_ns = i * 10'000'000ll;
    sample.specific_force_mps2 = reading.specific_force_mps2;
    samples.push_back(sample);
  }
  return samples;
}

Vector3d Still(double) { return {0, 0, -kStandardGravityMps2}; }

/// From rest at 0.3 s, 1 Hz, first to the front for `first` 1, to the back for -1.
std::function<Vector3d(double)> Steps(double first) {
  return [first](double t_s) -> Vector3d {
    const double swing = t_s < 0.3 ? 0 : 8 * std::sin(2 * kPi * (t_s - 0.3));
    return Still(0) + first * swing * Vector3d(0.1, 0.6, 0.8);
  };
}

double ErrorRad(const Eigen::Quaterniond& found, const Eigen::Quaterniond& truth) {
  return found.angularDistance(truth);
}

TEST(Mounting, AnyRotationIsFoundForEveryRole) {
  noise::Random random(3);
  for (const auto& [role, first] : {std::pair{DeviceRole::kLeftHand, -1.0},
                                    {DeviceRole::kRightHand, 1.0},
                                    {DeviceRole::kLeftLeg, 1.0},
                                    {DeviceRole::kRightLeg, 1.0},
                                    {DeviceRole::kHead, 1.0},
                                    {DeviceRole::kTrunk, 1.0}}) {
    for (std::uint64_t i = 0; i < 40; ++i) {
      const auto truth = RandomRotation(random);
      const auto found = SolveMounting(role, Record(Still, truth, 2.1, i),
                                       Record(Steps(first), truth, 3, i + 100));
      ASSERT_TRUE(found.ok) << found.problem;
      // The made swing leans by atan(0.1 / 0.6) = 9.5 degrees out of the plane of front and down.
      EXPECT_NEAR(ErrorRad(found.rotation_MS, truth), std::atan2(0.1, 0.6), DegreesToRadians(2));
    }
  }
}

TEST(Mounting, TheFirstMovementDecidesBetweenFrontAndBack) {
  const Eigen::Quaterniond none = Eigen::Quaterniond::Identity();
  const auto still = Record(Still, none, 2.1, 1);
  const auto forward = SolveMounting(DeviceRole::kRightHand, still, Record(Steps(1), none, 3, 2));
  const auto back = SolveMounting(DeviceRole::kLeftHand, still, Record(Steps(-1), none, 3, 2));
  ASSERT_TRUE(forward.ok && back.ok);
  const Vector3d front = Vector3d::UnitY();
  EXPECT_GT((forward.rotation_MS * front).y(), 0.9);
  EXPECT_GT((back.rotation_MS * front).y(), 0.9);
}

TEST(Mounting, RefusesWhatIsNoStandingStill) {
  const Eigen::Quaterniond none = Eigen::Quaterniond::Identity();
  const auto steps = Record(Steps(1), none, 3, 2);
  const auto swaying = Record(Steps(1), none, 2.1, 1);
  EXPECT_NE(SolveMounting(DeviceRole::kLeftLeg, swaying, steps).problem.find("moved"),
            std::string::npos);
  EXPECT_NE(SolveMounting(DeviceRole::kLeftLeg, Record(Still, none, 1, 1), steps)
                .problem.find("are needed"),
            std::string::npos);
}

TEST(Mounting, RefusesStepsThatShowNoDirection) {
  const Eigen::Quaterniond none = Eigen::Quaterniond::Identity();
  const auto still = Record(Still, none, 2.1, 1);
  EXPECT_NE(SolveMounting(DeviceRole::kLeftLeg, still, Record(Still, none, 3, 2))
                .problem.find("no swing"),
            std::string::npos);
  const auto round = [](double t_s) -> Vector3d {
    return Still(0) + 5 * Vector3d(std::sin(2 * kPi * t_s), std::cos(2 * kPi * t_s), 0);
  };
  EXPECT_NE(SolveMounting(DeviceRole::kLeftLeg, still, Record(round, none, 3, 2))
                .problem.find("sideways"),
            std::string::npos);
}

TEST(Mounting, RefusesAFirstMovementThatIsNotClear) {
  const Eigen::Quaterniond none = Eigen::Quaterniond::Identity();
  // A small movement back, a third of the peak, before the swing to the front.
  const auto hesitant = [](double t_s) -> Vector3d {
    const double size = t_s < 0.5 ? 2.7 : 8;
    return Still(0) - size * std::sin(2 * kPi * t_s) * Vector3d::UnitY();
  };
  const auto starts_back = [hesitant](double t_s) { return hesitant(t_s < 0.5 ? t_s : t_s + 0.0); };
  EXPECT_NE(SolveMounting(DeviceRole::kLeftLeg, Record(Still, none, 2.1, 1),
                          Record(starts_back, none, 3, 2))
                .problem.find("not clear"),
            std::string::npos);
}

TEST(Mounting, RotatingMovesTheMarkOfAClippedAxis) {
  stream::MotionSample sample;
  sample.specific_force_mps2 = {0, 29, 0};
  sample.clipped_axes = 2;
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(kPi / 2, Vector3d::UnitZ()));
  const auto rotated = Rotated(quarter, sample);
  EXPECT_NEAR(rotated.specific_force_mps2.x(), -29, 1e-9);
  EXPECT_EQ(rotated.clipped_axes, 1u);
}

class SlipTest : public testing::Test {
 protected:
  /// `seconds` of a force of 1 g that leans by `lean_deg` to the side, plus a swing.
  bool Feel(SlipWatch& watch, double seconds, double lean_deg,
            const Eigen::Vector3d& swing_mps2 = Eigen::Vector3d::Zero()) {
    const double lean_rad = DegreesToRadians(lean_deg);
    for (int i = 0; i < static_cast<int>(seconds * 100); ++i) {
      now_ns_ += 10'000'000;
      stream::MotionSample sample;
      sample.sampled_ns = now_ns_;
      sample.specific_force_mps2 =
          kStandardGravityMps2 * Eigen::Vector3d(std::sin(lean_rad), 0, -std::cos(lean_rad)) +
          swing_mps2 * std::sin(2 * kPi * NanosecondsToSeconds(now_ns_));
      watch.Advance(sample);
    }
    return watch.slipped();
  }
  std::int64_t now_ns_ = 0;
};

TEST_F(SlipTest, AShinThatLeansAtRestHasSlipped) {
  SlipWatch watch(DeviceRole::kLeftLeg);
  EXPECT_FALSE(Feel(watch, 20, 15));
  EXPECT_FALSE(Feel(watch, 2, 40));
  EXPECT_FALSE(Feel(watch, 2, 0)) << "a moment is no slip";
  EXPECT_TRUE(Feel(watch, 4, 40));
  EXPECT_TRUE(Feel(watch, 20, 0)) << "stays until it is mounted anew";
}

TEST_F(SlipTest, AnArmHeldUpHasNotSlipped) {
  SlipWatch watch(DeviceRole::kRightHand);
  EXPECT_FALSE(Feel(watch, 60, 120));
}

TEST_F(SlipTest, AHeadMayLookDownAndATrunkLean) {
  for (const DeviceRole role : {DeviceRole::kHead, DeviceRole::kTrunk}) {
    SlipWatch watch(role);
    EXPECT_FALSE(Feel(watch, 60, 40));
    EXPECT_TRUE(Feel(watch, 5, 80));
  }
}

TEST_F(SlipTest, ABandThatTurnedAboutTheWristSwingsSideways) {
  SlipWatch watch(DeviceRole::kLeftHand);
  EXPECT_FALSE(Feel(watch, 30, 0, {0, 4, 3}));
  EXPECT_FALSE(Feel(watch, 5, 0, {4, 1, 3})) << "a wave to the side";
  EXPECT_FALSE(Feel(watch, 3, 0, {0, 4, 3}));
  EXPECT_TRUE(Feel(watch, 15, 0, {4, 1, 3}));
}

}  // namespace
}  // namespace footing::mounting
