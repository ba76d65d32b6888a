// The tare of a board at the hub.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/sensor/service/kept.h"

namespace footing::sensor {
namespace {

using testing::HasSubstr;
using virtual_devices::BalanceBoard;
using virtual_devices::Wiimote;

TEST(HubTare, TakesTheEmptyWeightOffWithoutClampingAndIsKept) {
  Kept kept;
  {
    Bench bench({}, kept.storage());
    bench.Attach(BalanceBoard(1), "a");
    bench.corners = {5, -4, 3, -2};
    bench.Advance(3);
    EXPECT_FALSE(bench.StatusOf("a").tared);
    const auto tare = bench.hub().setup().Tare("a", 0, false);
    ASSERT_TRUE(tare) << tare.error().message;
    EXPECT_EQ(tare->unit, "N");
    EXPECT_LT(tare->residual, 1);
    bench.Advance(0.1);
    EXPECT_TRUE(bench.StatusOf("a").tared);
    EXPECT_TRUE(bench.content.boards.back().tared);
    EXPECT_NEAR(bench.content.boards.back().total_n, 0, 0.01);
    // Less than empty by 8 N: below zero, and published so.
    bench.corners = {3, -6, 1, -4};
    bench.Advance(0.1);
    EXPECT_NEAR(bench.content.boards.back().total_n, -8, 0.5);
  }
  Bench again({}, kept.storage());
  again.Attach(BalanceBoard(1), "a");
  again.corners = {5, -4, 3, -2};
  again.Advance(0.5);
  EXPECT_TRUE(again.StatusOf("a").tared);
  EXPECT_NEAR(again.content.boards.back().top_left_n, 0, 0.2);
  ASSERT_TRUE(again.hub().setup().Tare("a", 0, true));
  again.Advance(0.1);
  EXPECT_FALSE(again.StatusOf("a").tared);
  EXPECT_NEAR(again.content.boards.back().top_left_n, 5, 0.2);
}

TEST(HubTare, RefusesAMovingLoadAPersonAnotherDeviceAndNobody) {
  Bench bench;
  bench.Attach(BalanceBoard(1), "a");
  bench.Attach(Wiimote(2), "b");
  bench.corners = {10, 10, 10, 10};
  bench.Advance(1);
  const auto early = bench.hub().setup().Tare("a", 0, false);
  EXPECT_THAT(early.ok() ? "" : early.error().message, HasSubstr("2.0 are needed"));
  bench.Advance(1.5);
  bench.corners = {20, 20, 20, 20};  // Somebody puts a foot on it.
  bench.Advance(0.5);
  const auto moving = bench.hub().setup().Tare("a", 0, false);
  EXPECT_THAT(moving.ok() ? "" : moving.error().message, HasSubstr("moves"));
  bench.corners = {170, 170, 170, 170};
  bench.Advance(3);
  const auto heavy = bench.hub().setup().Tare("a", 0, false);
  EXPECT_THAT(heavy.ok() ? "" : heavy.error().message, HasSubstr("step off"));
  EXPECT_FALSE(bench.hub().setup().Tare("b", 0, false));
  EXPECT_FALSE(bench.hub().setup().Tare("nobody", 0, false));
  EXPECT_FALSE(bench.hub().setup().Tare("a", std::nan(""), false));
  EXPECT_FALSE(bench.StatusOf("a").tared);
}

}  // namespace
}  // namespace footing::sensor
