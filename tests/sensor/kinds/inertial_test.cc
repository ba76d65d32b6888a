#include "daemon/sensor/kinds/inertial.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/stream/product_ids.h"
#include "common/virtual/devices/phone.h"

namespace footing::inertial {
namespace {

constexpr std::int64_t kMs = 1'000'000;

struct Measured {
  std::uint32_t age_us = 0;
  float acceleration_mps2[3] = {0, 0, 9.8f};
  float rate[3] = {0, 0, 0};
};

template <typename Value>
void Append(std::vector<std::uint8_t>& bytes, const Value& value) {
  const auto* const first = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof(value));
}

/// By the table of docs/devices.md.
std::vector<std::uint8_t> ReportOf(std::uint16_t number, std::uint64_t newest_us,
                                   const std::vector<Measured>& samples, std::uint8_t flags = 2) {
  std::vector<std::uint8_t> bytes = {1, flags, 0, 80};
  Append(bytes, number);
  Append(bytes, newest_us);
  bytes.push_back(static_cast<std::uint8_t>(samples.size()));
  for (const Measured& one : samples) {
    Append(bytes, one.age_us);
    Append(bytes, one.acceleration_mps2);
    Append(bytes, one.rate);
  }
  return bytes;
}

std::optional<decode::Decoded> Take(InertialSensor& sensor, std::int64_t received_ns,
                                    const std::vector<std::uint8_t>& report) {
  kinds::Outputs outputs;
  return sensor.Take(received_ns, report, outputs);
}

TEST(InertialReport, AxesOfThePhoneBecomeThoseOfS) {
  // S is x left, y front, z down; the phone's are right, top, out of the screen.
  const auto report = reports::DecodeInertial(ReportOf(7, 1000, {{0, {1, 2, 9.8f}, {3, 4, 5}}}));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->number, 7);
  EXPECT_DOUBLE_EQ(report->battery_fraction, 0.8);
  EXPECT_TRUE(report->samples[0].specific_force_S_mps2.isApprox(
      Eigen::Vector3d(-1, 2, -static_cast<double>(9.8f))));
  EXPECT_TRUE(report->samples[0].angular_velocity_S_radps.isApprox(Eigen::Vector3d(-3, 4, -5)));
}

TEST(InertialReport, InvertedSignsAndDegreesAreUndone) {
  const std::uint8_t ios =
      reports::kInertialInverted | reports::kInertialHasRate | reports::kInertialDegrees;
  const auto report =
      reports::DecodeInertial(ReportOf(0, 1000, {{0, {0, 0, -9.8f}, {180, 0, 0}}}, ios));
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->samples[0].specific_force_S_mps2.z(), -9.8, 1e-6) << "face up at rest";
  EXPECT_NEAR(report->samples[0].angular_velocity_S_radps.x(), -kPi, 1e-6);
}

TEST(InertialReport, RefusesWhatNoSensorSends) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto good = ReportOf(0, 1000, {{10}, {0}});
  ASSERT_TRUE(reports::DecodeInertial(good));
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(reports::DecodeInertial(reports::Bytes(good).first(size))) << size;
  }
  auto longer = good;
  longer.push_back(0);
  EXPECT_FALSE(reports::DecodeInertial(longer));
  EXPECT_FALSE(reports::DecodeInertial(ReportOf(0, 1000, {{0, {nan, 0, 0}}})));
  EXPECT_FALSE(reports::DecodeInertial(ReportOf(0, 1000, {{0, {0, 0, 1e9f}}})));
  EXPECT_FALSE(reports::DecodeInertial(ReportOf(0, 1000, {{0, {0, 0, 9.8f}, {0, nan, 0}}})));
  EXPECT_FALSE(reports::DecodeInertial(ReportOf(0, 1000, {{0}, {10}}))) << "ages must fall";
  EXPECT_FALSE(reports::DecodeInertial(ReportOf(0, 1000, {{2000}}))) << "before the clock began";
  EXPECT_FALSE(reports::DecodeInertial(ReportOf(0, ~std::uint64_t{0}, {{0}})));
  EXPECT_FALSE(reports::DecodeInertial(ReportOf(0, 1000, {})));
  EXPECT_FALSE(reports::DecodeInertial(
      ReportOf(0, 1000, std::vector<Measured>(reports::kMostInertialSamples + 1))));
}

TEST(InertialSensor, SamplesHaveTheTimesOfItsOwnClock) {
  InertialSensor sensor;
  ASSERT_TRUE(sensor.live());
  ASSERT_TRUE(Take(sensor, 1'000 * kMs, ReportOf(0, 500'000, {{0}})));
  const auto decoded = Take(sensor, 1'148 * kMs, ReportOf(1, 548'000, {{32'000}, {16'000}, {0}}));
  ASSERT_TRUE(decoded);
  EXPECT_TRUE(decoded->own_times);
  ASSERT_EQ(decoded->motion.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(decoded->motion[i].sampled_ns, (516 + 16 * static_cast<std::int64_t>(i)) * kMs);
  }
  EXPECT_TRUE(sensor.Note(0).empty());
  ASSERT_TRUE(Take(sensor, 1'200 * kMs, ReportOf(4, 600'000, {{0}})));
  EXPECT_EQ(sensor.Note(0), "2 of its reports were lost on the way");
}

