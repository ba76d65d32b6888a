#include "common/virtual/devices/link_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "common/virtual/devices/phone.h"

namespace footing::virtual_devices {
namespace {

struct Intervals {
  std::vector<double> ms;
  double rate_hz = 0;
  double repeats = 0;  ///< Share of reports with the sample of the one before.
};

Intervals Observe(const LinkConfig& config, int reports) {
  LinkModel link(config, 0);
  Intervals out;
  std::int64_t arrived_ns = 0;
  std::int64_t sampled_ns = -1;
  int repeats = 0;
  for (int i = 0; i < reports; ++i) {
    const auto arrival = link.Next();
    EXPECT_GT(arrival.arrives_ns, arrived_ns);
    EXPECT_GE(arrival.sampled_ns, sampled_ns);
    EXPECT_LE(arrival.sampled_ns, arrival.arrives_ns);
    out.ms.push_back(static_cast<double>(arrival.arrives_ns - arrived_ns) * 1e-6);
    repeats += arrival.sampled_ns == sampled_ns;
    arrived_ns = arrival.arrives_ns;
    sampled_ns = arrival.sampled_ns;
  }
  out.rate_hz = reports / (static_cast<double>(arrived_ns) * 1e-9);
  out.repeats = static_cast<double>(repeats) / reports;
  std::sort(out.ms.begin(), out.ms.end());
  return out;
}

double Quantile(const Intervals& intervals, double probability) {
  return intervals
      .ms[static_cast<std::size_t>(probability * static_cast<double>(intervals.ms.size()))];
}

TEST(LinkModel, AGoodBoardLinkIsTheRecordedOne) {
  const Intervals got = Observe(BoardLink(LinkQuality::kGood, 1), 50'000);
  EXPECT_NEAR(got.rate_hz, 83.6, 2.5);
  EXPECT_NEAR(Quantile(got, 0.05), 3, 0.3);
  EXPECT_NEAR(Quantile(got, 0.5), 11, 0.5);
  EXPECT_NEAR(Quantile(got, 0.95), 25, 0.8);
  EXPECT_NEAR(got.repeats, 0.255, 0.1);
}

TEST(LinkModel, APhonesEventsComeInBunchesAndNoneIsLost) {
  LinkModel link(PhoneLink(LinkQuality::kGood, 4), 0);
  std::int64_t turn_ns = 0, sampled_ns = 0;
  std::vector<double> turns_ms;
  for (int i = 0; i < 20'000; ++i) {
    const auto arrival = link.Next();
    EXPECT_NEAR(static_cast<double>(arrival.sampled_ns - sampled_ns), 1e9 / 60, 2);
    EXPECT_LE(arrival.arrives_ns - arrival.sampled_ns, 300'100'000);
    sampled_ns = arrival.sampled_ns;
    if (arrival.arrives_ns - turn_ns < 1'000'000) continue;  // In the same bunch.
    turns_ms.push_back(static_cast<double>(arrival.arrives_ns - turn_ns) * 1e-6);
    turn_ns = arrival.arrives_ns;
  }
  std::sort(turns_ms.begin() + 1, turns_ms.end());
  EXPECT_GE(turns_ms[1], 49.9);
  EXPECT_NEAR(turns_ms[turns_ms.size() / 2], 175, 10);
  EXPECT_LE(turns_ms.back(), 300.1);
}

TEST(LinkModel, APoorBoardLinkIsSlowerAndHasOutages) {
  const Intervals got = Observe(BoardLink(LinkQuality::kPoor, 1), 50'000);
  EXPECT_NEAR(got.rate_hz, 58.1, 6);
  EXPECT_NEAR(Quantile(got, 0.5), 13, 0.7);
  EXPECT_NEAR(Quantile(got, 0.95), 44, 2);
  EXPECT_GT(got.ms.back(), 500);
  EXPECT_LT(got.ms.back(), 20'300);  // The longest outage and one interval.
}

TEST(LinkModel, AGoodWiimoteLinkDeliversAHundredASecond) {
  EXPECT_NEAR(Observe(WiimoteLink(LinkQuality::kGood, 1), 50'000).rate_hz, 100, 3);
}

TEST(LinkModel, AnIdealLinkDeliversEverySampleAtOnce) {
  LinkModel link(WiimoteLink(LinkQuality::kIdeal, 1), 5);
  for (int i = 1; i <= 1000; ++i) {
    const auto arrival = link.Next();
    EXPECT_EQ(arrival.arrives_ns, 5 + i * std::int64_t{10'000'000});
    EXPECT_EQ(arrival.sampled_ns, arrival.arrives_ns);
  }
}

TEST(LinkModel, TheSameSeedGivesTheSameArrivals) {
  LinkModel one(BoardLink(LinkQuality::kPoor, 6), 0);
  LinkModel two(BoardLink(LinkQuality::kPoor, 6), 0);
  LinkModel other(BoardLink(LinkQuality::kPoor, 7), 0);
  bool differs = false;
  for (int i = 0; i < 1000; ++i) {
    const auto arrival = one.Next();
    EXPECT_EQ(arrival.arrives_ns, two.Next().arrives_ns);
    differs = differs || arrival.arrives_ns != other.Next().arrives_ns;
  }
  EXPECT_TRUE(differs);
}

TEST(LinkModel, OnlyThreeNamesAreLinks) {
  EXPECT_EQ(LinkNamed("ideal"), LinkQuality::kIdeal);
  EXPECT_EQ(LinkNamed("good"), LinkQuality::kGood);
  EXPECT_EQ(LinkNamed("poor"), LinkQuality::kPoor);
  EXPECT_FALSE(LinkNamed("perfect"));
}

}  // namespace
}  // namespace footing::virtual_devices
