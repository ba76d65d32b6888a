#include "common/net/tick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/net/framing.h"
#include "common/net/server.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {
namespace {

v1::MotionSamples Motion(std::uint32_t device) {
  v1::MotionSamples motion;
  motion.add_samples()->set_device(device);
  return motion;
}

v1::Tick TickOf(const TickHead& head) {
  v1::Tick tick;
  tick.set_epoch(head.epoch);
  tick.set_sequence(head.sequence);
  tick.set_host_ns(head.host_ns);
  tick.set_snapshot(head.snapshot);
  tick.set_refilled(head.refilled);
  return tick;
}

TEST(Tick, HandWrittenHeadAndSharedBytesAreWhatProtobufWrites) {
  const TickHead heads[] = {
      {1, 2, 3, false, false},
      {0, 0, 0, true, false},
      {std::numeric_limits<std::uint64_t>::max(), 1u << 20, -1, true, true},
  };
  for (const TickHead& head : heads) {
    for (const std::uint32_t device : {0u, 7u}) {
      Tick tick;
      AppendField(17, Motion(device).SerializeAsString(), tick);
      char bytes[kMaxTickHeadBytes];
      const std::size_t size = EncodeTickHead(head, tick.bytes.size(), bytes);
      ASSERT_LE(size, kMaxTickHeadBytes);

      v1::Envelope expected;
      *expected.mutable_tick() = TickOf(head);
      *expected.mutable_tick()->mutable_motion() = Motion(device);
      EXPECT_EQ(std::string(bytes, size) + tick.bytes, Frame(expected.SerializeAsString()));
    }
  }
}

TEST(TickRateOf, IsTheServersWhereItCanBe) {
  v1::Welcome welcome;
  EXPECT_EQ(TickRateOf(welcome, 100), 100);
  welcome.mutable_limits()->set_tick_rate_hz(200);
  EXPECT_EQ(TickRateOf(welcome, 100), 200);
  const double infinite_hz = std::numeric_limits<double>::infinity();
  for (const double rate_hz : {-1.0, 1e-300, 1e9, infinite_hz, std::nan("")}) {
    welcome.mutable_limits()->set_tick_rate_hz(rate_hz);
    EXPECT_EQ(TickRateOf(welcome, 100), 100) << rate_hz;
  }
}

ServerOptions Options() {
  ServerOptions options;
  options.channels = {{"status", 16, true}, {"motion", 17, false}};
  options.tick_rate_hz = 10;
  options.ring_s = 0.5;
  return options;
}

std::string StatusBytes(const std::string& serial) {
  v1::DeviceStatusList list;
  list.add_devices()->set_serial(serial);
  return list.SerializeAsString();
}

TEST(Publication, TheRingHoldsItsSecondsAndNoMore) {
  Publication publication(Options());
  for (std::uint64_t i = 0; i < 12; ++i) {
    publication.Keep(publication.Publish({i + 1, static_cast<std::int64_t>(i)}, {}));
  }
  // 0.5 s at 10 Hz are 5 ticks.
  EXPECT_EQ(publication.ring().first(), 8u);
  EXPECT_EQ(publication.ring().last(), 12u);
  EXPECT_EQ((*publication.ring().AtOrAfter(7))->host_ns, 7);
  EXPECT_EQ((*publication.ring().AtOrAfter(8))->host_ns, 7);
  EXPECT_EQ(publication.ring().AtOrAfter(13), nullptr);
}

TEST(Publication, TheRingOfARelayHasHoles) {
  Publication publication(Options());
  for (const std::uint64_t sequence : {100u, 103u, 106u})
    publication.Keep(publication.Publish({sequence, 0}, {}));
  EXPECT_EQ((*publication.ring().AtOrAfter(1))->sequence, 100u);
  EXPECT_EQ((*publication.ring().AtOrAfter(101))->sequence, 103u);
  EXPECT_EQ((*publication.ring().AtOrAfter(106))->sequence, 106u);
  EXPECT_EQ(publication.ring().AtOrAfter(107), nullptr);
  EXPECT_EQ(publication.ring().CountFrom(101), 2u);
  EXPECT_EQ(publication.ring().CountFrom(107), 0u);
}

TEST(Publication, TheRingIsBoundedInBytesToo) {
  ServerOptions options = Options();
  options.ring_s = 1000;
  options.ring_max_bytes = 100'000;
  Publication publication(options);
  for (std::uint64_t i = 1; i <= 50; ++i) {
    publication.Keep(publication.Publish({i, 0}, {{17, std::string(10'000, '\0')}}));
  }
  EXPECT_LE(publication.ring().bytes(), 100'000u);
  EXPECT_EQ(publication.ring().last(), 50u);
  EXPECT_GE(publication.ring().first(), 41u);
}

TEST(Publication, TheSnapshotHoldsTheLastValueOfRetainedChannelsOnly) {
  Publication publication(Options());
  publication.Keep(
      publication.Publish({1, 1}, {{16, StatusBytes("old")}, {17, Motion(1).SerializeAsString()}}));
  publication.Keep(publication.Publish({2, 2}, {{16, StatusBytes("new")}}));
  publication.Keep(publication.Publish({3, 3}, {{17, Motion(2).SerializeAsString()}}));
  const SharedTick snapshot = publication.Snapshot(3, 99);
  v1::Tick tick;
  ASSERT_TRUE(tick.ParseFromString(snapshot->bytes));
  EXPECT_EQ(tick.status().devices(0).serial(), "new");
  EXPECT_EQ(tick.status().devices_size(), 1);
  EXPECT_FALSE(tick.has_motion());
  EXPECT_EQ(snapshot->sequence, 3u);
}

TEST(Publication, WhatDoesNotFitOrIsNoChannelIsLeftOutAndCounted) {
  ServerOptions options = Options();
  options.max_message_out_bytes = 1000;
  Publication publication(options);
  const SharedTick tick = publication.Publish(
      {1, 1}, {{16, StatusBytes("s")}, {17, std::string(2000, 'x')}, {99, "no channel"}});
  EXPECT_EQ(publication.channels_left_out(), 2u);
  EXPECT_NE(tick->Find(16), nullptr);
  EXPECT_EQ(tick->Find(17), nullptr);
  EXPECT_EQ(tick->Find(99), nullptr);
}

}  // namespace
}  // namespace footing::transport
