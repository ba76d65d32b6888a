#include "common/runtime/timer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/runtime/clock.h"
#include "tests/common/runtime/simulated_time.h"

namespace footing::timer {
namespace {

using namespace std::chrono_literals;

/// Runs `work` on simulated time, and returns how much of it passed, s.
double OnSimulatedTime(const std::function<void()>& work) {
  const SimulatedTime simulated;
  const std::int64_t begin_ns = clock::MonotonicNs();
  work();
  return static_cast<double>(clock::MonotonicNs() - begin_ns) * 1e-9;
}

/// Three timers, one of which is cancelled; what the handlers saw, by name and time since the
/// start.
std::vector<std::string> RunTimers(std::chrono::nanoseconds unit) {
  std::vector<std::string> seen;
  boost::asio::io_context io(1);
  const TimePoint begin = Now();
  Timer late(io), early(io), cancelled(io);
  const auto note = [&](const std::string& who) {
    return [&seen, who, begin, unit](const boost::system::error_code& error) {
      const bool soon = (Now() - begin) / unit == 0;
      seen.push_back(who + (error ? " cancelled" : soon ? " at once" : " later"));
    };
  };
  late.expires_after(3 * unit);
  late.async_wait(note("late"));
  cancelled.expires_after(100'000 * unit);
  cancelled.async_wait(note("other"));
  early.expires_after(unit);
  early.async_wait([&, noted = note("early")](const boost::system::error_code& error) {
    noted(error);
    cancelled.cancel();
    early.expires_at(begin);  // In the past.
    early.async_wait([&](const boost::system::error_code&) { seen.push_back("again"); });
  });
  Run(io);
  return seen;
}

const std::vector<std::string> kInOrder = {"early later", "other cancelled", "again", "late later"};

TEST(TimerTest, HandlersComeInTheOrderOfTheirTimes) { EXPECT_EQ(RunTimers(200ms), kInOrder); }

TEST(TimerTest, OnSimulatedTimeHoursPassAtOnce) {
  std::vector<std::string> seen;
  const auto begin = std::chrono::steady_clock::now();
  const double passed_s = OnSimulatedTime([&] { seen = RunTimers(1h); });
  EXPECT_EQ(seen, kInOrder);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 1h);
  EXPECT_NEAR(passed_s, 3 * 3600, 1e-9);
}

TEST(TimerTest, ATimerThatIsDestroyedCancelsItsWait) {
  bool aborted = false;
  OnSimulatedTime([&] {
    boost::asio::io_context io(1);
    {
      Timer timer(io);
      timer.expires_after(1h);
      timer.async_wait([&](const boost::system::error_code& error) {
        aborted = error == boost::asio::error::operation_aborted;
      });
    }
    timer::Run(io);
  });
  EXPECT_TRUE(aborted);
}

TEST(TimerTest, OneHandlerOrTheEndReturns) {
  int handled = 0;
  const double passed_s = OnSimulatedTime([&] {
    boost::asio::io_context io(1);
    Timer timer(io);
    timer.expires_after(10s);
    timer.async_wait([&](const boost::system::error_code&) { ++handled; });
    const TimePoint begin = Now();
    RunOneUntil(io, begin + 4s);
    EXPECT_EQ(handled, 0);
    EXPECT_EQ(Now(), begin + 4s);
    RunOneUntil(io, begin + 20s);
    EXPECT_EQ(handled, 1);
    EXPECT_EQ(Now(), begin + 10s);
  });
  EXPECT_NEAR(passed_s, 10, 1e-9);
}

/// Both expire before the loop runs; the first one's handler ends the second one.
void EndOneThatHasExpired() {
  boost::asio::io_context io(1);
  Timer first(io);
  auto second = std::make_unique<Timer>(io);
  const TimePoint expiry = Now() - 1ms;
  bool ended = false;
  first.expires_at(expiry);
  first.async_wait([&](const boost::system::error_code&) { second.reset(); });
  second->expires_at(expiry);
  second->async_wait([&](const boost::system::error_code& error) {
    EXPECT_EQ(error, boost::asio::error::operation_aborted);
    ended = true;
  });
  Run(io);
  EXPECT_TRUE(ended);
}

TEST(Timer, ThatEndsWhenItHasExpiredCountsAsCancelled) {
  EndOneThatHasExpired();
  OnSimulatedTime(EndOneThatHasExpired);
}

/// Both have expired before the loop runs; the first one cancels the second.
void CancelOneThatHasExpired() {
  boost::asio::io_context io(1);
  Timer first(io), second(io);
  std::string called;
  first.At(Now() - 2ms, [&] {
    called += "first";
    second.cancel();
  });
  second.At(Now() - 1ms, [&] { called += "second"; });
  Run(io);
  EXPECT_EQ(called, "first");
}

TEST(Timer, AfterACancelNothingIsCalledAnyMore) {
  CancelOneThatHasExpired();
  OnSimulatedTime(CancelOneThatHasExpired);
}

}  // namespace
}  // namespace footing::timer
