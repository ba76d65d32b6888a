#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/virtual/devices/link_model.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/devices/phone.h"
#include "daemon/sensor/reports/device_clock.h"
#include "tests/sensor/reports/sampled_time_error.h"

// sampled_ns against the true device clock: the link model knows when each sample was taken.
namespace footing::link {
namespace {

using virtual_devices::LinkConfig;
using virtual_devices::LinkModel;
using virtual_devices::LinkQuality;

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kMillisecondNs = 1'000'000;
/// The ticks are found within that long after the start and after a suspension; what comes before
/// is not counted.
constexpr std::int64_t kSettledNs = 5 * kSecondNs;

DeviceClockConfig ClockOf(const LinkConfig& link) {
  DeviceClockConfig config;
  config.nominal_period_s = 1 / link.nominal_rate_hz;
  config.sensor_period_s = 1 / link.sensor_rate_hz;
  return config;
}

/// How the sensor's clock and the link are.
struct Course {
  double seconds = 120;
  double clock_error_ppm = 0;                                ///< Error of the sensor's clock.
  bool arrivals_alone = false;                               ///< Every report counts as changed.
  std::function<bool()> reads_alike = [] { return false; };  ///< A new sample, as the last.
  std::function<bool(std::int64_t arrives_ns)> lost = [](std::int64_t) { return false; };
};

struct Outcome {
  SampledTimeError settled;
  bool held = false;
  double sd_ms = -1;            ///< As the clock reports it at the end.
  SampledTimeError searching;   ///< Before the ticks are known.
  double searching_sd_ms = -1;  ///< The last one reported then.
};

Outcome Follow(LinkConfig link, const Course& course) {
  DeviceClock clock(ClockOf(link));
  link.sensor_rate_hz *= 1 + course.clock_error_ppm * 1e-6;
  LinkModel model(link, 0);
  Outcome outcome;
  std::int64_t held_ns = -1;
  std::int64_t before_ns = 0;
  std::int64_t received_ns = 0;
  std::int64_t begun_ns = 0;
  const auto end_ns = static_cast<std::int64_t>(course.seconds * 1e9);
  for (LinkModel::Arrival arrival = model.Next(); arrival.arrives_ns < end_ns;
       arrival = model.Next()) {
    if (course.lost(arrival.arrives_ns)) continue;
    const bool changed =
        course.arrivals_alone || (arrival.sampled_ns != held_ns && !course.reads_alike());
    held_ns = arrival.sampled_ns;
    const std::int64_t sampled_ns = clock.Advance(arrival.arrives_ns, changed);
    EXPECT_GE(sampled_ns, before_ns);
    EXPECT_LE(sampled_ns, arrival.arrives_ns);
    before_ns = sampled_ns;
    if (arrival.arrives_ns - received_ns > 100 * kSecondNs) begun_ns = arrival.arrives_ns;
    received_ns = arrival.arrives_ns;
    if (!clock.held() && clock.sampled_sd_s() >= 0) {
      outcome.searching.Add(sampled_ns, arrival.sampled_ns);
      outcome.searching_sd_ms = 1e3 * clock.sampled_sd_s();
    }
    if (received_ns - begun_ns > kSettledNs) outcome.settled.Add(sampled_ns, arrival.sampled_ns);
  }
  outcome.held = clock.held();
  outcome.sd_ms = 1e3 * clock.sampled_sd_s();
  return outcome;
}

/// The bar: 2 ms rms and 6 ms in 99 of 100 reports.
void ExpectGood(const Outcome& outcome) {
  EXPECT_TRUE(outcome.held);
  EXPECT_LE(outcome.settled.rms_ms(), 2);
  EXPECT_LE(outcome.settled.p99_ms(), 6);
}

class EverySeed : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, EverySeed, testing::Range<std::uint64_t>(1, 9));

TEST_P(EverySeed, AWiimotesSamplesAreKnownToTwoMilliseconds) {
  ExpectGood(Follow(virtual_devices::WiimoteLink(LinkQuality::kGood, GetParam()), {}));
}

TEST_P(EverySeed, ABoardsSamplesAreKnownToTwoMilliseconds) {
  ExpectGood(Follow(virtual_devices::BoardLink(LinkQuality::kGood, GetParam()), {}));
}

TEST_P(EverySeed, ACrystalTensOfPpmOffCostsNothing) {
  Course course;
  course.clock_error_ppm = GetParam() % 2 == 0 ? 80 : -50;
  ExpectGood(Follow(virtual_devices::WiimoteLink(LinkQuality::kGood, GetParam()), course));
}

TEST_P(EverySeed, ASensorThatIsFourPercentOffIsFound) {
  Course course;
  course.clock_error_ppm = GetParam() % 2 == 0 ? 40'000 : -40'000;
  ExpectGood(Follow(virtual_devices::WiimoteLink(LinkQuality::kGood, GetParam()), course));
  ExpectGood(Follow(virtual_devices::BoardLink(LinkQuality::kGood, GetParam()), course));
}

TEST_P(EverySeed, TheReportedStandardDeviationIsOfTheSizeOfTheErrors) {
  for (const LinkQuality quality : {LinkQuality::kGood, LinkQuality::kPoor}) {
    for (const LinkConfig& link : {virtual_devices::WiimoteLink(quality, GetParam()),
                                   virtual_devices::BoardLink(quality, GetParam())}) {
      const Outcome outcome = Follow(link, {});
      EXPECT_GT(outcome.sd_ms, 0);
      EXPECT_LT(outcome.sd_ms, 3);
      EXPECT_LT(outcome.settled.rms_ms(), 3 * outcome.sd_ms + 0.2);
    }
  }
}

TEST_P(EverySeed, AClockWithoutTicksReportsTheLargerDeviationOfArrivals) {
  Course course;  // Every report brings a new value, as from a sensor that nothing holds.
  course.seconds = 60;
  course.arrivals_alone = true;
  const Outcome outcome =
      Follow(virtual_devices::BoardLink(LinkQuality::kGood, GetParam()), course);
  EXPECT_FALSE(outcome.held);
  EXPECT_GT(outcome.searching_sd_ms, outcome.searching.rms_ms() / 2);
  EXPECT_LT(outcome.searching_sd_ms, outcome.searching.rms_ms() * 2);
}

TEST_P(EverySeed, AThirdOfTheReportsLostCostsNothing) {
  noise::Random random(GetParam() + 1000);  // Not the link's own draws.
  Course course;
  course.lost = [&random](std::int64_t) { return random.Uniform() < 0.33; };
  ExpectGood(Follow(virtual_devices::WiimoteLink(LinkQuality::kGood, GetParam()), course));
}

TEST_P(EverySeed, LostReportsOnAPoorLinkCostLittle) {
  noise::Random random(GetParam() + 1000);  // Not the link's own draws.
  Course course;
  course.lost = [&random](std::int64_t) { return random.Uniform() < 0.1; };
  ExpectGood(Follow(virtual_devices::BoardLink(LinkQuality::kPoor, GetParam()), course));
}

TEST_P(EverySeed, StallsOfSecondsCostNothing) {
  Course course;  // Two seconds of every twenty nothing comes through.
  course.lost = [](std::int64_t at_ns) { return at_ns % (20 * kSecondNs) > 18 * kSecondNs; };
  ExpectGood(Follow(virtual_devices::WiimoteLink(LinkQuality::kGood, GetParam()), course));
}

TEST_P(EverySeed, APoorLinkIsNoWorse) {
  ExpectGood(Follow(virtual_devices::WiimoteLink(LinkQuality::kPoor, GetParam()), {}));
  ExpectGood(Follow(virtual_devices::BoardLink(LinkQuality::kPoor, GetParam()), {}));
}

TEST_P(EverySeed, AnHourThatPassesUnseenIsForgottenWithinSeconds) {
  // A suspension: the ticks of before cannot be held on to (1 ppm is 3.6 ms in an hour).
  Course course;
  course.seconds = 3660;
  course.clock_error_ppm = 30;
  course.lost = [](std::int64_t at_ns) {
    return at_ns > 30 * kSecondNs && at_ns < 3630 * kSecondNs;
  };
  ExpectGood(Follow(virtual_devices::WiimoteLink(LinkQuality::kGood, GetParam()), course));
}

TEST_P(EverySeed, RepeatsOfASlowlyMovingSensorCostNothing) {
  // Every third new sample reads as the one before, as between two counts of a slow motion.
  noise::Random random(GetParam() + 1000);
  Course course;
  course.reads_alike = [&random] { return random.Uniform() < 0.33; };
  ExpectGood(Follow(virtual_devices::WiimoteLink(LinkQuality::kGood, GetParam()), course));
  ExpectGood(Follow(virtual_devices::BoardLink(LinkQuality::kGood, GetParam()), course));
}

double Sd(const std::vector<double>& values) {
  double mean = 0, square = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) {
    square += (value - mean) * (value - mean) / static_cast<double>(values.size());
  }
  return std::sqrt(square);
}

