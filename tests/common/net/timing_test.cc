#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "common/net/client.h"
#include "common/net/clock_offset.h"
#include "common/net/session.h"

namespace footing::transport {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1000 * kMs;

/// How many of the ticks of `seconds` at 100 Hz, each up to `jitter_ns` late, are taken.
int Taken(double max_hz, int seconds, std::int64_t jitter_ns) {
  Decimator decimator(max_hz, 10 * kMs);
  std::minstd_rand random(1);
  int taken = 0;
  for (int i = 0; i < 100 * seconds; ++i) {
    const std::int64_t late = jitter_ns == 0 ? 0 : static_cast<std::int64_t>(random()) % jitter_ns;
    taken += decimator.Take(i * 10 * kMs + late) ? 1 : 0;
  }
  return taken;
}

TEST(Decimator, TheAverageRateIsTheOneAskedFor) {
  for (const double max_hz : {1.0, 7.0, 25.0, 30.0, 60.0, 99.0}) {
    for (const std::int64_t jitter_ns : {std::int64_t{0}, 3 * kMs}) {
      EXPECT_NEAR(Taken(max_hz, 20, jitter_ns), 20 * max_hz, std::max(2.0, 0.2 * max_hz))
          << max_hz << " Hz";
    }
  }
}

TEST(Decimator, ZeroAndMoreThanTheTicksTakeAll) {
  EXPECT_EQ(Taken(0, 1, 0), 100);
  EXPECT_EQ(Taken(1000, 1, 0), 100);
}

TEST(Decimator, AClockThatBeginsAnewDoesNotStopTheStream) {
  Decimator decimator(10, 10 * kMs);
  EXPECT_TRUE(decimator.Take(1000 * kSecond));
  EXPECT_TRUE(decimator.Take(5 * kSecond));
  EXPECT_FALSE(decimator.Take(5 * kSecond + 10 * kMs));
  EXPECT_TRUE(decimator.Take(5 * kSecond + 100 * kMs));
}

/// A probe over ways of the given lengths between clocks `offset_ns` apart.
Probe MakeProbe(std::int64_t t0_ns, std::int64_t offset_ns, std::int64_t there_ns,
                std::int64_t back_ns) {
  Probe probe;
  probe.t0_ns = t0_ns;
  probe.t1_ns = t0_ns + there_ns + offset_ns;
  probe.t2_ns = probe.t1_ns + 5000;
  probe.t3_ns = probe.t2_ns - offset_ns + back_ns;
  return probe;
}

TEST(ClockOffset, EqualWaysGiveTheExactOffset) {
  ClockOffsetEstimator estimator;
  EXPECT_FALSE(estimator.estimate().valid);
  estimator.Add(MakeProbe(kSecond, -123'456'789, 40'000, 40'000));
  EXPECT_TRUE(estimator.estimate().valid);
  EXPECT_EQ(estimator.estimate().offset_ns, -123'456'789);
  EXPECT_NEAR(static_cast<double>(estimator.estimate().uncertainty_ns), 40'000, 2);
}

TEST(ClockOffset, TheTruthStaysWithinTheStatedUncertainty) {
  const std::int64_t offset_ns = 987'654'321'000;
  std::mt19937 random(7);
  std::exponential_distribution<double> delay(1.0 / 300'000);  // Mean 0.3 ms beyond 50 us.
  ClockOffsetEstimator estimator;
  for (int i = 0; i < 400; ++i) {
    const auto there = 50'000 + static_cast<std::int64_t>(delay(random));
    const auto back = 50'000 + static_cast<std::int64_t>(delay(random));
    estimator.Add(MakeProbe(i * 250 * kMs, offset_ns, there, back));
    const OffsetEstimate estimate = estimator.estimate();
    ASSERT_LE(std::llabs(estimate.offset_ns - offset_ns), estimate.uncertainty_ns) << i;
  }
  // The best of 8: the expected minimum of 8 sums of two such delays is well below their mean.
  EXPECT_LT(estimator.estimate().uncertainty_ns, 350'000);
}

TEST(ClockOffset, OneSlowProbeDoesNotMoveIt) {
  ClockOffsetEstimator estimator;
  estimator.Add(MakeProbe(0, 1000, 20'000, 20'000));
  estimator.Add(MakeProbe(kSecond, 1000, 90 * kMs, 20'000));
  EXPECT_EQ(estimator.estimate().offset_ns, 1000);
}

TEST(ClockOffset, WhileItGetsToKnowTheClockABetterProbeIsTakenAtOnce) {
  ClockOffsetEstimator estimator;
  estimator.Add(MakeProbe(0, 0, 40 * kMs, 0));  // Behind a heap of other messages: 20 ms off.
  EXPECT_EQ(estimator.estimate().offset_ns, 20 * kMs);
  estimator.Add(MakeProbe(kMs, 0, 10'000, 10'000));
  EXPECT_EQ(estimator.estimate().offset_ns, 0);
}

TEST(ClockOffset, ItSlewsAndNeverJumpsWhileTheOldValueIsPossible) {
  ClockOffsetEstimator estimator;
  std::int64_t now_ns = 0;
  // One-sided ways: the first estimates are off by half their difference, 2 ms.
  for (int i = 0; i < 8; ++i) estimator.Add(MakeProbe(now_ns += kMs, 0, 4 * kMs, 0));
  std::int64_t last_ns = estimator.estimate().offset_ns;
  EXPECT_EQ(last_ns, 2 * kMs);
  for (int i = 0; i < 40; ++i) {
    now_ns += 250 * kMs;
    const Probe probe = MakeProbe(now_ns, 0, 10'000, 10'000);
    estimator.Add(probe);
    const OffsetEstimate estimate = estimator.estimate();
    // At most 0.5 ms a second: 0.125 ms in 250 ms, and a little for the probe's own time.
    ASSERT_LE(std::llabs(estimate.offset_ns - last_ns), 128'000) << i;
    ASSERT_LE(std::llabs(estimate.offset_ns), estimate.uncertainty_ns);
    last_ns = estimate.offset_ns;
  }
  EXPECT_EQ(last_ns, 0);  // 2 ms at 0.5 ms a second take 4 s; 10 s have passed.
}

TEST(ClockOffset, AClockThatWasSetIsFollowedAtOnceItsOldProbesAreGone) {
  ClockOffsetEstimator estimator;
  for (int i = 0; i < 8; ++i) estimator.Add(MakeProbe(i * kSecond, 0, 10'000, 10'000));
  for (int i = 8; i < 16; ++i) {
    estimator.Add(MakeProbe(i * kSecond, 3600 * kSecond, 10'000, 10'000));
  }
  EXPECT_EQ(estimator.estimate().offset_ns, 3600 * kSecond);
}

TEST(ClockOffset, ImpossibleStampsAreIgnored) {
  ClockOffsetEstimator estimator;
  estimator.Add({10, 20, 15, 30});  // Sent before it arrived.
  estimator.Add({10, 20, 30, 5});   // Back before it left.
  estimator.Add({10, 20, 90, 30});  // Longer there than away.
  estimator.Add({10, 0, 0, 30});    // Without the other clock's stamps.
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  estimator.Add({10, kLeast, kMost, 30});
  estimator.Add({kLeast, 20, 25, kMost});
  estimator.Add({10, kMost - 1, kMost, 30});
  EXPECT_FALSE(estimator.estimate().valid);
}

TEST(Backoff, AClientsLongestWaitLeavesTimeToBeBackWithinTwoSeconds) {
  const ClientOptions options;
  Backoff backoff(options.backoff_min_s, options.backoff_max_s);
  for (int i = 0; i < 100; ++i) EXPECT_LE(backoff.Next(std::nextafter(1, 0)), 1.0);
}

TEST(Backoff, ItDoublesUpToTheSlowestWithJitterBelow) {
  Backoff backoff(0.1, 5);
  const double almost_one = std::nextafter(1.0, 0.0);
  double expected = 0.1;
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(backoff.Next(almost_one), expected, 1e-9);
    expected = std::min(5.0, 2 * expected);
  }
  EXPECT_NEAR(backoff.Next(0), 2.5, 1e-9);
  backoff.Reset();
  EXPECT_NEAR(backoff.Next(0), 0.05, 1e-9);
}

TEST(Answers, TheFirstAnswerStaysAndTheOldestGoes) {
  Answers answers(2);
  const auto answer = [](std::uint64_t id, const std::string& text) {
    v1::CommandResult result;
    result.set_id(id);
    result.set_message(text);
    return result;
  };
  answers.Remember(answer(1, "first"));
  answers.Remember(answer(1, "second"));
  EXPECT_EQ(answers.Find(1)->message(), "first");
  answers.Remember(answer(2, ""));
  answers.Remember(answer(3, ""));
  EXPECT_EQ(answers.Find(1), nullptr);
  EXPECT_NE(answers.Find(2), nullptr);
  EXPECT_NE(answers.Find(3), nullptr);
}

}  // namespace
}  // namespace footing::transport
