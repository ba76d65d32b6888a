#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <thread>

#include "common/runtime/exchange.h"

namespace footing::exchange {
namespace {

TEST(Latest, GivesTheNewestValueOnce) {
  Latest<int> latest(7);
  EXPECT_FALSE(latest.Refresh());
  EXPECT_EQ(latest.Front(), 7);
  latest.Write(1);
  latest.Write(2);
  EXPECT_TRUE(latest.Refresh());
  EXPECT_EQ(latest.Front(), 2);
  EXPECT_FALSE(latest.Refresh());
}

TEST(Latest, NeverTearsAValueBetweenThreads) {
  struct Pair {
    std::uint64_t a = 0;
    std::uint64_t b = 0;
  };
  constexpr std::uint64_t kWrites = 200'000;
  Latest<Pair> latest;
  std::thread writer([&latest] {
    for (std::uint64_t i = 1; i <= kWrites; ++i) latest.Write({i, ~i});
  });
  std::uint64_t last = 0;
  while (last < kWrites) {
    if (!latest.Refresh()) continue;
    const Pair pair = latest.Front();
    ASSERT_EQ(pair.b, ~pair.a);
    ASSERT_GT(pair.a, last);
    last = pair.a;
  }
  writer.join();
}

TEST(BoundedQueue, KeepsOrderAndRefusesTheNewestWhenFull) {
  BoundedQueue<std::string> queue(2);
  EXPECT_TRUE(queue.Push("a"));
  EXPECT_TRUE(queue.Push("b"));
  EXPECT_FALSE(queue.Push("c"));
  EXPECT_EQ(queue.refused(), 1u);
  std::string item;
  ASSERT_TRUE(queue.Pop(item));
  EXPECT_EQ(item, "a");
  EXPECT_TRUE(queue.Push("d"));
  ASSERT_TRUE(queue.Pop(item));
  EXPECT_EQ(item, "b");
  ASSERT_TRUE(queue.Pop(item));
  EXPECT_EQ(item, "d");
  EXPECT_FALSE(queue.Pop(item));
}

TEST(BoundedQueue, LosesNothingBetweenThreadsThatItDidNotRefuse) {
  constexpr int kItems = 100'000;
  BoundedQueue<int> queue(64);
  std::thread producer([&queue] {
    for (int i = 0; i < kItems; ++i) {
      while (!queue.Push(i)) std::this_thread::yield();
    }
  });
  for (int expected = 0; expected < kItems;) {
    int item = -1;
    if (!queue.Pop(item)) continue;
    ASSERT_EQ(item, expected++);
  }
  producer.join();
}

}  // namespace
}  // namespace footing::exchange