TEST(DeviceClock, SmoothsTheBurstsOfASteadyDevice) {
  // Samples every 10.02 ms; each report waits up to 16 ms, in order, as Bluetooth delivers.
  std::mt19937 random(2);
  DeviceClock clock;
  std::vector<double> received_error_ms, sampled_error_ms;
  double last_arrival_ms = 0;
  for (int i = 0; i < 5000; ++i) {
    const double true_ms = 10.02 * i;
    const double wait_ms = 2 + 14 * (static_cast<double>(random() % 1000) / 1000);
    last_arrival_ms = std::max(last_arrival_ms, true_ms + wait_ms);
    const auto received_ns = static_cast<std::int64_t>(last_arrival_ms * 1e6);
    const double sampled_ms = static_cast<double>(clock.Advance(received_ns)) * 1e-6;
    if (i < 500) continue;
    received_error_ms.push_back(last_arrival_ms - true_ms);
    sampled_error_ms.push_back(sampled_ms - true_ms);
  }
  EXPECT_LT(Sd(sampled_error_ms), 0.6 * Sd(received_error_ms));
  EXPECT_NEAR(clock.period_s(), 0.01002, 0.0005);
}

/// rms and 99th percentile of |sampled - true|, in ms, after removing the median.
struct Accuracy {
  double rms_ms = 0;
  double p99_ms = 0;
  bool monotonic = true;
};

