#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/posturography/sway.h"

namespace footing::posturography {
namespace {

using Signal = std::function<CopSample(double time_s)>;

/// 3000 samples at 100 Hz, as in cop_reference.csv.
Sway MeasureSignal(const Signal& signal) {
  std::vector<CopSample> samples;
  for (int k = 0; k < 3000; ++k) samples.push_back(signal(k / 100.0));
  return Measure({samples}, 100);
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
  EXPECT_NEAR(sway.ml.rms_m, 0.010 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(sway.ap.rms_m, 0.010 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(sway.rms_radial_m, 0.010, 1e-12);
  EXPECT_NEAR(sway.mean_distance_m, 0.010, 1e-12);
  EXPECT_NEAR(sway.ml.range_m, 0.020, 1e-12);
  EXPECT_NEAR(sway.ap.range_m, 0.020, 1e-12);
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
  const Sway sway = Measure({here, there}, 0);
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

/// 30 s at 50 Hz of a function of time along x; y is at rest.
Sway MeasureAlongX(const std::function<double(double)>& x_m) {
  std::vector<CopSample> samples;
  for (int k = 0; k < 1500; ++k) samples.push_back({k / 50.0, x_m(k / 50.0), 0});
  return Measure({samples}, 50);
}

TEST(Spectrum, ATonesPowerIsAtItsFrequency) {
  const Sway sway =
      MeasureAlongX([](double t) { return 0.004 * std::sin(2 * kPi * 0.8 * t + 0.3); });
  // The tapers spread it over 0.15 Hz to either side, evenly but for their edges.
  EXPECT_NEAR(*sway.ml.median_frequency_hz, 0.8, 0.01);
  EXPECT_NEAR(*sway.ml.frequency95_hz, 0.8 + 0.9 * 0.15, 0.03);
  // Half of the squared amplitude.
  EXPECT_NEAR(*sway.ml.power_m2, 0.004 * 0.004 / 2, 0.02 * 8e-6);
  EXPECT_EQ(*sway.ap.power_m2, 0);
  EXPECT_FALSE(sway.ap.median_frequency_hz);
}

TEST(Spectrum, HalfOfThePowerOfTwoTonesLiesBelowTheStrongerOne) {
  const auto tones = [](double slow_m, double fast_m) {
    return MeasureAlongX([=](double t) {
      return slow_m * std::sin(2 * kPi * 0.5 * t) + fast_m * std::sin(2 * kPi * 2.5 * t);
    });
  };
  EXPECT_NEAR(*tones(0.005, 0.003).ml.median_frequency_hz, 0.5, 0.1);
  EXPECT_NEAR(*tones(0.003, 0.005).ml.median_frequency_hz, 2.5, 0.1);
  EXPECT_NEAR(*tones(0.005, 0.003).ml.frequency95_hz, 2.5, 0.2);
  // Beyond 5 Hz nothing counts.
  const Sway fast = MeasureAlongX([](double t) {
    return 0.001 * std::sin(2 * kPi * 1 * t) + 0.01 * std::sin(2 * kPi * 12 * t);
  });
  EXPECT_NEAR(*fast.ml.frequency95_hz, 1, 0.2);
}

TEST(Spectrum, NeedsTenSecondsAtAnEvenRate) {
  std::vector<CopSample> samples;
  for (int k = 0; k < 499; ++k) samples.push_back({k / 50.0, 0.01 * std::sin(0.1 * k), 0});
  EXPECT_FALSE(Measure({samples}, 50).ml.median_frequency_hz);
  samples.push_back({499 / 50.0, 0, 0});
  EXPECT_TRUE(Measure({samples}, 50).ml.median_frequency_hz);
  EXPECT_FALSE(Measure({samples}, 0).ml.median_frequency_hz);
  // Two stretches with the same tone have the spectrum of one.
  std::vector<CopSample> later = samples;
  for (CopSample& sample : later) sample.time_s += 20;
  EXPECT_NEAR(*Measure({samples, later}, 50).ml.median_frequency_hz,
              *Measure({samples}, 50).ml.median_frequency_hz, 1e-9);
}

/// By the definition, each pair of places looked at.
double EntropyByDefinition(const std::vector<double>& values) {
  double mean = 0, squares = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double r = 0.2 * std::sqrt(squares / static_cast<double>(values.size()));
  double alike = 0, alike_next = 0;
  for (std::size_t i = 0; i + 2 < values.size(); ++i) {
    for (std::size_t j = 0; j + 2 < values.size(); ++j) {
      if (i == j || std::abs(values[i] - values[j]) > r ||
          std::abs(values[i + 1] - values[j + 1]) > r) {
        continue;
      }
      ++alike;
      if (std::abs(values[i + 2] - values[j + 2]) <= r) ++alike_next;
    }
  }
  return -std::log(alike_next / alike);
}

TEST(SampleEntropy, IsThatOfItsDefinition) {
  std::vector<double> noise, sine;
  std::vector<CopSample> samples;
  std::uint32_t state = 1;
  for (int k = 0; k < 700; ++k) {
    state = state * 1664525u + 1013904223u;
    noise.push_back(1e-3 * (state >> 8) / double(1 << 24));
    sine.push_back(0.01 * std::sin(0.37 * k));
    samples.push_back({k / 50.0, noise.back(), sine.back()});
  }
  const Sway sway = Measure({samples}, 50);
  EXPECT_NEAR(*sway.ml.sample_entropy, EntropyByDefinition(noise), 1e-9);
  EXPECT_NEAR(*sway.ap.sample_entropy, EntropyByDefinition(sine), 1e-9);
  // Even noise: the chance that two values differ by at most r = 0.2 SD, (2 u - u^2) with
  // u = 0.2 / sqrt(12).
  const double u = 0.2 / std::sqrt(12.0);
  EXPECT_NEAR(*sway.ml.sample_entropy, -std::log(2 * u - u * u), 0.1);
}

TEST(SampleEntropy, IsNotDefinedWithoutPairsAlike) {
  const std::vector<CopSample> few = {{0, 0, 1}, {0.02, 1, 1}, {0.04, 5, 1}, {0.06, 9, 1}};
  EXPECT_FALSE(Measure({few}, 50).ml.sample_entropy);
  EXPECT_FALSE(Measure({few}, 50).ap.sample_entropy);
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

/// Names of the reference table whose names here end in units.
const std::map<std::string, std::string> kNamesHere = {
    {"path_ml", "path_ml_mm"},
    {"path_ap", "path_ap_mm"},
    {"mean_velocity_ml", "mean_velocity_ml_mm_s"},
    {"mean_velocity_ap", "mean_velocity_ap_mm_s"},
    {"rms_ml", "rms_ml_mm"},
    {"rms_ap", "rms_ap_mm"},
    {"rms_radial", "rms_radial_mm"},
    {"mean_distance", "mean_distance_mm"},
    {"range_ml", "range_ml_mm"},
    {"range_ap", "range_ap_mm"},
    {"ellipse95_area_chi2", "ellipse95_area_chi2_mm2"},
    {"ellipse95_area_prieto_F3", "ellipse95_area_prieto_F3_mm2"},
    {"prediction_ellipse95_F", "ellipse95_area_mm2"},
    {"circle95_area", "circle95_area_mm2"},
    {"axis_major_sd", "axis_major_sd_mm"},
    {"axis_minor_sd", "axis_minor_sd_mm"}};

void ExpectEqual(const Sway& sway, const std::map<std::string, double>& expected) {
  std::map<std::string, double> measured;
  for (const NamedMeasure& one : Named(sway)) {
    if (one.value) measured[one.key] = *one.value;
  }
  std::size_t compared = 0;
  for (const auto& [name, value] : expected) {
    if (name == "fs" || name == "samples") continue;
    const auto here = kNamesHere.find(name);
    const std::string key = here == kNamesHere.end() ? name : here->second;
    ASSERT_TRUE(measured.count(key)) << key;
    EXPECT_NEAR(measured[key], value, 1e-6 * std::abs(value)) << key;
    ++compared;
  }
  EXPECT_EQ(compared, 19u);
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
