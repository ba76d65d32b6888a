#include "daemon/offline/analysis/sway.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include "common/base/units.h"

namespace footing::posturography {
namespace {

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
