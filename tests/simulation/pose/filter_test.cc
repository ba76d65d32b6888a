#include "daemon/simulation/pose/inertial_filter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace footing::inertial {
namespace {

constexpr double kFeltAtRestMps2 = 9.80665;

arms::HandReading Felt(double forwards_mps2) {
  arms::HandReading reading;
  reading.specific_force_S_mps2 = {forwards_mps2, 0, kFeltAtRestMps2};
  return reading;
}

/// Depth along x.
Filter::Observation Seen() {
  Filter::Observation seen;
  seen.covariance_m2.diagonal() << 0.004 * 0.004, 0.00006 * 0.00006, 0.00006 * 0.00006;
  return seen;
}

Filter AtRestFor(double duration_s) {
  constexpr double kReadingS = 1.0 / 180;
  Filter filter;
  filter.Start(Seen(), Eigen::Matrix3d::Identity(), 0.03);
  for (int i = 1; i * kReadingS < duration_s; ++i) {
    filter.Advance(Felt(0), Felt(0), kReadingS, Filter::Trust::kMeasured);
    if (i % 3 == 0) filter.Update(Seen());
  }
  return filter;
}

TEST(InertialFilter, WeighsAnObservationByWhatTheCameraReports) {
  Filter filter;
  filter.Start(Seen(), Eigen::Matrix3d::Identity(), 0.03);
  Filter::Observation again = Seen();
  again.p_W_m.y() = 0.0002;
  // Two observations with 0.06 mm each across the line of sight.
  EXPECT_NEAR(filter.Distance(again), 0.2 * 0.2 / (2 * 0.06 * 0.06), 0.4);
}

TEST(InertialFilter, PredictsAHandTheLessSurelyTheMoreItAccelerates) {
  constexpr double kStepS = 0.014;
  for (const double forwards_mps2 : {0.0, 3.0, 20.0}) {
    Filter held = AtRestFor(1), measured = held;
    held.Advance(Felt(forwards_mps2), Felt(forwards_mps2), kStepS, Filter::Trust::kHeld);
    measured.Advance(Felt(forwards_mps2), Felt(forwards_mps2), kStepS, Filter::Trust::kMeasured);
    // An acceleration that walks: 2 sd² / 0.1 s in a second, with 1 m/s² for a hand at rest. Its
    // double integral has a twentieth of that times the fifth power of time.
    const double walk = 2 * (1 + forwards_mps2 * forwards_mps2) / 0.1;
    const double place_m2 = walk * std::pow(kStepS, 5) / 20;
    const double speed_m2ps2 = walk * std::pow(kStepS, 3) / 3;
    const Filter::Covariance more = held.covariance() - measured.covariance();
    EXPECT_NEAR(more(1, 1), place_m2, 0.02 * place_m2) << forwards_mps2;
    EXPECT_NEAR(more(4, 4), speed_m2ps2, 0.02 * speed_m2ps2) << forwards_mps2;
  }
}

}  // namespace
}  // namespace footing::inertial
