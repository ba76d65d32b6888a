#include "clients/relay/channels.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "common/net/server.h"

namespace footing::relay {
namespace {

constexpr std::uint32_t kStatus = 16, kMotion = 17, kFeatures = 18, kEvents = 27;
constexpr std::int64_t kTickNs = 10'000'000;  // 100 Hz.

std::map<std::uint32_t, std::string> Fields(const Thinner::Thinned& thinned) {
  std::map<std::uint32_t, std::string> fields;
  for (const auto& channel : thinned.channels) fields[channel.field] = channel.bytes;
  return fields;
}

std::optional<Thinner::Thinned> TakeAt(Thinner& thinner, std::uint64_t sequence,
                                       std::vector<transport::ChannelBytes> channels) {
  return thinner.Take({sequence, static_cast<std::int64_t>(sequence) * kTickNs},
                      std::move(channels));
}

TEST(Thinner, SamplesComeAtTheRateAndTheNewestIsTaken) {
  Thinner thinner(30, 100, 0);
  int given = 0;
  for (std::uint64_t sequence = 1; sequence <= 1000; ++sequence) {
    const auto thinned = TakeAt(thinner, sequence, {{kMotion, std::to_string(sequence)}});
    if (!thinned) continue;
    ++given;
    EXPECT_EQ(Fields(*thinned)[kMotion], std::to_string(sequence));
    EXPECT_EQ(thinned->number.missing_from, 0u);
  }
  EXPECT_NEAR(given, 300, 1);  // 10 s at 30 Hz.
  EXPECT_EQ(thinner.left_out(), 1000u - static_cast<unsigned>(given));
  EXPECT_EQ(thinner.missing(), 0u);
}

TEST(Thinner, RetainedChannelsAndEventsAreNeverLeftOut) {
  Thinner thinner(10, 100, 0);
  int events = 0, states = 0, ticks = 0;
  for (std::uint64_t sequence = 1; sequence <= 100; ++sequence) {
    std::vector<transport::ChannelBytes> channels = {{kMotion, "m"}};
    if (sequence % 7 == 0) channels.push_back({kEvents, "e"});
    if (sequence % 11 == 0) channels.push_back({kStatus, "s"});
    const auto thinned = TakeAt(thinner, sequence, channels);
    if (!thinned) continue;
    auto fields = Fields(*thinned);
    events += static_cast<int>(fields.count(kEvents));
    states += static_cast<int>(fields.count(kStatus));
    ticks += static_cast<int>(fields.count(kMotion));
  }
  EXPECT_EQ(events, 14);
  EXPECT_EQ(states, 9);
  EXPECT_NEAR(ticks, 10, 1);
}

TEST(Thinner, TheLastSampleBeforeAPauseGoesWithALaterTick) {
  Thinner thinner(10, 100, 0);
  ASSERT_TRUE(TakeAt(thinner, 1, {{kMotion, "first"}}));
  EXPECT_FALSE(TakeAt(thinner, 2, {{kMotion, "second"}}));
  EXPECT_FALSE(TakeAt(thinner, 3, {{kMotion, "last"}}));
  for (std::uint64_t sequence = 4; sequence <= 20; ++sequence) {
    const auto thinned = TakeAt(thinner, sequence, {});
    if (!thinned) continue;
    EXPECT_EQ(Fields(*thinned)[kMotion], "last");
    EXPECT_NEAR(static_cast<double>(sequence), 11, 1);  // 10 Hz after the first.
    return;
  }
  FAIL() << "it never came";
}

TEST(Thinner, ChannelsOfDifferentTicksShareTheFrames) {
  Thinner thinner(30, 100, 0);
  int frames = 0, motions = 0, features = 0;
  for (std::uint64_t sequence = 1; sequence <= 1000; ++sequence) {
    const auto thinned =
        TakeAt(thinner, sequence, {{sequence % 2 == 0 ? kFeatures : kMotion, "s"}});
    if (!thinned) continue;
    auto fields = Fields(*thinned);
    ++frames;
    motions += static_cast<int>(fields.count(kMotion));
    features += static_cast<int>(fields.count(kFeatures));
  }
  EXPECT_NEAR(frames, 300, 1);  // Not one of each channel.
  EXPECT_NEAR(motions, frames, 1);
  EXPECT_NEAR(features, frames, 1);
}

TEST(Thinner, AHoleIsGivenAtOnceWithItsFirstAndLast) {
  Thinner thinner(10, 100, 1000);
  ASSERT_TRUE(TakeAt(thinner, 1001, {{kMotion, "m"}}));
  const auto thinned = TakeAt(thinner, 1004, {{kMotion, "n"}});
  ASSERT_TRUE(thinned);
  EXPECT_EQ(thinned->number.missing_from, 1002u);
  EXPECT_EQ(thinned->number.sequence, 1004u);
  EXPECT_TRUE(thinned->channels.empty());  // The sample is not due.
  EXPECT_EQ(thinner.missing(), 2u);
}

TEST(Thinner, WhatWasHadAlreadyIsLeftOut) {
  Thinner thinner(0, 100, 10);
  EXPECT_FALSE(TakeAt(thinner, 10, {{kEvents, "e"}}));
  EXPECT_TRUE(TakeAt(thinner, 11, {{kEvents, "e"}}));
  EXPECT_FALSE(TakeAt(thinner, 11, {{kEvents, "e"}}));
}

TEST(Thinner, NumbersBehindWhichNothingCanComeAreLeftOut) {
  Thinner thinner(30, 100, 0);
  const auto last = std::numeric_limits<std::uint64_t>::max();
  const auto end_ns = std::numeric_limits<std::int64_t>::max();
  EXPECT_FALSE(thinner.Take({last, kTickNs}, {{kEvents, "e"}}));
  EXPECT_FALSE(thinner.Take({1, end_ns}, {{kEvents, "e"}}));
  EXPECT_FALSE(thinner.Take({1, -end_ns}, {{kEvents, "e"}}));
  EXPECT_TRUE(TakeAt(thinner, 1, {{kMotion, "m"}}));
  EXPECT_EQ(thinner.missing(), 0u);
}

TEST(Thinner, WithoutARateEveryTickComes) {
  Thinner thinner(0, 100, 0);
  for (std::uint64_t sequence = 1; sequence <= 50; ++sequence) {
    EXPECT_TRUE(TakeAt(thinner, sequence, {}));
  }
}

TEST(Thinner, WhatASnapshotRetainsGoesWithTheNextTickUnlessThatHasANewerOne) {
  Thinner thinner(10, 100, 0);
  thinner.TakeRetained(0, {{kStatus, "old"}, {kMotion, "no state"}});
  auto thinned = TakeAt(thinner, 1, {{kStatus, "new"}});
  EXPECT_EQ(Fields(*thinned)[kStatus], "new");
  thinner.TakeRetained(1, {{kStatus, "again"}});
  thinned = TakeAt(thinner, 2, {});
  ASSERT_TRUE(thinned);
  EXPECT_EQ(Fields(*thinned)[kStatus], "again");
  EXPECT_EQ(Fields(*thinned).count(kMotion), 0u);
  EXPECT_FALSE(TakeAt(thinner, 3, {}));
}

TEST(Thinner, ASnapshotThatIsOlderThanAStateTakesItNotBack) {
  Thinner thinner(10, 100, 0);
  ASSERT_TRUE(TakeAt(thinner, 5, {{kStatus, "of 5"}}));
  thinner.TakeRetained(4, {{kStatus, "of 4"}});
  EXPECT_FALSE(TakeAt(thinner, 6, {}));
  thinner.TakeRetained(6, {{kStatus, "of 6"}});
  thinner.TakeRetained(5, {{kStatus, "of 5"}});  // It has not gone yet.
  const auto thinned = TakeAt(thinner, 7, {});
  ASSERT_TRUE(thinned);
  EXPECT_EQ(Fields(*thinned)[kStatus], "of 6");
}

TEST(Channels, EveryChannelOfTheProtocolIsOfAKind) {
  EXPECT_EQ(KindOf(kStatus), ChannelKind::kRetained);
  EXPECT_EQ(KindOf(26), ChannelKind::kSampled);  // characters
  EXPECT_EQ(KindOf(kEvents), ChannelKind::kWhole);
  EXPECT_EQ(KindOf(9999), ChannelKind::kWhole);
}

TEST(TickMessage, IsAnEnvelopeOfTheProtocol) {
  v1::Tick tick;
  tick.mutable_status()->add_devices()->set_serial("s");
  tick.mutable_motion()->add_samples()->set_device(3);
  v1::Envelope message;
  ASSERT_TRUE(message.ParseFromString(TickMessage(77, {5, 6}, transport::ChannelsOf(tick))));
  EXPECT_EQ(message.tick().epoch(), 77u);
  EXPECT_EQ(message.tick().sequence(), 5u);
  EXPECT_EQ(message.tick().host_ns(), 6);
  EXPECT_EQ(message.tick().status().devices(0).serial(), "s");
  EXPECT_EQ(message.tick().motion().samples(0).device(), 3u);
}

}  // namespace
}  // namespace footing::relay
