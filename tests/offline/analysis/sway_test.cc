#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "daemon/offline/analysis/sway.h"

namespace footing::posturography {
namespace {

/// A person of 600 N whose COP is at (x, y), at time_s.
CornerSample Standing600(double time_s, double x_m, double y_m) {
  const double right = x_m / 0.433;  // Share beyond one half on the right.
  const double top = y_m / 0.238;
  return {time_s, 600 * (0.5 - right) * (0.5 + top), 600 * (0.5 + right) * (0.5 + top),
          600 * (0.5 - right) * (0.5 - top), 600 * (0.5 + right) * (0.5 - top)};
}

TEST(Board, CentreOfPressureIsWhereTheForcesBalance) {
  const Standing standing = FindStanding({Standing600(0, 0.05, -0.03)}, {});
  ASSERT_EQ(standing.samples, 1u);
  EXPECT_NEAR(standing.weight_n, 600, 1e-9);
  EXPECT_NEAR(standing.stretches[0][0].x_m, 0.05, 1e-12);
  EXPECT_NEAR(standing.stretches[0][0].y_m, -0.03, 1e-12);
}

TEST(Board, SteppingOffEndsAStretch) {
  std::vector<CornerSample> samples;
  for (int k = 0; k < 10; ++k) samples.push_back(Standing600(0.01 * k, 0.01, 0));
  samples.push_back({0.1, 1, 1, 1, 1});  // 4 N: nobody.
  for (int k = 11; k < 20; ++k) samples.push_back(Standing600(0.01 * k, -0.01, 0));
  const Standing standing = FindStanding(samples, {});
  ASSERT_EQ(standing.stretches.size(), 2u);
  EXPECT_EQ(standing.samples, 19u);
  EXPECT_EQ(Measure(standing.stretches).path_m, 0);  // Nobody walked the 2 cm between.
}

TEST(Board, AGapInTheRecordingEndsAStretchAndIsCounted) {
  std::vector<CopSample> samples = {{0, 0, 0}, {0.01, 0, 0}, {0.02, 0, 0}, {0.41, 1, 0}};
  const Standing cut = SplitAtGaps(samples);
  EXPECT_EQ(cut.stretches.size(), 2u);  // 0.39 s is longer than 0.2 s.
  EXPECT_EQ(cut.gaps.count, 1u);
  EXPECT_NEAR(cut.gaps.longest_s, 0.39, 1e-12);
  EXPECT_NEAR(cut.gaps.seconds, 0.39, 1e-12);
  samples[3].time_s = 0.2;
  EXPECT_EQ(SplitAtGaps(samples).stretches.size(), 1u);
  EXPECT_EQ(SplitAtGaps(samples).gaps.count, 0u);
}

TEST(Board, TimeOffTheBoardIsNotAGap) {
  std::vector<CornerSample> samples;
  for (int k = 0; k < 10; ++k) samples.push_back(Standing600(0.01 * k, 0, 0));
  samples.push_back({0.1, 1, 1, 1, 1});
  for (int k = 0; k < 10; ++k) samples.push_back(Standing600(9 + 0.01 * k, 0, 0));
  samples.push_back(Standing600(12, 0, 0));
  const Standing standing = FindStanding(samples, {});
  EXPECT_EQ(standing.stretches.size(), 3u);
  EXPECT_EQ(standing.gaps.count, 1u);
  EXPECT_NEAR(standing.gaps.seconds, 2.91, 1e-9);
}

TEST(Board, AnEmptyBoardHasNoWeight) {
  EXPECT_EQ(FindStanding({{0, 1, 1, 1, 1}, {0.01, 2, 2, 2, 2}}, {}).weight_n, 0);
  EXPECT_EQ(FindStanding({}, {}).weight_n, 0);
}

TEST(Board, WeightIsNotMovedByStepsOnAndOff) {
  std::vector<CornerSample> samples;
  for (int k = 0; k < 5; ++k) samples.push_back({0.01 * k, 20 + 10.0 * k, 20, 20, 20});
  for (int k = 5; k < 50; ++k) samples.push_back(Standing600(0.01 * k, 0, 0));
  EXPECT_NEAR(FindStanding(samples, {}).weight_n, 600, 1e-9);
}

/// A circle of radius 10 mm at 0.25 Hz over 20 s, at uneven times: 60 Hz with every interval
/// between 0.3 and 1.7 of the mean one (a fixed sequence, fractions of multiples of the golden
/// ratio).
std::vector<CopSample> UnevenCircle() {
  std::vector<CopSample> samples;
  double time_s = 0;
  for (int k = 0; time_s < 20; ++k) {
    const double angle = 2 * kPi * 0.25 * time_s;
    samples.push_back({time_s, 0.01 * std::cos(angle), 0.01 * std::sin(angle)});
    time_s += (0.3 + 1.4 * std::fmod(k * 0.6180339887498949, 1.0)) / 60;
  }
  return samples;
}

TEST(Resample, GivesEvenTimesFromTheFirstSampleOn) {
  const std::vector<CopSample> even = Resample(UnevenCircle(), 25, 0.08);
  ASSERT_GE(even.size(), 499u);
  for (std::size_t k = 0; k < even.size(); ++k) {
    EXPECT_DOUBLE_EQ(even[k].time_s, static_cast<double>(k) / 25);
  }
}

TEST(Resample, KeepsACircleWithinTheWindowsAttenuation) {
  // A window of w attenuates a tone of f by sinc(f w): 0.9993 at 0.25 Hz and 0.08 s.
  const Sway sway = Measure({Resample(UnevenCircle(), 25, 0.08)});
  EXPECT_NEAR(sway.rms_radial_m, 0.01, 0.01 * 0.005);
  // The speed on the circle is 2 pi 0.25 Hz 10 mm.
  EXPECT_NEAR(sway.mean_velocity_mps, 2 * kPi * 0.25 * 0.01, 2 * kPi * 0.25 * 0.01 * 0.02);
}

TEST(Resample, AConstantStaysWhateverTheTimes) {
  std::vector<CopSample> samples = UnevenCircle();
  for (CopSample& sample : samples) sample.x_m = sample.y_m = 0.125;
  for (const CopSample& sample : Resample(samples, 50, 0.25)) {
    EXPECT_NEAR(sample.x_m, 0.125, 1e-15);
    EXPECT_NEAR(sample.y_m, 0.125, 1e-15);
  }
}

TEST(Resample, WeighsASampleByTheTimeItStandsFor) {
  // Within the window [0, 2] around 1, the sample at 0 stands for [0, 0.25], that at 0.5 for
  // [0.25, 1.25], that at 2 for [1.25, 2]: (0.25 * 0 + 1 * 4 + 0.75 * 8) / 2 = 5.
  const std::vector<CopSample> samples = {{0, 0, 0}, {0.5, 4, 0}, {2, 8, 0}};
  const std::vector<CopSample> even = Resample(samples, 1, 2);
  ASSERT_EQ(even.size(), 3u);
  EXPECT_DOUBLE_EQ(even[1].x_m, 5);
}

TEST(Resample, OneSampleAndEqualTimesGiveThatSample) {
  const std::vector<CopSample> one = {{3, 1, 2}};
  ASSERT_EQ(Resample(one, 100, 0.02).size(), 1u);
  EXPECT_EQ(Resample(one, 100, 0.02)[0].x_m, 1);
  const std::vector<CopSample> two = {{3, 1, 2}, {3, 1, 2}};
  EXPECT_EQ(Resample(two, 100, 0.02)[0].y_m, 2);
}

using Signal = std::function<CopSample(double time_s)>;

/// 3000 samples at 100 Hz, as in cop_reference.csv.
Sway MeasureSignal(const Signal& signal) {
  std::vector<CopSample> samples;
  for (int k = 0; k < 3000; ++k) samples.push_back(signal(k / 100.0));
  return Measure({samples});
}

CopSample Circle(double t) {
  return {t, 0.010 * std::cos(2 * kPi * t), 0.010 * std::sin(2 * kPi * t)};
}
/// 5 mm ML, 12 mm AP, 0.5 Hz.
CopSample Ellipse(double t) { return {t, 0.005 * std::sin(kPi * t), 0.012 * std::cos(kPi * t)}; }

/// Two tones each way: 4 and 1.5 mm ML, 7 and 2 mm AP.
CopSample TwoTone(double t) {
  const double x = 4 * std::sin(2 * kPi * 0.3 * t) + 1.5 * std::sin(2 * kPi * 1.1 * t + 0.4);
  const double y = 7 * std::sin(2 * kPi * 0.2 * t + 0.9) + 2 * std::sin(2 * kPi * 0.9 * t);
  return {t, x / 1000, y / 1000};
}

TEST(Sway, CircleHasItsClosedForms) {
  const Sway sway = MeasureSignal(Circle);
  // 2999 chords of a polygon of 100 corners, radius 10 mm: each 2 r sin(pi / 100).
  EXPECT_NEAR(sway.path_m, 2999 * 0.02 * std::sin(kPi / 100), 1e-12);
  EXPECT_NEAR(sway.duration_s, 29.99, 1e-12);
  EXPECT_NEAR(sway.mean_velocity_mps, sway.path_m / 29.99, 1e-15);
  EXPECT_NEAR(sway.rms_x_m, 0.010 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(sway.rms_y_m, 0.010 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(sway.rms_radial_m, 0.010, 1e-12);
  EXPECT_NEAR(sway.mean_distance_m, 0.010, 1e-12);
  EXPECT_NEAR(sway.range_x_m, 0.020, 1e-12);
  EXPECT_NEAR(sway.range_y_m, 0.020, 1e-12);
  EXPECT_NEAR(sway.circle95_m2, kPi * 1e-4, 1e-12);  // All distances are equal: no spread.
  // Covariance r^2/2 n/(n - 1) times the identity.
  const double det_root = 0.5e-4 * 3000 / 2999;
  EXPECT_NEAR(sway.ellipse95_chi_square_m2, kPi * -2 * std::log(0.05) * det_root, 1e-12);
  EXPECT_NEAR(sway.ellipse95_prieto_m2, 6 * kPi * det_root, 1e-12);
  // Each triangle: r^2/2 sin(2 pi / 100).
  EXPECT_NEAR(sway.sway_area_rate_m2ps, 2999 * 0.5e-4 * std::sin(kPi / 50) / 29.99, 1e-12);
  // One turn a second; the polygon is shorter than the circle by sin(x)/x, x = pi / 100.
  EXPECT_NEAR(sway.mean_frequency_hz, std::sin(kPi / 100) / (kPi / 100), 1e-9);
}

TEST(Sway, FQuantileFulfilsItsDistribution) {
  // P(F > f) = (1 + 2 f / d)^(-d / 2) for 2 and d degrees of freedom.
  for (const double degrees : {1.0, 10.0, 2998.0}) {
    EXPECT_NEAR(std::pow(1 + 2 * FQuantile95(degrees) / degrees, -degrees / 2), 0.05, 1e-12);
  }
  EXPECT_NEAR(FQuantile95(10), 4.1028, 5e-5);  // Printed tables of F(0.95; 2, 10).
}

TEST(Sway, EllipsesAxesFollowARotation) {
  // Axes 12 mm and 5 mm, the long one turned 30 degrees from x.
  const double turn = kPi / 6;
  const Sway sway = MeasureSignal([&](double t) {
    const double u = 0.012 * std::cos(kPi * t), v = 0.005 * std::sin(kPi * t);
    return CopSample{t, u * std::cos(turn) - v * std::sin(turn),
                     u * std::sin(turn) + v * std::cos(turn)};
  });
  const double factor = std::sqrt(0.5 * 3000 / 2999);
  EXPECT_NEAR(sway.ellipse_axis_major_sd_m, 0.012 * factor, 1e-9);
  EXPECT_NEAR(sway.ellipse_axis_minor_sd_m, 0.005 * factor, 1e-9);
  EXPECT_NEAR(sway.ellipse_angle_rad, turn, 1e-9);
}

TEST(Sway, NothingIsMeasuredBetweenStretches) {
  const std::vector<CopSample> here = {{0, 0, 0}, {1, 0.001, 0}};
  const std::vector<CopSample> there = {{5, 0.1, 0}, {6, 0.101, 0}};
  const Sway sway = Measure({here, there});
  EXPECT_NEAR(sway.path_m, 0.002, 1e-12);
  EXPECT_NEAR(sway.duration_s, 2, 1e-12);
}

TEST(Sway, AtRestEverythingIsZeroAndFinite) {
  const Sway sway = MeasureSignal([](double t) { return CopSample{t, 0.25, -0.5}; });
  EXPECT_EQ(sway.path_m, 0);
  EXPECT_EQ(sway.ellipse95_prediction_m2, 0);
  EXPECT_EQ(sway.mean_frequency_hz, 0);
  EXPECT_EQ(sway.ellipse_angle_rad, 0);
}

/// The rows of the reference table by their names.
std::map<std::string, std::map<std::string, double>> ReadReference(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const auto cells = [](const std::string& text) {
    std::vector<std::string> out;
    std::istringstream stream(text);
    for (std::string cell; std::getline(stream, cell, ',');) out.push_back(cell);
    return out;
  };
  const std::vector<std::string> names = cells(line);
  std::map<std::string, std::map<std::string, double>> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> values = cells(line);
    for (std::size_t i = 1; i < values.size(); ++i) {
      rows[values[0]][names[i]] = std::stod(values[i]);
    }
  }
  return rows;
}

void ExpectEqual(const Sway& sway, const std::map<std::string, double>& expected) {
  const std::map<std::string, double> measured = {
      {"path_length_mm", sway.path_m * 1e3},
      {"path_ml", sway.path_x_m * 1e3},
      {"path_ap", sway.path_y_m * 1e3},
      {"mean_velocity_mm_s", sway.mean_velocity_mps * 1e3},
      {"mean_velocity_ml", sway.mean_velocity_x_mps * 1e3},
      {"mean_velocity_ap", sway.mean_velocity_y_mps * 1e3},
      {"rms_ml", sway.rms_x_m * 1e3},
      {"rms_ap", sway.rms_y_m * 1e3},
      {"rms_radial", sway.rms_radial_m * 1e3},
      {"mean_distance", sway.mean_distance_m * 1e3},
      {"range_ml", sway.range_x_m * 1e3},
      {"range_ap", sway.range_y_m * 1e3},
      {"ellipse95_area_chi2", sway.ellipse95_chi_square_m2 * 1e6},
      {"ellipse95_area_prieto_F3", sway.ellipse95_prieto_m2 * 1e6},
      {"prediction_ellipse95_F", sway.ellipse95_prediction_m2 * 1e6},
      {"sway_area_mm2_s", sway.sway_area_rate_m2ps * 1e6},
      {"circle95_area", sway.circle95_m2 * 1e6},
      {"axis_major_sd", sway.ellipse_axis_major_sd_m * 1e3},
      {"axis_minor_sd", sway.ellipse_axis_minor_sd_m * 1e3}};
  for (const auto& [name, value] : measured) {
    ASSERT_TRUE(expected.count(name)) << name;
    EXPECT_NEAR(value, expected.at(name), 1e-6 * std::abs(expected.at(name))) << name;
  }
}

TEST(Sway, AgreesWithTheReferenceTableInAllItsColumns) {
  const char* data = std::getenv("FOOTING_TEST_DATA");
  if (data == nullptr || *data == '\0') GTEST_SKIP() << "FOOTING_TEST_DATA is not set";
  const auto reference = ReadReference(std::string(data) + "/stats/cop_reference.csv");
  ASSERT_EQ(reference.size(), 3u);
  ExpectEqual(MeasureSignal(Circle), reference.at("circle_r10mm_1Hz"));
  ExpectEqual(MeasureSignal(Ellipse), reference.at("ellipse_ap12_ml5_0.5Hz"));
  ExpectEqual(MeasureSignal(TwoTone), reference.at("two_tone"));
}

}  // namespace
}  // namespace footing::posturography
