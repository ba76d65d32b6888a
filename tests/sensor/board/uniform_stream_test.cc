#include "daemon/sensor/board/uniform_stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/units/units.h"
#include "common/virtual/devices/link_model.h"
#include "common/virtual/noise/random.h"

namespace footing::board {
namespace {

struct Raw {
  std::int64_t sampled_ns = 0;
  std::int64_t arrives_ns = 0;
  double value_n = 0;
};

/// A sway of a standing person: 0.4 Hz and 1.1 Hz about 450 N.
double Sway(double t_s) {
  return 450 + 20 * std::sin(2 * kPi * 0.4 * t_s) + 6 * std::sin(2 * kPi * 1.1 * t_s + 1);
}
double SwayRate(double t_s) {
  return 20 * 2 * kPi * 0.4 * std::cos(2 * kPi * 0.4 * t_s) +
         6 * 2 * kPi * 1.1 * std::cos(2 * kPi * 1.1 * t_s + 1);
}

/// What a board sends of it over a link: repeats, bursts, and the board's own noise (0.85 N).
std::vector<Raw> Record(virtual_devices::LinkQuality quality, double seconds) {
  virtual_devices::LinkModel link(virtual_devices::BoardLink(quality, 5), 0);
  noise::Random random(6);
  std::vector<Raw> raw;
  while (raw.empty() || raw.back().arrives_ns < SecondsToNanoseconds(seconds)) {
    const auto arrival = link.Next();
    if (!raw.empty() && arrival.sampled_ns <= raw.back().sampled_ns) continue;
    raw.push_back({arrival.sampled_ns, arrival.arrives_ns,
                   Sway(NanosecondsToSeconds(arrival.sampled_ns)) + 0.85 * random.Normal()});
  }
  return raw;
}

std::vector<UniformReading> Resample(const std::vector<Raw>& raw, double* worst_latency_s = nullptr,
                                     const UniformConfig& config = {}) {
  UniformStream stream(config);
  std::vector<UniformReading> readings;
  for (const Raw& one : raw) {
    stream.Add(one.sampled_ns, {one.value_n, 0, 0, 0});
    while (const auto reading = stream.Next(one.arrives_ns)) {
      readings.push_back(*reading);
      if (worst_latency_s == nullptr) continue;
      *worst_latency_s =
          std::max(*worst_latency_s, NanosecondsToSeconds(one.arrives_ns - reading->sampled_ns));
    }
  }
  return readings;
}

double Interpolated(const std::vector<Raw>& raw, std::int64_t at_ns, bool linear) {
  std::size_t i = 0;
  while (i + 1 < raw.size() && raw[i + 1].sampled_ns <= at_ns) ++i;
  if (!linear || i + 1 == raw.size()) return raw[i].value_n;
  const double share = static_cast<double>(at_ns - raw[i].sampled_ns) /
                       static_cast<double>(raw[i + 1].sampled_ns - raw[i].sampled_ns);
  return raw[i].value_n + share * (raw[i + 1].value_n - raw[i].value_n);
}

/// rms of the central difference against the true rate, N/s.
double RateError(const std::vector<UniformReading>& readings, const std::vector<double>& values) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 100; i + 1 < values.size(); ++i) {
    const double step_s =
        NanosecondsToSeconds(readings[i + 1].sampled_ns - readings[i - 1].sampled_ns);
    const double error = (values[i + 1] - values[i - 1]) / step_s -
                         SwayRate(NanosecondsToSeconds(readings[i].sampled_ns));
    sum += error * error;
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(UniformStream, DifferentiatesBetterThanLinearAndZeroOrderInterpolation) {
  const auto raw = Record(virtual_devices::LinkQuality::kGood, 20);
  const auto readings = Resample(raw);
  ASSERT_GT(readings.size(), 1900u);
  std::vector<double> averaged;
  std::vector<double> linear;
  std::vector<double> held;
  for (const auto& reading : readings) {
    averaged.push_back(reading.forces.top_left_n);
    linear.push_back(Interpolated(raw, reading.sampled_ns, true));
    held.push_back(Interpolated(raw, reading.sampled_ns, false));
  }
  const double error = RateError(readings, averaged);
  RecordProperty("averaged_nps", std::to_string(error));
  RecordProperty("linear_nps", std::to_string(RateError(readings, linear)));
  RecordProperty("held_nps", std::to_string(RateError(readings, held)));
  EXPECT_LT(error, 0.7 * RateError(readings, linear));
  EXPECT_LT(error, 0.5 * RateError(readings, held));
}

TEST(UniformStream, KeepsItsRateExactlyAndNeverDrifts) {
  UniformConfig config;
  config.rate_hz = 60;  // No whole number of nanoseconds.
  auto raw = Record(virtual_devices::LinkQuality::kGood, 30);
  for (Raw& one : raw) one.sampled_ns += 86'400'000'000'000;  // A day of uptime.
  for (Raw& one : raw) one.arrives_ns += 86'400'000'000'000;
  const auto readings = Resample(raw, nullptr, config);
  ASSERT_GT(readings.size(), 1700u);
  const std::int64_t first = std::llround(static_cast<double>(readings[0].sampled_ns) * 60e-9);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto number = static_cast<double>(first + static_cast<std::int64_t>(i));
    ASSERT_EQ(readings[i].sampled_ns, std::llround(number * 1e9 / 60)) << i;
  }
}

TEST(UniformStream, ComesHalfAWindowAndASampleLater) {
  double worst_s = 0;
  Resample(Record(virtual_devices::LinkQuality::kGood, 20), &worst_s);
  EXPECT_GT(worst_s, 0.025);
  // Half a window, the longest recorded interval (0.06 s) and the age of a sample.
  EXPECT_LT(worst_s, 0.025 + 0.06 + 0.02);
}

TEST(UniformStream, WeighsEachSampleByTheTimeItStandsFor) {
  UniformConfig config;
  config.rate_hz = 10;
  config.window_s = 0.1;
  UniformStream stream(config);
  // About 1 s: [0.95, 1.05]. Samples at 0.96, 0.98, 1.04 stand for 20, 40 and 40 ms.
  stream.Add(910'000'000, {50, 0, 0, 0});
  stream.Add(960'000'000, {1, 0, 0, 0});
  stream.Add(980'000'000, {2, 0, 0, 0});
  stream.Add(1'040'000'000, {3, 0, 0, 0});
  stream.Add(1'060'000'000, {50, 0, 0, 0});
  const auto reading = stream.Next(1'060'000'000);
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->sampled_ns, 1'000'000'000);
  EXPECT_EQ(reading->samples, 3u);
  EXPECT_NEAR(reading->forces.top_left_n, 0.2 * 1 + 0.4 * 2 + 0.4 * 3, 1e-12);
  EXPECT_FALSE(stream.Next(1'060'000'000));
}

TEST(UniformStream, HoldsAndTellsAGapAndEndsWhenTheBoardIsGone) {
  UniformStream stream;
  stream.Add(1'000'000'000, {7, 0, 0, 0});
  std::vector<UniformReading> readings;
  for (std::int64_t now_ns = 1'000'000'000; now_ns < 9'000'000'000; now_ns += 10'000'000) {
    while (const auto reading = stream.Next(now_ns)) readings.push_back(*reading);
  }
  ASSERT_NEAR(static_cast<double>(readings.size()), 201, 1);  // Instants 1.00 to 3.00 s.
  EXPECT_FALSE(readings.front().gap);
  EXPECT_TRUE(readings.back().gap);
  EXPECT_EQ(readings.back().samples, 0u);
  EXPECT_EQ(readings.back().forces.top_left_n, 7);
  stream.Add(20'000'000'000, {8, 0, 0, 0});
  const auto after = stream.Next(20'500'000'000);
  ASSERT_TRUE(after);
  EXPECT_EQ(after->sampled_ns, 20'000'000'000);
  EXPECT_EQ(after->forces.top_left_n, 8);
}

}  // namespace
}  // namespace footing::board