Accuracy Measure(virtual_devices::LinkConfig link, double sensor_period_s, double from_s,
                 double to_s) {
  virtual_devices::LinkModel model(link, 0);
  DeviceClockConfig config;
  config.nominal_period_s = 1 / link.nominal_rate_hz;
  config.sensor_period_s = sensor_period_s;
  DeviceClock clock(config);
  std::vector<double> errors_ms;
  std::int64_t held_ns = -1, last_ns = 0;
  Accuracy accuracy;
  for (;;) {
    const auto arrival = model.Next();
    if (static_cast<double>(arrival.arrives_ns) * 1e-9 > to_s) break;
    const std::int64_t sampled_ns =
        clock.Advance(arrival.arrives_ns, arrival.sampled_ns != held_ns);
    held_ns = arrival.sampled_ns;
    accuracy.monotonic = accuracy.monotonic && sampled_ns >= last_ns;
    last_ns = sampled_ns;
    if (static_cast<double>(arrival.arrives_ns) * 1e-9 < from_s) continue;
    errors_ms.push_back(static_cast<double>(sampled_ns - arrival.sampled_ns) * 1e-6);
  }
  std::sort(errors_ms.begin(), errors_ms.end());
  const double median_ms = errors_ms[errors_ms.size() / 2];
  double squares = 0;
  for (double& error : errors_ms) {
    error = std::abs(error - median_ms);
    squares += error * error;
  }
  std::sort(errors_ms.begin(), errors_ms.end());
  accuracy.rms_ms = std::sqrt(squares / static_cast<double>(errors_ms.size()));
  accuracy.p99_ms = errors_ms[errors_ms.size() * 99 / 100];
  return accuracy;
}

TEST(DeviceClock, FindsTheSensorsOwnTicksOnAGoodLink) {
  // The sensor's rate is off by 0, 50 ppm, 0.5 % and -1 %.
  for (const double factor : {1.0, 1.00005, 1.005, 0.99}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      auto wiimote = virtual_devices::WiimoteLink(virtual_devices::LinkQuality::kGood, seed);
      wiimote.sensor_rate_hz *= factor;
      const Accuracy of_wiimote = Measure(wiimote, 0.01, 5, 120);
      EXPECT_LE(of_wiimote.rms_ms, 2) << factor << " seed " << seed;
      EXPECT_LE(of_wiimote.p99_ms, 6) << factor << " seed " << seed;
      EXPECT_TRUE(of_wiimote.monotonic);
      auto board = virtual_devices::BoardLink(virtual_devices::LinkQuality::kGood, seed);
      board.sensor_rate_hz *= factor;
      const Accuracy of_board = Measure(board, 1 / 60.0, 5, 120);
      EXPECT_LE(of_board.rms_ms, 2) << factor << " seed " << seed;
      EXPECT_LE(of_board.p99_ms, 6) << factor << " seed " << seed;
    }
  }
}

