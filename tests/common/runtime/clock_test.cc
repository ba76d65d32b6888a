#include "common/runtime/clock.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace footing::clock {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kWallNs = 1'700'000'000'000'000'000;

/// Steps of the threads, in the order in which they did them: one works at a time.
struct Done {
  std::string who;
  std::int64_t after_ns = 0;
  bool operator==(const Done&) const = default;
};

void PrintTo(const Done& done, std::ostream* out) { *out << done.who << " at " << done.after_ns; }

/// Threads on the time of one timekeeper, which is the test's own thread.
class ClockTest : public testing::Test {
 protected:
  ClockTest() { EXPECT_NE(::mkdtemp(folder_.data()), nullptr); }
  ~ClockTest() override { std::filesystem::remove_all(folder_); }

  void Start(Timekeeper& keeper, std::function<void()> work) {
    threads_.emplace_back([this, work = std::move(work)] {
      auto follower = Follower::Connect(path());
      ASSERT_TRUE(follower) << follower.error().message;
      Follow(std::move(follower).value());
      work();
      Follow(nullptr);
    });
    ASSERT_TRUE(keeper.AwaitFollower(10, [] { return false; }));
  }

  /// Until all threads have ended.
  void RunAll(Timekeeper& keeper) {
    while (keeper.followers() > 0) ASSERT_TRUE(keeper.GiveTurn());
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

  void Note(const std::string& who, std::int64_t begin_ns) {
    const std::int64_t after_ns = MonotonicNs() - begin_ns;
    // Turns come over sockets, whose order ThreadSanitizer does not see.
    const std::lock_guard lock(noting_);
    done_.push_back({who, after_ns});
  }

  std::string path() const { return folder_ + "/time"; }

  std::string folder_ = "/tmp/footing-clock-XXXXXX";
  std::vector<std::thread> threads_;
  std::mutex noting_;
  std::vector<Done> done_;
};

TEST_F(ClockTest, TimeGoesOnToTheNextInstantAtWhichAThreadIsDue) {
  auto keeper = Timekeeper::Listen(path(), kWallNs);
  ASSERT_TRUE(keeper);
  const std::int64_t begin_ns = keeper->now_ns();
  const auto sleeper = [&](const std::string& who, std::int64_t every_ms) {
    return [this, who, every_ms, begin_ns] {
      for (int i = 1; i <= 2; ++i) {
        SleepUntil(begin_ns + i * every_ms * kMs);
        Act();
        Note(who, begin_ns);
      }
    };
  };
  Start(*keeper, sleeper("slow", 3'600'000));  // Two hours, without waiting for them.
  Start(*keeper, sleeper("fast", 1'200'000));
  RunAll(*keeper);
  const std::vector<Done> expected = {{"fast", 1'200'000 * kMs},
                                      {"fast", 2'400'000 * kMs},
                                      {"slow", 3'600'000 * kMs},
                                      {"slow", 7'200'000 * kMs}};
  EXPECT_EQ(done_, expected);
  EXPECT_EQ(keeper->now_ns() - begin_ns, 7'200'000 * kMs);
}

TEST_F(ClockTest, WithinAnInstantThreadsWorkInTheOrderInWhichTheyCame) {
  auto keeper = Timekeeper::Listen(path(), kWallNs);
  ASSERT_TRUE(keeper);
  const std::int64_t begin_ns = keeper->now_ns();
  for (const std::string who : {"a", "b", "c"}) {
    Start(*keeper, [this, who, begin_ns] {
      for (int i = 1; i <= 50; ++i) {
        SleepUntil(begin_ns + i * kMs);
        Note(who, begin_ns);
        Act();
      }
    });
  }
  RunAll(*keeper);
  ASSERT_EQ(done_.size(), 150u);
  for (std::size_t i = 0; i < done_.size(); ++i) {
    const Done expected{std::string(1, static_cast<char>('a' + i % 3)),
                        static_cast<std::int64_t>(1 + i / 3) * kMs};
    EXPECT_EQ(done_[i], expected) << i;
  }
}

TEST_F(ClockTest, WhoListensHasATurnAtTheInstantAtWhichAnotherHasActed) {
  auto keeper = Timekeeper::Listen(path(), kWallNs);
  ASSERT_TRUE(keeper);
  const std::int64_t begin_ns = keeper->now_ns();
  Start(*keeper, [&] {
    OwnFollower()->Listen(kNever);
    Note("listens", begin_ns);
  });
  Start(*keeper, [&] {
    SleepUntil(begin_ns + 5 * kMs);  // Does nothing of interest.
    SleepUntil(begin_ns + 7 * kMs);
    Act();
    Note("acts", begin_ns);
    SleepUntil(begin_ns + 9 * kMs);
  });
  RunAll(*keeper);
  const std::vector<Done> expected = {{"acts", 7 * kMs}, {"listens", 7 * kMs}};
  EXPECT_EQ(done_, expected);
}

TEST_F(ClockTest, AThreadThatAFollowerStartsHasItsFirstTurnBeforeTheTimeGoesOn) {
  auto keeper = Timekeeper::Listen(path(), kWallNs);
  ASSERT_TRUE(keeper);
  const std::int64_t begin_ns = keeper->now_ns();
  Start(*keeper, [&] {
    SleepUntil(begin_ns + 3 * kMs);
    std::thread second([this, begin_ns, follower = NewFollower()]() mutable {
      Follow(std::move(follower));
      Note("second", begin_ns);
      SleepUntil(begin_ns + 4 * kMs);
      Note("second", begin_ns);
      Follow(nullptr);
    });
    SleepUntil(begin_ns + 10 * kMs);
    Note("first", begin_ns);
    second.join();
  });
  RunAll(*keeper);
  const std::vector<Done> expected = {
      {"second", 3 * kMs}, {"second", 4 * kMs}, {"first", 10 * kMs}};
  EXPECT_EQ(done_, expected);
}

TEST_F(ClockTest, TheWallClockGoesOnWithSimulatedTime) {
  auto keeper = Timekeeper::Listen(path(), kWallNs);
  ASSERT_TRUE(keeper);
  const std::int64_t begin_ns = keeper->now_ns();
  std::int64_t wall_ns = 0;
  Start(*keeper, [&] {
    SleepUntil(begin_ns + 42 * kMs);
    wall_ns = WallNs();
  });
  RunAll(*keeper);
  EXPECT_EQ(wall_ns, kWallNs + 42 * kMs);
}

TEST_F(ClockTest, NobodyWhoWaitsForAnInstantIsAnEnd) {
  auto keeper = Timekeeper::Listen(path(), kWallNs);
  ASSERT_TRUE(keeper);
  EXPECT_FALSE(keeper->GiveTurn());
  EXPECT_FALSE(keeper->AwaitFollower(10, [] { return true; }));
}

TEST_F(ClockTest, WithoutATimekeeperAThreadHasTheHostsTime) {
  ASSERT_TRUE(FollowTimekeeper());
  EXPECT_EQ(OwnFollower(), nullptr);
  EXPECT_EQ(NewFollower(), nullptr);
  Act();
  const std::int64_t before_ns = MonotonicNs();
  SleepUntil(before_ns + 2 * kMs);
  EXPECT_GE(MonotonicNs(), before_ns + 2 * kMs);
}

TEST_F(ClockTest, ATimekeeperThatIsNotThereIsNamed) {
  const auto follower = Follower::Connect(path());
  ASSERT_FALSE(follower);
  EXPECT_NE(follower.error().message.find(path()), std::string::npos) << follower.error().message;
  EXPECT_FALSE(Follower::Connect(std::string(200, 'x')));
}

}  // namespace
}  // namespace footing::clock
