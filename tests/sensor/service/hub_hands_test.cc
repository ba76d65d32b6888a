#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "daemon/sensor/service/publish.h"
#include "footing/v1/session.pb.h"
#include "tests/sensor/service/fixture.h"

namespace footing::sensor {
namespace {

using testing::HasSubstr;

stream::HandFrame Fist(double x_m) {
  stream::HandFrame frame;
  frame.points = {{stream::DeviceRole::kLeftHand, {x_m, 0.3, 1.2}, {0.01, 0.01, 0.01}, 1}};
  frame.age_ns = 4'000'000;
  return frame;
}

stream::ReferenceFrame Joint() { return {"", 2'000'000, {-1}, {{0, 0, 1}}, {0, 0, 1}}; }

TEST(HubHands, EverySampleSinceTheLastTickIsPublishedOnce) {
  Bench bench;
  for (int i = 0; i < 5; ++i) bench.hub().OnHands(1'000'000'000 + i, Fist(0.1 * i));
  bench.hub().OnReference(1'000'000'000, Joint());
  bench.Advance(0.05);
  ASSERT_EQ(bench.content.hands.size(), 5u);
  EXPECT_EQ(bench.content.hands[3].position_m.x(), 0.1 * 3);
  EXPECT_EQ(bench.content.hands[3].received_ns, 1'000'000'003);
  EXPECT_EQ(bench.content.hands[3].sampled_ns, 996'000'003);
  EXPECT_EQ(bench.content.hands[3].rig, "main");
  ASSERT_EQ(bench.content.reference.size(), 1u);
  EXPECT_EQ(bench.content.reference[0].rig, "main");
  EXPECT_EQ(bench.content.reference[0].sampled_ns, 998'000'000);
}

TEST(HubHands, FramesThatAreReadTogetherHaveTheTimesAtWhichTheyWereExposed) {
  constexpr std::int64_t kMs = 1'000'000;
  const std::int64_t ages_ns[] = {0, 2 * kMs, 100'000, kMs};  // How late each was sent.
  for (const bool stated : {true, false}) {
    Bench bench;
    const auto send = [&](int i, std::int64_t received_ns) {
      stream::HandFrame frame = Fist(0.1);
      frame.tracker = "eye";
      frame.age_ns = ages_ns[i % 4];
      if (stated) frame.sent_ns = i * 16 * kMs + frame.age_ns;
      bench.hub().OnHands(received_ns, frame);
    };
    std::vector<std::int64_t> sampled_ns;
    const auto publish = [&] {
      bench.Advance(0.01);
      for (const auto& sample : bench.content.hands) sampled_ns.push_back(sample.sampled_ns);
      bench.content.hands.clear();
    };
    for (int i = 1; i < 10; ++i) send(i, i * 16 * kMs + ages_ns[i % 4]);
    publish();
    for (int i = 10; i < 14; ++i) send(i, (13 * 16 + 4) * kMs);  // footingd was busy.
    publish();
    send(14, (14 * 16 + 3) * kMs);
    publish();
    ASSERT_EQ(sampled_ns.size(), 14u);
    for (std::size_t k = 0; k < sampled_ns.size(); ++k) {
      const auto exposed_ms = static_cast<double>(16 * (k + 1));
      EXPECT_NEAR(1e-6 * static_cast<double>(sampled_ns[k]), exposed_ms, stated ? 0 : 8) << k;
      if (k == 0) continue;
      EXPECT_GT(sampled_ns[k], sampled_ns[k - 1]) << stated << " " << k;
    }
  }
}

TEST(HubHands, ABadFrameIsCountedSaidOnceAndLosesNothingElse) {
  Bench bench;
  const auto before = bench.log.size();
  for (int i = 0; i < 100; ++i) {
    bench.hub().OnHands(0, Fist(std::numeric_limits<double>::quiet_NaN()));
    bench.hub().OnHands(0, Fist(0.5));
    auto pose = Joint();
    pose.com_m.x() = std::numeric_limits<double>::infinity();
    bench.hub().OnReference(0, pose);
    bench.hub().OnReference(0, Joint());
    bench.Advance(0.01);
  }
  EXPECT_EQ(bench.hub().refused_frames(), 200u);
  EXPECT_EQ(bench.content.hands.size(), 100u);
  EXPECT_EQ(bench.content.reference.size(), 100u);
  ASSERT_EQ(bench.log.size(), before + 2);
  EXPECT_THAT(bench.log[before], HasSubstr("a hand frame is refused: point 1"));
  EXPECT_THAT(bench.log[before + 1], HasSubstr("a reference frame is refused"));
  bench.Advance(10);
  ASSERT_EQ(bench.log.size(), before + 4) << "the rest is counted when it is over, too";
  EXPECT_THAT(bench.log[before + 2], HasSubstr("(99 refused"));
  EXPECT_THAT(bench.log[before + 3], HasSubstr("(99 refused"));
}

TEST(HubHands, AFloodIsBoundedInEachTick) {
  Bench bench;
  for (std::size_t i = 0; i < 2 * kMaxSamplesPerTick; ++i) bench.hub().OnHands(0, Fist(0));
  for (std::size_t i = 0; i < 2 * kMaxReferencesPerTick; ++i) bench.hub().OnReference(0, Joint());
  bench.Advance(0.02);
  EXPECT_EQ(bench.content.hands.size(), kMaxSamplesPerTick);
  EXPECT_EQ(bench.content.reference.size(), kMaxReferencesPerTick);
}

stream::ContactFrame Insole(double load_n) {
  stream::ContactFrame frame;
  frame.source = "left";
  frame.age_ns = 3'000'000;
  frame.body = stream::ContactBody::kLeftFoot;
  frame.cells = {{{0.1, 0.02, 0}, load_n}};
  return frame;
}

TEST(HubHands, InsolesArePublishedWithTheirTimesAndBadOrTooManyFramesAreNot) {
  Bench bench;
  bench.hub().OnContacts(1'000'000'000, Insole(300));
  bench.hub().OnContacts(1'000'000'000, Insole(std::numeric_limits<double>::quiet_NaN()));
  bench.Advance(0.02);
  ASSERT_EQ(bench.content.contacts.size(), 1u);
  EXPECT_EQ(bench.content.contacts[0].rig, "main");
  EXPECT_EQ(bench.content.contacts[0].source, "left");
  EXPECT_EQ(bench.content.contacts[0].received_ns, 1'000'000'000);
  EXPECT_EQ(bench.content.contacts[0].sampled_ns, 997'000'000);
  EXPECT_EQ(bench.content.contacts[0].cells[0].load_n, 300);
  EXPECT_EQ(bench.hub().refused_frames(), 1u);
  bench.content.contacts.clear();
  for (std::size_t i = 0; i < 2 * kMaxContactsPerTick; ++i) bench.hub().OnContacts(0, Insole(1));
  bench.Advance(0.02);
  EXPECT_EQ(bench.content.contacts.size(), kMaxContactsPerTick);
  std::vector<std::string> names;
  for (const auto& channel : Channels()) names.push_back(channel.name);
  EXPECT_THAT(names, testing::Contains("contacts"));
  for (const auto& channel : ToChannels(bench.content)) {
    if (channel.field != v1::Tick::kContactsFieldNumber) continue;
    v1::ContactSamples list;
    ASSERT_TRUE(list.ParseFromString(channel.bytes));
    EXPECT_EQ(list.samples_size(), static_cast<int>(kMaxContactsPerTick));
    return;
  }
  FAIL() << "no channel carries them";
}

TEST(HubHands, ChannelsCarryThemInTheTicksFields) {
  TickContent content;
  content.hands.emplace_back().position_m.z() = 1.5;
  content.reference.emplace_back().parents = {-1};
  std::string bytes;
  v1::Tick tick;
  for (const auto& channel : ToChannels(content)) {
    if (channel.field == v1::Tick::kHandsFieldNumber)
      tick.mutable_hands()->ParseFromString(channel.bytes);
    if (channel.field == v1::Tick::kReferenceFieldNumber)
      tick.mutable_reference()->ParseFromString(channel.bytes);
  }
  ASSERT_EQ(tick.hands().samples_size(), 1);
  EXPECT_EQ(tick.hands().samples(0).position_m().z(), 1.5);
  ASSERT_EQ(tick.reference().poses_size(), 1);
  std::vector<std::string> names;
  for (const auto& channel : Channels()) names.push_back(channel.name);
  EXPECT_THAT(names, testing::IsSupersetOf({"hands", "reference"}));
}

}  // namespace
}  // namespace footing::sensor