TEST(DeviceClock, OnAPoorLinkTheErrorStaysFarBelowAPeriod) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto link = virtual_devices::WiimoteLink(virtual_devices::LinkQuality::kPoor, seed);
    const Accuracy accuracy = Measure(link, 0.01, 5, 600);
    EXPECT_LE(accuracy.rms_ms, 2.9) << "no better than the arrival itself";
    EXPECT_TRUE(accuracy.monotonic);
  }
}

TEST(DeviceClock, ASensorAtRestDoesNotDisturbTheGrid) {
  // Moves for 20 s, rests for 20 s (all values the same), moves again.
  virtual_devices::LinkModel link(
      virtual_devices::WiimoteLink(virtual_devices::LinkQuality::kGood, 4), 0);
  DeviceClock clock;
  std::int64_t held_ns = -1;
  double worst_ms = 0;
  for (int i = 0; i < 6000; ++i) {
    const auto arrival = link.Next();
    const double at_s = static_cast<double>(arrival.arrives_ns) * 1e-9;
    const bool rests = at_s > 20 && at_s < 40;
    const auto sampled_ns =
        clock.Advance(arrival.arrives_ns, !rests && arrival.sampled_ns != held_ns);
    held_ns = arrival.sampled_ns;
    if (at_s < 42 || at_s > 50) continue;
    worst_ms =
        std::max(worst_ms, std::abs(static_cast<double>(sampled_ns - arrival.sampled_ns)) * 1e-6);
  }
  EXPECT_TRUE(clock.held());
  EXPECT_LE(worst_ms, 10.5);
  EXPECT_NEAR(clock.period_s(), 0.01, 0.0001);
}

TEST(DeviceClock, StaysBetweenTheArrivalAndTheLagOnAnyLink) {
  for (const auto quality :
       {virtual_devices::LinkQuality::kGood, virtual_devices::LinkQuality::kPoor}) {
    virtual_devices::LinkModel link(virtual_devices::BoardLink(quality, 3), 0);
    DeviceClockConfig config;
    config.nominal_period_s = 1 / 83.6;
    DeviceClock clock(config);
    std::int64_t before_ns = -1;
    for (int i = 0; i < 20'000; ++i) {
      const std::int64_t received_ns = link.Next().arrives_ns;
      const std::int64_t sampled_ns = clock.Advance(received_ns);
      ASSERT_LE(sampled_ns, received_ns);
      ASSERT_GE(sampled_ns, received_ns - 25'000'000);
      ASSERT_GE(sampled_ns, before_ns);
      before_ns = sampled_ns;
    }
  }
}

