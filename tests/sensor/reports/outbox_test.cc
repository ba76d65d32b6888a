#include "daemon/sensor/reports/outbox.h"

#include <gtest/gtest.h>

namespace footing::link {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(Outbox, WritesAtMostOneReportInTenMilliseconds) {
  Outbox outbox;
  for (int i = 0; i < 20; ++i) outbox.Push(reports::RequestStatus());
  int written = 0;
  for (std::int64_t now_ns = 0; now_ns <= 100 * kMs; now_ns += kMs) {
    if (outbox.Next(now_ns)) ++written;
  }
  EXPECT_EQ(written, 11);  // At 0, 10, ... 100 ms.
}

TEST(Outbox, EveryReportKeepsTheMotorRunning) {
  Outbox outbox;
  outbox.SetRumble(true);
  outbox.Push(reports::SetLeds(1));
  outbox.Push(reports::SetMode(0x31, true));
  EXPECT_EQ(outbox.Next(0), (reports::OutputReport{0x11, 0x11}));
  EXPECT_EQ(outbox.Next(10 * kMs), (reports::OutputReport{0x12, 0x05, 0x31}));
  EXPECT_FALSE(outbox.Next(20 * kMs));
  outbox.SetRumble(false);
  EXPECT_EQ(outbox.Next(30 * kMs), (reports::OutputReport{0x10, 0x00}));
}

TEST(Outbox, SwitchingTheMotorNeedsNoOtherReport) {
  Outbox outbox;
  outbox.SetRumble(true);
  EXPECT_EQ(outbox.Next(0), (reports::OutputReport{0x10, 0x01}));
  EXPECT_FALSE(outbox.Next(10 * kMs));
}

TEST(Outbox, RefusesWhenItIsFull) {
  Outbox outbox;
  for (std::size_t i = 0; i < Outbox::kCapacity; ++i) {
    EXPECT_TRUE(outbox.Push(reports::RequestStatus()));
  }
  EXPECT_FALSE(outbox.Push(reports::RequestStatus()));
}

}  // namespace
}  // namespace footing::link
