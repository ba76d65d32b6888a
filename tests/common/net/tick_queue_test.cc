#include "common/net/tick_queue.h"

#include <gtest/gtest.h>

namespace footing::transport {
namespace {

constexpr std::uint32_t kRetained = 16;
constexpr std::uint32_t kStream = 17;

SharedTick MakeTick(std::uint64_t sequence, const std::string& retained = "") {
  auto tick = std::make_shared<Tick>();
  tick->sequence = sequence;
  AppendField(kStream, "s", *tick);
  if (!retained.empty()) AppendField(kRetained, retained, *tick);
  return tick;
}

std::uint64_t PopSequence(TickQueue& queue) {
  TickQueue::Entry entry;
  return queue.Pop(entry) ? entry.tick->sequence : 0;
}

TEST(TickQueue, DropOldestKeepsTheNewestAndSaysWhatIsMissing) {
  TickQueue queue(QueueRule::kDropOldest, 3, {});
  for (std::uint64_t sequence = 1; sequence <= 8; ++sequence) {
    EXPECT_TRUE(queue.Push(MakeTick(sequence)));
  }
  EXPECT_EQ(queue.size(), 3u);
  const auto dropped = queue.TakeDropped();
  ASSERT_TRUE(dropped.has_value());
  EXPECT_EQ(dropped->from, 1u);
  EXPECT_EQ(dropped->to, 5u);
  EXPECT_FALSE(queue.TakeDropped().has_value());
  EXPECT_EQ(queue.dropped_ticks(), 5u);
  EXPECT_EQ(PopSequence(queue), 6u);
}

TEST(TickQueue, LatestHoldsOne) {
  TickQueue queue(QueueRule::kLatest, 100, {});
  queue.Push(MakeTick(1));
  queue.Push(MakeTick(2));
  EXPECT_EQ(queue.size(), 1u);
  EXPECT_EQ(PopSequence(queue), 2u);
}

TEST(TickQueue, ReliableRefusesOneTooMany) {
  TickQueue queue(QueueRule::kReliable, 2, {});
  EXPECT_TRUE(queue.Push(MakeTick(1)));
  EXPECT_TRUE(queue.Push(MakeTick(2)));
  EXPECT_FALSE(queue.Push(MakeTick(3)));
  EXPECT_EQ(PopSequence(queue), 1u);
  EXPECT_EQ(queue.dropped_ticks(), 0u);
}

TEST(TickQueue, ARetainedValueOutlivesTheTickItWasDroppedWith) {
  TickQueue queue(QueueRule::kDropOldest, 2, {kRetained});
  const SharedTick newest = MakeTick(2, "newest");
  queue.Push(MakeTick(1, "older"));
  queue.Push(newest);
  for (std::uint64_t sequence = 3; sequence <= 6; ++sequence) queue.Push(MakeTick(sequence));
  TickQueue::Entry entry;
  ASSERT_TRUE(queue.Pop(entry));
  EXPECT_EQ(entry.tick->sequence, 5u);
  ASSERT_EQ(entry.retained.size(), 1u);
  EXPECT_EQ(entry.retained[0].tick, newest);
  ASSERT_TRUE(queue.Pop(entry));
  EXPECT_TRUE(entry.retained.empty());
}

TEST(TickQueue, ASkippedTickLeavesItsRetainedValueToTheNextOne) {
  TickQueue queue(QueueRule::kDropOldest, 2, {kRetained});
  queue.Push(MakeTick(1));
  queue.Skip(MakeTick(2, "status"));
  queue.Push(MakeTick(3));
  TickQueue::Entry entry;
  queue.Pop(entry);
  EXPECT_TRUE(entry.retained.empty());  // It is older than the value.
  queue.Pop(entry);
  ASSERT_EQ(entry.retained.size(), 1u);
  EXPECT_EQ(entry.retained[0].tick->sequence, 2u);
  EXPECT_FALSE(queue.TakeDropped().has_value());  // Decimation is no Gap.
}

TEST(TickQueue, ASkippedValueIsNewerThanADroppedOne) {
  TickQueue queue(QueueRule::kLatest, 1, {kRetained});
  queue.Push(MakeTick(1, "dropped"));
  queue.Skip(MakeTick(2, "skipped"));
  queue.Push(MakeTick(3));
  TickQueue::Entry entry;
  ASSERT_TRUE(queue.Pop(entry));
  ASSERT_EQ(entry.retained.size(), 1u);
  EXPECT_EQ(entry.retained[0].tick->sequence, 2u);
}

}  // namespace
}  // namespace footing::transport