TEST(DeviceClock, StartsAnewAfterAPause) {
  DeviceClock clock;
  for (int i = 0; i < 100; ++i) clock.Advance(i * std::int64_t{10'000'000});
  EXPECT_EQ(clock.Advance(30'000'000'000), 30'000'000'000);
}

TEST(OwnClock, TimesAreThoseOfTheFastestReports) {
  // The device's clock is 5 s behind; reports take 4 ms and every fifth one 120 ms more.
  OwnClock clock;
  const std::int64_t behind_ns = 5'000 * kMillisecondNs;
  for (int i = 0; i < 200; ++i) {
    const std::int64_t device_ns = (1'000 + 50 * i) * kMillisecondNs;
    const std::int64_t delay_ns = (i % 5 == 3 ? 124 : 4) * kMillisecondNs;
    clock.Take(device_ns + behind_ns + delay_ns, device_ns);
    EXPECT_NEAR(static_cast<double>(clock.HostNs(device_ns)),
                static_cast<double>(device_ns + behind_ns + 4 * kMillisecondNs), 10)
        << i;
  }
}

TEST(OwnClock, ADeviceThatStartsAgainIsFollowedAtOnce) {
  OwnClock clock;
  clock.Take(100'000 * kMillisecondNs, 90'000 * kMillisecondNs);
  clock.Take(101'000 * kMillisecondNs, 3 * kMillisecondNs);  // Its page was loaded again.
  EXPECT_EQ(clock.HostNs(3 * kMillisecondNs), 101'000 * kMillisecondNs);
  clock.Take(102'000 * kMillisecondNs, 900'000 * kMillisecondNs);  // And one from the future.
  EXPECT_EQ(clock.HostNs(900'000 * kMillisecondNs), 102'000 * kMillisecondNs);
}

TEST(OwnClock, FollowsAClockOfAnotherRate) {
  // A clock that is 1 % fast, as a Joy-Con's timer may be, over the link of one: every 15 ms.
  for (const double rate : {0.99, 1.0, 1.01}) {
    LinkModel link(virtual_devices::JoyconLink(LinkQuality::kGood, 5), 0);
    OwnClock clock(0.015);
    SampledTimeError error;
    EXPECT_LT(clock.sampled_sd_s(), 0);
    for (int i = 0; i < 8000; ++i) {
      const auto arrival = link.Next();
      const auto own_ns = static_cast<std::int64_t>(rate * static_cast<double>(arrival.sampled_ns));
      clock.Take(arrival.arrives_ns, own_ns);
      if (arrival.arrives_ns < kSettledNs) continue;
      error.Add(clock.HostNs(own_ns), arrival.sampled_ns);
      EXPECT_LT(clock.sampled_sd_s(), 0.002);
    }
    EXPECT_LT(error.rms_ms(), 0.5) << rate;
    EXPECT_LT(error.p99_ms(), 1.5) << rate;
  }
}

TEST(OwnClock, BunchesOfWiFiDoNotMoveTheTimesOfAPhone) {
  LinkModel link(virtual_devices::PhoneLink(LinkQuality::kGood, 6), 0);
  OwnClock clock;
  SampledTimeError error;
  for (int i = 0; i < 8000; ++i) {
    const auto arrival = link.Next();
    const std::int64_t own_ns = arrival.sampled_ns + arrival.sampled_ns / 20'000;  // 50 ppm fast.
    clock.Take(arrival.arrives_ns, own_ns);
    if (arrival.arrives_ns < kSettledNs) continue;
    error.Add(clock.HostNs(own_ns), arrival.sampled_ns);
  }
  EXPECT_LT(error.p99_ms(), 3);  // Arrivals are 50 to 300 ms apart.
}

TEST(LinkStatistics, SteadyReportsHaveTheirRateAndNoJitter) {
  LinkStatistics statistics(0.01);
  std::int64_t now_ns = 0;
  for (int i = 0; i < 500; ++i) statistics.Advance(now_ns += 10'000'000);
  EXPECT_NEAR(statistics.RateHz(now_ns), 100, 1e-6);
  EXPECT_NEAR(statistics.JitterMs(), 0, 1e-6);
  EXPECT_EQ(statistics.reports(), 500u);
  EXPECT_EQ(statistics.gaps(), 0u);
}

TEST(LinkStatistics, BurstsKeepTheRateAndShowAsJitter) {
  // 2 ms and 18 ms in turn: mean 10 ms, standard deviation 8 ms.
  LinkStatistics statistics(0.01);
  std::int64_t now_ns = 0;
  for (int i = 0; i < 2000; ++i) statistics.Advance(now_ns += i % 2 == 0 ? 2'000'000 : 18'000'000);
  EXPECT_NEAR(statistics.RateHz(now_ns), 100, 3);
  EXPECT_NEAR(statistics.JitterMs(), 8, 0.5);
}

TEST(LinkStatistics, CountsGapsAndFallsSilent) {
  LinkStatistics statistics(0.01);
  statistics.Advance(0);
  statistics.Advance(10'000'000);
  statistics.Advance(61'000'000);  // 51 ms: more than five nominal intervals.
  EXPECT_EQ(statistics.gaps(), 1u);
  EXPECT_GT(statistics.RateHz(100'000'000), 0);
  EXPECT_EQ(statistics.RateHz(1'200'000'000), 0);
}

}  // namespace
}  // namespace footing::link