/// The clipped axes of each sample of a report.
std::vector<std::uint32_t> ClippedOf(InertialSensor& sensor, const std::vector<Measured>& samples,
                                     std::uint8_t flags) {
  const auto decoded = Take(sensor, 0, ReportOf(0, 1'000'000, samples, flags));
  if (!decoded) return {};
  std::vector<std::uint32_t> axes;
  for (const stream::MotionSample& sample : decoded->motion) axes.push_back(sample.clipped_axes);
  return axes;
}

TEST(InertialSensor, SamplesAtTheEndOfTheRangeThatItNamesAreMarked) {
  using Axes = std::vector<std::uint32_t>;
  InertialSensor sensor;
  const std::uint8_t knows = reports::kInertialHasRate | reports::kInertialKnowsEnd;
  const std::vector<Measured> swing = {{30, {70, 5, 9}}, {20, {78.4f, 6, 9}}, {10, {-78.5f, 5, 9}}};
  EXPECT_EQ(ClippedOf(sensor, swing, knows), (Axes{0, 0, 0})) << "its range is larger";
  EXPECT_EQ(ClippedOf(sensor, swing, knows | reports::kInertialEndX), (Axes{0, 1, 1}));
  EXPECT_EQ(ClippedOf(sensor, swing, knows | reports::kInertialEndY), (Axes{0, 2, 0}));
  EXPECT_EQ(ClippedOf(sensor, {{0, {1, 2, -78.4f}}}, knows | reports::kInertialEndZ), Axes{4});
}

TEST(InertialSensor, TheEndOfAnUnknownRangeIsSeen) {
  using Axes = std::vector<std::uint32_t>;
  InertialSensor sensor;
  // A swing to 30 m/s² is far from any usual end; the same sensor then ends at 4 g.
  EXPECT_EQ(ClippedOf(sensor, {{10, {30, 0, 9.8f}}, {0, {29.9f, 0, 9.8f}}}, 2), (Axes{0, 0}));
  EXPECT_EQ(
      ClippedOf(sensor, {{20, {35, 0, 9.8f}}, {10, {39.2f, 0, 9.8f}}, {0, {39.1f, 0, 9.8f}}}, 2),
      (Axes{0, 1, 1}));
  EXPECT_EQ(ClippedOf(sensor, {{0, {0, -39.2f, 38}}}, 2), Axes{2});
  // One that goes beyond ends further out.
  EXPECT_EQ(ClippedOf(sensor, {{10, {50, 0, 9.8f}}, {0, {39.2f, 0, 9.8f}}}, 2), (Axes{0, 0}));
  sensor.Restart();
  EXPECT_EQ(ClippedOf(sensor, {{0, {39.2f, 0, 9.8f}}}, 2), Axes{1});
}

TEST(InertialSensor, ASimulatedPhoneMeasuresInStepsUpToItsRange) {
  std::vector<long> ranges_g;
  std::vector<std::uint8_t> signs;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    virtual_devices::Phone phone(seed);
    InertialSensor sensor;
    for (std::int64_t ms = 1000; ms < 1100; ms += 5) {
      phone.Feel(ms * kMs, {{2, 500, -9.8}, {0.5, 0, 0}});
    }
    const auto report = phone.Event(1100 * kMs);
    const auto decoded = Take(sensor, 1150 * kMs, report);
    ASSERT_TRUE(decoded) << seed;
    const stream::MotionSample& sample = decoded->motion.at(0);
    EXPECT_NEAR(sample.specific_force_mps2.x(), 2, 0.2) << seed;
    EXPECT_NEAR(sample.specific_force_mps2.y(), phone.range_mps2(), 0.06) << seed;
    EXPECT_EQ(sample.clipped_axes, 2u) << seed;
    for (const double value : sample.specific_force_mps2) {
      EXPECT_NEAR(std::remainder(value, 0.1), 0, 1e-4) << seed;
    }
    EXPECT_NEAR(sample.angular_velocity_radps.x(), 0.5, 0.02) << seed;
    ranges_g.push_back(std::lround(phone.range_mps2() / kStandardGravityMps2));
    signs.push_back(report[1] & reports::kInertialInverted);
  }
  for (const long range_g : {4, 8, 16}) {
    EXPECT_GT(std::count(ranges_g.begin(), ranges_g.end(), range_g), 0) << range_g;
  }
  EXPECT_EQ(std::set(signs.begin(), signs.end()).size(), 2u);
}

TEST(InertialSensor, VibrationIsAskedForAgainUntilItEnds) {
  InertialSensor sensor;
  link::Outbox outbox;
  EXPECT_FALSE(sensor.NextOutput(0, outbox));
  outbox.SetRumble(true);
  EXPECT_EQ(sensor.NextOutput(1'000 * kMs, outbox), (reports::OutputReport{2, 1}));
  EXPECT_FALSE(sensor.NextOutput(1'100 * kMs, outbox));
  EXPECT_EQ(sensor.NextOutput(1'400 * kMs, outbox), (reports::OutputReport{2, 1}));
  outbox.SetRumble(false);
  EXPECT_EQ(sensor.NextOutput(1'410 * kMs, outbox), (reports::OutputReport{2, 0}));
}

TEST(InertialSensor, IsFoundByItsProduct) {
  const auto kind =
      kinds::MakeKind({}, {stream::kVendorFooting, stream::kProductInertial, "x"}, {});
  EXPECT_EQ(kind->kind(), stream::DeviceKind::kInertial);
  EXPECT_FALSE(stream::IsKnownDevice(stream::kVendorFooting, stream::kProductInertial))
      << "no HID device can say that it is one";
}

}  // namespace
}  // namespace footing::inertial
