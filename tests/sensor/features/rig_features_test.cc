#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "common/base/units.h"
#include "daemon/sensor/features/cycle.h"
#include "daemon/sensor/features/rig_features.h"
#include "daemon/sensor/features/sample_grid.h"
#include "tests/sensor/features/chain.h"

/// How two controllers lie in their hands, rotated about their fronts.
namespace footing::features {
namespace {

using Eigen::Vector3d;

/// Gravity in S of a forearm `raised_deg` above hanging, whose controller is rotated by `grip_deg`.
Vector3d Gravity(double raised_deg, double grip_deg) {
  const double raised_rad = DegreesToRadians(raised_deg);
  const Vector3d buttons_up(0, -std::cos(raised_rad), -std::sin(raised_rad));
  return kStandardGravityMps2 *
         (Eigen::AngleAxisd(DegreesToRadians(grip_deg), Vector3d::UnitY()) * buttons_up);
}

PairGrip After(double seconds, const Vector3d& left, const Vector3d& right, PairGrip grip = {}) {
  for (double t_s = 0; t_s < seconds; t_s += 0.01) grip = Next(grip, left, right, false, 0.01, {});
  return grip;
}

/// A force that both hands feel along the same way of their forearms, as the right one reads it.
TEST(PairGrip, BringsTheRightSensorsAxesToThoseOfTheLeftHand) {
  const Vector3d force(3, -2, 5);
  for (const double raised_deg : {15.0, 85.0}) {
    for (const double left_deg : {-45.0, 0.0, 45.0}) {
      for (const double right_deg : {-45.0, 0.0, 45.0, 60.0}) {
        const PairGrip grip =
            After(0.1, Gravity(raised_deg, left_deg), Gravity(raised_deg, right_deg));
        const auto read = [&](double grip_deg) -> Vector3d {
          return Eigen::AngleAxisd(DegreesToRadians(grip_deg), Vector3d::UnitY()) * force;
        };
        EXPECT_LT((grip.FromRight() * read(right_deg) - read(left_deg)).norm(), 1e-9)
            << raised_deg << " degrees raised, grips " << left_deg << ", " << right_deg;
      }
    }
  }
}

TEST(PairGrip, IsNoneUntilGravityShowsIt) {
  EXPECT_EQ(PairGrip().FromRight(), Eigen::Matrix3d::Identity());
  // Forearms that hang straight down show nothing, and one hand alone neither.
  EXPECT_EQ(After(1, Gravity(3, 45), Gravity(3, -45)).seen_s, 0);
  EXPECT_EQ(Next({}, Gravity(85, 45), std::nullopt, false, 0.01, {}).seen_s, 0);
}

TEST(PairGrip, OfHandsAtRestCountsUntilTheySwing) {
  const Vector3d left = Gravity(85, 45), right = Gravity(85, -45), level = Gravity(85, 0);
  // The moment in which a swing begins is not a rest.
  PairGrip rest = Next({}, left, right, true, 0.01, {});
  EXPECT_EQ(rest.seen_s, 0);
  for (int i = 0; i < 40; ++i) rest = Next(rest, left, right, true, 0.01, {});
  EXPECT_NEAR(std::arg(rest.turn_m2ps4), std::arg(After(1, left, right).turn_m2ps4), 1e-9);
  // Swings of a few seconds outweigh what the rest before them showed,
  const PairGrip swung = After(4, level, level, rest);
  EXPECT_NEAR(std::arg(swung.turn_m2ps4), 0, DegreesToRadians(5));
  // and remotes that are put down between two of them change nothing.
  EXPECT_EQ(Next(swung, left, right, true, 0.01, {}).turn_m2ps4, swung.turn_m2ps4);
}

}  // namespace

/// The parts that the features are made of.
namespace {

void Add(SampleGrid& grid, double t_s, const Eigen::Vector3d& force, bool repeated = false) {
  stream::MotionSample sample;
  sample.sampled_ns = static_cast<std::int64_t>(std::llround(t_s * 1e9));
  sample.specific_force_mps2 = sample.filtered_mps2 = force;
  sample.repeated = repeated;
  grid.Add(sample);
}

TEST(SampleGrid, PointsLieOnTheLineBetweenSamples) {
  SampleGrid grid{Config{}};
  Add(grid, 0.003, {0, 0, 0});
  Add(grid, 0.043, {4, 0, 0});
  ASSERT_EQ(grid.size(), 4);
  // Points at 10, 20, 30, 40 ms: (t - 3 ms) / 40 ms * 4.
  EXPECT_NEAR(grid.Raw(4)(0, 0), 0.7, 1e-12);
  EXPECT_NEAR(grid.Raw(4)(3, 0), 3.7, 1e-12);
}

TEST(SampleGrid, KeepsItsNewestPointsForEver) {
  SampleGrid grid{Config{}};
  for (int i = 0; i < 5000; ++i) Add(grid, 0.01 * i, {static_cast<double>(i), 0, 0});
  ASSERT_EQ(grid.size(), kGridLength);
  EXPECT_NEAR(grid.Raw(kGridLength)(0, 0), 5000 - kGridLength, 1e-6);
  EXPECT_NEAR(grid.Raw(1)(0, 0), 4999, 1e-6);
}

TEST(SampleGrid, ForgetsAcrossAPause) {
  SampleGrid grid{Config{}};
  for (int i = 0; i < 50; ++i) Add(grid, 0.01 * i, {1, 0, 0});
  Add(grid, 1.0, {2, 0, 0});
  EXPECT_EQ(grid.size(), 1);
}

TEST(CycleWeights, AddUpToTheCycleAndIntegrateALine) {
  for (const double steps : {22.0, 22.2, 57.9, 1.5}) {
    const Eigen::ArrayXd weights = CycleWeights(steps);
    EXPECT_NEAR(weights.sum(), steps, 1e-12);
    // The line y = x from -steps to 0: its integral is -steps² / 2.
    const auto count = weights.size();
    const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(count, 1.0 - count, 0.0);
    EXPECT_NEAR((weights * x).sum(), -0.5 * steps * steps, 1e-9);
  }
}

TEST(FindPeriod, IsSharperThanATwentiethOfAGridStep) {
  SampleGrid grid{Config{}};
  constexpr double kPeriodS = 0.4637;
  for (int i = 0; i < 300; ++i) {
    Add(grid, 0.01 * i, {0, 5 * std::sin(2 * kPi * 0.01 * i / kPeriodS), -9.81});
  }
  const auto estimate = FindPeriod(grid, grid.size(), 0, CadenceConfig{});
  ASSERT_TRUE(estimate.found);
  EXPECT_NEAR(estimate.period_s, kPeriodS, kGridStepS / 20);
}

TEST(FindPeriod, FindsNoneInALine) {
  SampleGrid grid{Config{}};
  for (int i = 0; i < 300; ++i) Add(grid, 0.01 * i, {0, 0.02 * i, -9.81});
  EXPECT_FALSE(FindPeriod(grid, grid.size(), 0, CadenceConfig{}).found);
}

TEST(PrintedCorrelation, WeighsNewerSamplesMore) {
  Eigen::Matrix<double, 3, 3> one = Eigen::Matrix<double, 3, 3>::Zero();
  one.col(1) << 1, 2, 4;
  Eigen::Matrix<double, 5, 3> other = Eigen::Matrix<double, 5, 3>::Zero();
  other.col(1) << 1, 0, 2, 3, 1;
  other.col(2) << 9, 9, 9, 9, 9;
  // W is 1/3, 2/3, 1. Lag 0: 1 * 2 / 3 + 2 * 3 * 2 / 3 + 4 * 1; lag 1: 0 + 2 * 2 * 2 / 3 + 4 * 3;
  // lag 2: 1 * 1 / 3 + 0 + 4 * 2.
  const Eigen::ArrayXd curve = PrintedCorrelation(one, other);
  ASSERT_EQ(curve.size(), 3);
  EXPECT_NEAR(curve(0), 26.0 / 3, 1e-12);
  EXPECT_NEAR(curve(1), 44.0 / 3, 1e-12);
  EXPECT_NEAR(curve(2), 25.0 / 3, 1e-12);
}

TEST(PeriodAsPrinted, IsTheLagOfTheFirstHighPeak) {
  // A pulse each half second, every other one lower: Ra(0.5 s) / Ra(1 s) is 2 lower / (1 + lower²),
  // which is 0.99 or 0.38, and peaks from 0.8 on count.
  for (const auto& [lower, period_s] : {std::pair{0.9, 0.5}, std::pair{0.2, 1.0}}) {
    SampleGrid grid{Config{}};
    for (int i = 0; i < 400; ++i) {
      Add(grid, 0.01 * i, {0, i % 100 == 0 ? 1.0 : i % 100 == 50 ? lower : 0.0, 0});
    }
    const PeriodEstimate estimate = PeriodAsPrinted(grid, AsPrinted());
    ASSERT_TRUE(estimate.found);
    EXPECT_NEAR(estimate.period_s, period_s, 1e-9);
  }
}

TEST(PeriodAsPrinted, MovesWithTheMeanWhereOursDoesNot) {
  SampleGrid grid{Config{}};
  for (int i = 0; i < 400; ++i) {
    Add(grid, 0.01 * i, {0, 0, 4 * std::sin(2 * kPi * 0.01 * i / 0.8) - kStandardGravityMps2});
  }
  const PeriodEstimate printed = PeriodAsPrinted(grid, AsPrinted());
  ASSERT_TRUE(printed.found);
  EXPECT_NEAR(printed.period_s, 0.8, 0.08);
  EXPECT_GT(std::abs(printed.period_s - 0.8), 0.003);
  EXPECT_NEAR(FindPeriod(grid, grid.size(), 0, CadenceConfig{}).period_s, 0.8, kGridStepS / 20);
}

TEST(PhaseAsPrinted, IsTheLagOfThePeakWithinOneCycle) {
  // Pulses each half second, the right hand's 20 points before the left one's: aR(t - 0.2 s) is
  // aL(t), so the right one leads by 2 pi 20 / 50.
  SampleGrid left{Config{}}, right{Config{}};
  for (int i = 0; i < 150; ++i) {
    Add(left, 0.01 * i, {0, i % 50 == 40 ? 1.0 : 0.0, 3});
    Add(right, 0.01 * i, {0, i % 50 == 20 ? 1.0 : 0.0, -5});
  }
  const PhaseEstimate estimate = PhaseAsPrinted(left, right, 0.5);
  ASSERT_TRUE(estimate.found);
  EXPECT_NEAR(estimate.phase_rad, 0.8 * kPi, 1e-4);
  EXPECT_NEAR(PhaseAsPrinted(right, left, 0.5).phase_rad, -0.8 * kPi, 1e-4);
  // Two cycles of 0.8 s are more than there is.
  EXPECT_FALSE(PhaseAsPrinted(left, right, 0.8).found);
}

TEST(FeaturesAsPrinted, AreTheNewestEstimatesOfRawSamples) {
  EXPECT_FALSE(Named("papers"));
  const wrists::HandMotion motion(
      {{.duration_s = 5, .frequency_hz = 1.5, .phase_rad = kPi, .amplitude_mps2 = 40},
       {.duration_s = 2}},
      {.direction_S = {1, 0, 0}}, 0, 0);
  const std::vector<Member> members = {{kLeft, stream::DeviceRole::kLeftHand},
                                       {kRight, stream::DeviceRole::kRightHand}};
  RigFeatureExtractor ours("a", members, *Named("best")), printed("a", members, *Named("paper"));
  stream::RigFeatures swinging, best_swinging, stopped, best_stopped;
  for (const auto& sample : Samples(motion, {})) {
    ours.AddSample(sample);
    printed.AddSample(sample);
    if (sample.device != kRight) continue;
    const double t_s = NanosecondsToSeconds(sample.sampled_ns - kNanosecondsPerSecond);
    (t_s < 5 ? swinging : stopped) = printed.Compute(sample.sampled_ns);
    (t_s < 5 ? best_swinging : best_stopped) = ours.Compute(sample.sampled_ns);
  }
  const stream::DeviceFeatures& hand = swinging.devices[0];
  EXPECT_NEAR(hand.frequency_hz, 1.5, 0.1);
  ASSERT_TRUE(swinging.pairs[0].phase_valid);
  EXPECT_GT(std::abs(swinging.pairs[0].phase_rad), kPi - DegreesToRadians(20));
  // Clipped samples are filled in by ours; the raw ones end at 3 g.
  EXPECT_NEAR(best_swinging.devices[0].amplitude_mps2, 40, 2);
  EXPECT_NEAR(hand.amplitude_mps2, 3 * kStandardGravityMps2, 0.5);
  EXPECT_FALSE(hand.held);
  EXPECT_FALSE(stopped.devices[0].moving);
  EXPECT_FALSE(stopped.devices[0].frequency_valid);
  EXPECT_FALSE(stopped.pairs[0].phase_valid);
  EXPECT_FALSE(best_stopped.devices[0].moving);
}

TEST(Cadence, AJumpMustPersistForAQuarterOfTheOldPeriod) {
  const CadenceConfig config;
  Cadence cadence = Next({}, {true, 1.0, 1}, {}, 0.01, config);
  for (int i = 0; i < 25; ++i) {
    cadence = Next(cadence, {true, 0.5, 1}, {}, 0.01, config);
    EXPECT_EQ(cadence.period_s, 1.0) << i;
  }
  for (int i = 0; i < 2; ++i) cadence = Next(cadence, {true, 0.5, 1}, {}, 0.01, config);
  EXPECT_EQ(cadence.period_s, 0.5);
}

TEST(Cadence, AJumpOfOneHandAloneIsNotOne) {
  const CadenceConfig config;
  const Partner partner{{true, 1.0, 1}, 1.0};
  Cadence cadence = Next({}, {true, 1.0, 1}, partner, 0.01, config);
  for (int i = 0; i < 190; ++i) cadence = Next(cadence, {true, 0.5, 1}, partner, 0.01, config);
  EXPECT_EQ(cadence.period_s, 1.0);
  for (int i = 0; i < 20; ++i) cadence = Next(cadence, {true, 0.5, 1}, partner, 0.01, config);
  EXPECT_EQ(cadence.period_s, 0.5);  // Two cycles later it is.
}

TEST(Cadence, OfTwoPeriodsThatSpanSeveralOfTheOtherHandsAJumpToThatIsOneAtOnce) {
  const CadenceConfig config;
  const Partner none, partner{{}, 1.0};  // Its newest samples show nothing for a moment.
  const Cadence two = Next({}, {true, 2.0, 1}, none, 0.01, config);
  EXPECT_TRUE(SpansSeveral(two, partner, config));
  EXPECT_FALSE(SpansSeveral(two, none, config));
  EXPECT_EQ(Next(two, {true, 1.02, 1}, partner, 0.01, config).period_s, 1.02);
  // Another one than the other hand's has to persist, and so has a longer one.
  EXPECT_EQ(Next(two, {true, 0.5, 1}, partner, 0.01, config).period_s, 2.0);
  const Cadence one = Next({}, {true, 1.0, 1}, none, 0.01, config);
  EXPECT_FALSE(SpansSeveral(one, {{}, 2.0}, config));
  EXPECT_EQ(Next(one, {true, 2.0, 1}, {{}, 2.0}, 0.01, config).period_s, 1.0);
}

TEST(Cadence, ALossIsBridgedForOneCycle) {
  const CadenceConfig config;
  Cadence cadence = Next({}, {true, 0.5, 1}, {}, 0.01, config);
  for (int i = 0; i < 49; ++i) cadence = Next(cadence, {}, {}, 0.01, config);
  EXPECT_TRUE(cadence.valid);
  for (int i = 0; i < 2; ++i) cadence = Next(cadence, {}, {}, 0.01, config);
  EXPECT_FALSE(cadence.valid);
}

TEST(Inclination, BeyondOneGIsARightAngleNotNan) {
  EXPECT_EQ(InclinationOf({12, -12, 0}).roll_rad, kPi / 2);
  EXPECT_EQ(InclinationOf({12, -12, 0}).pitch_rad, -kPi / 2);
}

TEST(Inclination, OfAFasterSwingKeepsTheRotationAboutTheFront) {
  for (const double rotation_rad : {-2.0, -0.7, 0.0, 0.7, 2.0}) {
    const Vector3d level(std::sin(rotation_rad), 0, -std::cos(rotation_rad));
    for (const double size_mps2 : {9.8, 13.0}) {
      const Inclination found = InclinationOf(size_mps2 * (level + Vector3d(0, -0.4, 0)));
      EXPECT_TRUE(found.axial_valid);
      EXPECT_NEAR(found.axial_rad, rotation_rad, 1e-12);
    }
  }
  EXPECT_FALSE(InclinationOf({0.5, -9.8, -0.5}).axial_valid) << "hangs straight down";
}

}  // namespace

/// Hands that swing together are seen before their period is.
namespace {

using wrists::HandMotion;
using wrists::Segment;
using wrists::Shape;

/// 3 s of sines of 1 Hz, from `angle_rad` on.
SampleGrid Sine(double angle_rad, double amplitude_mps2) {
  SampleGrid grid{Config{}};
  for (int i = 0; i < 300; ++i) {
    stream::MotionSample sample;
    sample.sampled_ns = i * kGridStepNs;
    sample.specific_force_mps2 = sample.filtered_mps2 =
        Eigen::Vector3d(0, amplitude_mps2 * std::sin(angle_rad + 2 * kPi * i * kGridStepS), -9.81);
    grid.Add(sample);
  }
  return grid;
}

/// Correlation of controllers that lie alike in both hands.
double Correlation(const SampleGrid& left, const SampleGrid& right, double span_s) {
  return CorrelationNow(left, right, Eigen::Matrix3d::Identity(), span_s);
}

TEST(CorrelationNow, IsOneTogetherAndMinusOneInTurnsOverAnySpan) {
  for (const double angle_rad : {0.0, 0.7, 1.6, 2.5}) {
    const SampleGrid left = Sine(angle_rad, 5);
    for (const double span_s : {0.25, 0.4, 1.0, 2.1}) {
      EXPECT_NEAR(Correlation(left, Sine(angle_rad, 8), span_s), 1, 1e-9) << span_s;
      EXPECT_NEAR(Correlation(left, Sine(angle_rad + kPi, 3), span_s), -1, 1e-9) << span_s;
    }
    // A quarter of a cycle apart, over a whole one: neither.
    EXPECT_NEAR(Correlation(left, Sine(angle_rad + kPi / 2, 5), 0.99), 0, 1e-9);
  }
}

TEST(CorrelationNow, IsZeroWithoutEnoughSamplesOrMotion) {
  EXPECT_EQ(Correlation(Sine(0, 5), Sine(0, 5), 3.5), 0);
  EXPECT_EQ(Correlation(Sine(0, 5), Sine(0, 0), 1), 0);
}

/// A run with bent arms, and what comes after it as the arms hang down: 50 degrees lower.
HandMotion AfterARun(double frequency_hz, double phase_rad, double start_angle_rad) {
  const Segment run{3, 1.9, kPi, 8, 0, DegreesToRadians(-20)};
  const Segment after{3, frequency_hz, phase_rad, 9, 0, DegreesToRadians(-70)};
  return HandMotion({run, after}, Shape(), 0.4, start_angle_rad);
}

/// As the interfaces read it.
bool ShowsTogether(const stream::RigFeatures& rig) {
  const stream::PairFeatures& pair = rig.pairs[0];
  return pair.phase_valid && !pair.phase_held && std::abs(pair.phase_rad) < kPi / 2;
}

class AfterARunFrom : public testing::TestWithParam<double> {};  // The hand's angle at the start.

TEST_P(AfterARunFrom, HandsTogetherAreSeenWithinACycleAndAHalf) {
  for (const double frequency_hz : {1.4, 2.4}) {
    double seen_s = INFINITY;
    for (const auto& instant : RunChain(AfterARun(frequency_hz, 0, GetParam()))) {
      if (instant.t_s > 3 && ShowsTogether(instant.rig)) seen_s = std::min(seen_s, instant.t_s - 3);
    }
    EXPECT_LT(seen_s, 1.5 / 1.9) << frequency_hz;
  }
}

TEST_P(AfterARunFrom, HandsInTurnsAreNeverTogether) {
  for (const double frequency_hz : {0.9, 1.4, 2.4, 3.0}) {
    for (const auto& instant : RunChain(AfterARun(frequency_hz, kPi + 0.3, GetParam()))) {
      EXPECT_FALSE(ShowsTogether(instant.rig)) << frequency_hz << " Hz, " << instant.t_s << " s";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Angles, AfterARunFrom, testing::Values(0.0, 1.3, 2.9, 4.6));

}  // namespace
}  // namespace footing::features
