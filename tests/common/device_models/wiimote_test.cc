#include "common/device_models/wiimote.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace footing::device_models {
namespace {

constexpr double kG = 9.80665;

Report SampleOf(Wiimote& wiimote, const Eigen::Vector3d& force) {
  wiimote.HandleOutput(Report{0x12, 0x04, 0x31});
  return wiimote.Sample(force).value();
}

/// 10-bit counts of a report 0x31.
std::array<int, 3> CountsOf(const Report& report) {
  return {report[3] << 2 | (report[1] >> 5 & 3), report[4] << 2 | (report[2] >> 4 & 2),
          report[5] << 2 | (report[2] >> 5 & 2)};
}

TEST(Wiimote, ItsCalibrationHasARightChecksumInBothCopies) {
  Wiimote wiimote(7);
  for (const std::size_t at : {0x16u, 0x20u}) {
    const auto block = wiimote.controller().memory().eeprom().subspan(at, 10);
    int sum = 0x55;
    for (std::size_t i = 0; i < 9; ++i) sum += block[i];
    EXPECT_EQ(block[9], sum & 0xff);
  }
}

TEST(Wiimote, CalibrationsDifferBetweenSeedsAndRepeatForOne) {
  EXPECT_EQ(Wiimote(1).axes()[0].zero_counts, Wiimote(1).axes()[0].zero_counts);
  int different = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    if (Wiimote(seed).axes()[0].zero_counts != Wiimote(0).axes()[0].zero_counts) ++different;
    EXPECT_NE(Wiimote(seed).identity().serial, Wiimote(0).identity().serial);
  }
  EXPECT_GE(different, 15);
}

TEST(Wiimote, FaceUpAtRestReadsOneGInRawZ) {
  Wiimote wiimote(3);
  const auto counts = CountsOf(SampleOf(wiimote, {0, 0, -kG}));
  EXPECT_EQ(counts[0], wiimote.axes()[0].zero_counts);
  EXPECT_NEAR(counts[1], wiimote.axes()[1].zero_counts, 1);
  EXPECT_NEAR(counts[2], wiimote.axes()[2].one_g_counts, 1);
}

TEST(Wiimote, LeftUpIsRawPlusXAndFrontUpIsRawMinusY) {
  Wiimote wiimote(3);
  EXPECT_EQ(CountsOf(SampleOf(wiimote, {kG, 0, 0}))[0], wiimote.axes()[0].one_g_counts);
  const auto& y = wiimote.axes()[1];
  EXPECT_NEAR(CountsOf(SampleOf(wiimote, {0, kG, 0}))[1], 2 * y.zero_counts - y.one_g_counts, 1);
}

TEST(Wiimote, ClipsAtTheEndsOfTheCounts) {
  Wiimote wiimote(3);
  const auto high = CountsOf(SampleOf(wiimote, {100, -100, -100}));
  EXPECT_EQ(high, (std::array<int, 3>{1023, 1022, 1022}));
  const auto low = CountsOf(SampleOf(wiimote, {-100, 100, 100}));
  EXPECT_EQ(low, (std::array<int, 3>{0, 0, 0}));
}

TEST(Wiimote, AForceThatIsNotFiniteReadsZero) {
  Wiimote wiimote(3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(CountsOf(SampleOf(wiimote, {nan, nan, nan}))[0], wiimote.axes()[0].zero_counts);
}

}  // namespace
}  // namespace footing::device_models
