#include "clients/study/plan/phases.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace footing::study::plan {
namespace {

class WilliamsOrder : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Counts, WilliamsOrder, testing::Values(1, 2, 3, 4, 5, 6, 7, 8));

/// How often each condition is at each position, and how often each follows each other one.
void ExpectBalanced(const Orders& orders, std::size_t count) {
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> at, after;
  for (const auto& order : orders) {
    ASSERT_EQ(std::set<std::size_t>(order.begin(), order.end()).size(), count);
    for (std::size_t i = 0; i < count; ++i) ++at[{order[i], i}];
    for (std::size_t i = 1; i < count; ++i) ++after[{order[i - 1], order[i]}];
  }
  ASSERT_EQ(at.size(), count * count);
  for (const auto& [key, times] : at) EXPECT_EQ(times, orders.size() / count);
  ASSERT_EQ(after.size(), count * (count - 1));  // Every ordered pair of different ones.
  for (const auto& [key, times] : after) EXPECT_EQ(times, orders.size() / count);
}

TEST_P(WilliamsOrder, HasEachConditionEquallyOftenAtEachPositionAndAfterEachOther) {
  const Orders orders = WilliamsOrders(GetParam());
  EXPECT_EQ(orders.size(), GetParam() % 2 == 0 || GetParam() == 1 ? GetParam() : 2 * GetParam());
  ExpectBalanced(orders, GetParam());
}

TEST_P(WilliamsOrder, StaysBalancedInWholeSquaresOfParticipants) {
  const std::size_t rows = WilliamsOrders(GetParam()).size();
  for (const std::uint64_t seed : {0u, 1u, 99u}) {
    ExpectBalanced(BalancedOrders(GetParam(), 3 * rows, seed), GetParam());
  }
}

TEST(Orders, AreTheSameForASeedAndDifferForAnother) {
  EXPECT_EQ(BalancedOrders(4, 16, 7), BalancedOrders(4, 16, 7));
  EXPECT_NE(BalancedOrders(4, 16, 7), BalancedOrders(4, 16, 8));
  EXPECT_EQ(RandomOrders(4, 16, 7), RandomOrders(4, 16, 7));
  EXPECT_NE(RandomOrders(4, 16, 7), RandomOrders(4, 16, 8));
}

TEST(Orders, OfEarlierParticipantsStayWhenOthersAreAdded) {
  for (const auto make : {BalancedOrders, RandomOrders}) {
    Orders longer = make(4, 30, 7);
    longer.resize(15);
    EXPECT_EQ(make(4, 15, 7), longer);
  }
}

TEST(RandomOrders, TakesEveryOrderAboutEquallyOften) {
  std::map<std::vector<std::size_t>, int> times;
  for (const auto& order : RandomOrders(3, 6000, 5)) ++times[order];
  ASSERT_EQ(times.size(), 6u);
  // 1000 each, standard deviation sqrt(6000 / 6 * 5 / 6) = 28.9; five of them.
  for (const auto& [order, count] : times) EXPECT_NEAR(count, 1000, 145);
}

}  // namespace
}  // namespace footing::study::plan
