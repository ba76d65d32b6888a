#include "daemon/sensor/reports/link_statistics.h"

#include <gtest/gtest.h>

namespace footing::link {
namespace {

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
