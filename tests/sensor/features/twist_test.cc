#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/sensor/features/cycle.h"
#include "tests/sensor/features/chain.h"

/// Wrists and arms that twist while they swing.
namespace footing::features {
namespace {

using wrists::HandMotion;
using wrists::Segment;

Segment Twisted(double frequency_hz, double duration_s, double amplitude_mps2, double roll_deg) {
  return {duration_s, frequency_hz, kPi, amplitude_mps2, DegreesToRadians(roll_deg), 0};
}

TEST(Twist, HandsThatSwingInTurnsAreNeverSeenTogetherWhileBothTwist) {
  for (const double f : {1.0, 1.3, 2.0, 3.0}) {
    for (const double blend_s : {0.15, 0.3, 0.6}) {
      std::vector<Segment> segments;
      for (const double roll_deg : {0.0, 20.0, -20.0, 0.0}) {
        segments.push_back(Twisted(f, 2, 7, roll_deg));
      }
      const HandMotion motion(segments, wrists::WristShape(), blend_s);
      for (const auto& instant : RunChain(motion)) {
        if (instant.t_s < 1.9 || !instant.rig.pairs[0].phase_valid) continue;
        EXPECT_GT(std::abs(instant.rig.pairs[0].phase_rad), DegreesToRadians(80))
            << f << " Hz, twist in " << blend_s << " s, at " << instant.t_s;
      }
    }
  }
}

/// The longest time for which a hand's frequency is off by more than a fifth.
double LongestError(const HandMotion& motion, double frequency_hz) {
  double longest_s = 0;
  double since_s[2] = {-1, -1};
  for (const auto& instant : RunChain(motion)) {
    if (instant.t_s < 2) continue;
    for (std::size_t hand = 0; hand < 2; ++hand) {
      const auto& device = instant.rig.devices[hand];
      const bool wrong =
          device.frequency_valid && std::abs(device.frequency_hz / frequency_hz - 1) > 0.2;
      if (wrong && since_s[hand] < 0) since_s[hand] = instant.t_s;
      if (wrong) longest_s = std::max(longest_s, instant.t_s - since_s[hand]);
      if (!wrong) since_s[hand] = -1;
    }
  }
  return longest_s;
}

TEST(Twist, AReversalKeepsTheFrequency) {
  for (const double f : {0.8, 1.0, 1.3, 2.0, 3.0}) {
    for (const double blend_s : {0.0, 0.3, 0.6}) {
      for (const double roll_deg : {20.0, 35.0}) {
        std::vector<Segment> segments;
        for (const double sign : {0.0, 1.0, -1.0, 1.0, 0.0}) {
          segments.push_back(Twisted(f, 2.3, 10, sign * roll_deg));
        }
        EXPECT_EQ(LongestError(HandMotion(segments, wrists::WristShape(), blend_s), f), 0)
            << f << " Hz, " << roll_deg << " degrees in " << blend_s << " s";
      }
    }
  }
}

TEST(Twist, ATrueChangeOfFrequencyIsStillSeen) {
  const HandMotion motion({Twisted(2, 3, 8, 20), Twisted(1, 4, 8, -20)}, wrists::WristShape(),
                          0.15);
  const auto instants = RunChain(motion);
  EXPECT_NEAR(instants.back().rig.devices[0].frequency_hz, 1, 0.05);
}

TEST(Pair, HandsOfDifferentFrequencyHaveNoPhase) {
  RigFeatureExtractor rig = TwoHands();
  const auto of = [](double frequency_hz, std::uint64_t seed) {
    Segment swing = Twisted(frequency_hz, 20, 8, 0);
    return Samples(HandMotion({swing}, wrists::Shape(), 0), {}, seed);
  };
  const auto slow = of(0.5, 1), fast = of(4.5, 2);
  for (std::size_t i = 0; i + 1 < slow.size(); i += 2) {
    rig.AddSample(slow[i]);      // Left.
    rig.AddSample(fast[i + 1]);  // Right.
    const auto features = rig.Compute(slow[i].sampled_ns);
    EXPECT_FALSE(features.pairs[0].phase_valid) << i / 2 << " samples";
  }
}

TEST(Pair, ControllersTurnedAgainstEachOtherHaveThePhaseOfTheirSwings) {
  for (const double turned_deg : {0.0, 30.0, 45.0, 55.0}) {
    for (const double phase_rad : {0.0, 1.5, kPi}) {
      RigFeatureExtractor rig = TwoHands();
      const auto of = [&](double side, double start_rad) {
        wrists::Shape shape;
        const double angle = side * DegreesToRadians(turned_deg);
        shape.direction_S = {std::sin(angle), std::cos(angle), 0.3};
        const Segment swing = Twisted(1.3, 6, 8, 0);
        return Samples(HandMotion({swing}, shape, 0, start_rad), {}, 5);
      };
      const auto left = of(1, 0), right = of(-1, phase_rad);
      stream::RigFeatures features;
      for (std::size_t i = 0; i < left.size(); i += 2) {
        rig.AddSample(left[i]);
        stream::MotionSample sample = right[i];  // The left hand of that motion, as the right one.
        sample.device = kRight;
        rig.AddSample(sample);
        features = rig.Compute(sample.sampled_ns);
      }
      ASSERT_TRUE(features.pairs[0].phase_valid) << turned_deg;
      EXPECT_LT(std::abs(WrapAngle(features.pairs[0].phase_rad - phase_rad)), 0.1)
          << turned_deg << " degrees, phase " << phase_rad;
    }
  }
}

/// Level remotes whose swing is `from_deg` off their fronts for 3 s, and then in 0.5 s `by_deg`
/// more, right the mirror image at first; 1.3 Hz, alternately. The features after 8 s.
stream::RigFeatures TurnedWhileSwinging(double from_deg, double by_deg) {
  RigFeatureExtractor rig = TwoHands();
  stream::RigFeatures features;
  for (int i = 0; i < 800; ++i) {
    const double t_s = 0.01 * i;
    const double more_deg = by_deg * std::clamp((t_s - 3) / 0.5, 0.0, 1.0);
    for (const bool left : {true, false}) {
      const double angle = DegreesToRadians((left ? from_deg : -from_deg) + more_deg);
      const double swing_mps2 = 6 * std::sin(2 * kPi * 1.3 * t_s + (left ? 0 : kPi));
      stream::MotionSample sample;
      sample.device = left ? kLeft : kRight;
      sample.sampled_ns = sample.received_ns = SecondsToNanoseconds(1 + t_s);
      sample.specific_force_mps2 =
          Eigen::Vector3d(0, 0, -kStandardGravityMps2) +
          swing_mps2 * Eigen::Vector3d(std::sin(angle), std::cos(angle), 0.05);
      sample.filtered_mps2 = sample.specific_force_mps2;
      rig.AddSample(sample);
    }
    features = rig.Compute(SecondsToNanoseconds(1 + t_s));
  }
  return features;
}

TEST(Pair, ControllersThatAreTurnedOnWhileTheySwingKeepTheirPhaseAndTheirSide) {
  // Grips of 45 degrees, mirrored, and a twist of 42 and of 52: the left one is turned by up to 97.
  for (const double by_deg : {42.0, 52.0, -52.0}) {
    const stream::RigFeatures features = TurnedWhileSwinging(45, by_deg);
    ASSERT_TRUE(features.pairs[0].phase_valid && !features.pairs[0].phase_held) << by_deg;
    EXPECT_NEAR(std::abs(features.pairs[0].phase_rad), kPi, 0.1) << by_deg;
    ASSERT_TRUE(features.devices[0].swing_valid && features.devices[1].swing_valid);
    const double mean_rad = (features.devices[0].swing_rad + features.devices[1].swing_rad) / 2;
    EXPECT_NEAR(RadiansToDegrees(mean_rad), by_deg, 1) << by_deg;
  }
}

TEST(SwingDirection, GoesOnFromWhereItWasUpToHowFarHandsTurn) {
  const auto line = [](double deg) {
    return SwingLine{true, DegreesToRadians(deg), Eigen::Vector3d::UnitX(),
                     Eigen::Vector3d::UnitZ()};
  };
  const CycleConfig config;
  EXPECT_FALSE(Next(SwingEnd{}, line(80), config).known);
  const SwingEnd held = Next(SwingEnd{}, line(50), config);
  EXPECT_TRUE(held.known);
  EXPECT_NEAR(Continued(line(-80), held, config).angle_rad, DegreesToRadians(100), 1e-9);
  EXPECT_EQ(Continued(line(-80), held, config).along, -Eigen::Vector3d::UnitX());
  EXPECT_NEAR(Continued(line(-50), held, config).angle_rad, DegreesToRadians(-50), 1e-9);
  EXPECT_TRUE(Next(held, SwingLine{}, config).known);
}

/// Rows of a swing along `direction` about `mean`.
Eigen::Matrix<double, Eigen::Dynamic, 3> SwingRows(const Eigen::Vector3d& mean,
                                                   const Eigen::Vector3d& direction) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> rows(100, 3);
  for (int i = 0; i < 100; ++i) {
    rows.row(i) = (mean + std::sin(2 * kPi * i / 100) * direction).transpose();
  }
  return rows;
}

TEST(SwingDirection, IsThatOfTheHorizontalSwingAgainstTheSensorsFront) {
  const Eigen::Vector3d hanging(0, 0, -kStandardGravityMps2);
  const Eigen::Vector3d pointing_down(0, -kStandardGravityMps2, 0);
  for (const double angle_deg : {-80.0, -30.0, 0.0, 25.0, 89.0}) {
    const double angle = DegreesToRadians(angle_deg);
    // Face up the front is y; with the front down it is -z. Left is x in both. The vertical part of
    // the swing says nothing.
    const Eigen::Vector3d face_up(5 * std::sin(angle), 5 * std::cos(angle), 9);
    const auto up = FindSwing(SwingRows(hanging, face_up), hanging, {});
    ASSERT_TRUE(up.valid);
    EXPECT_NEAR(up.angle_rad, angle, 1e-9);
    EXPECT_NEAR(std::abs(up.along.dot(face_up.normalized())), 5 / face_up.norm(), 1e-9);
    const Eigen::Vector3d front_down(5 * std::sin(angle), 9, -5 * std::cos(angle));
    EXPECT_NEAR(FindSwing(SwingRows(pointing_down, front_down), pointing_down, {}).angle_rad, angle,
                1e-9);
  }
}

TEST(SwingDirection, IsNotKnownOfASwingUpAndDownOrOfARound) {
  const Eigen::Vector3d up(0, 0, -kStandardGravityMps2);
  EXPECT_FALSE(FindSwing(SwingRows(up, {0, 0, 8}), up, {}).valid);
  auto round = SwingRows(up, {5, 0, 0});
  for (int i = 0; i < 100; ++i) round(i, 1) = 5 * std::cos(2 * kPi * i / 100);
  EXPECT_FALSE(FindSwing(round, up, {}).valid);
  const Eigen::Vector3d on_its_side(kStandardGravityMps2, 0, 0);
  EXPECT_FALSE(FindSwing(SwingRows(on_its_side, {0, 5, 0}), on_its_side, {}).valid);
}

}  // namespace
}  // namespace footing::features
