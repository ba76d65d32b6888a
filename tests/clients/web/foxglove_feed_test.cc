#include "clients/web/foxglove_feed.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "foxglove/messages.pb.h"

namespace footing::web {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr std::int64_t kTickNs = 100'000'000;

/// A tick of a server with a track of one segment and a character of one link, or an event alone.
v1::Tick TickOf(bool first) {
  v1::Tick tick;
  if (first) {
    tick.mutable_skeletons()->add_skeletons()->add_links()->set_name("body");
    tick.mutable_track()->add_segments()->set_length_m(2);
  }
  tick.mutable_characters()->add_characters()->add_links();
  return tick;
}

v1::Tick EventOf(const std::string& text) {
  v1::Tick tick;
  tick.mutable_events()->add_events()->set_text(text);
  return tick;
}

class FoxgloveFeedTest : public testing::Test {
 protected:
  void Tick(const v1::Tick& tick) {
    now_ns_ += kTickNs;
    feed_.OnTick("footing-sim", tick, {now_ns_, now_ns_, 0});
  }

  /// Everything that the feed has to send; advertised channels by topic.
  void Drain() {
    texts_.clear();
    data_.clear();
    while (const auto message = feed_.Next()) {
      if (!message->is_text) {
        data_.push_back(message->bytes);
        continue;
      }
      const json said = json::parse(message->bytes);
      for (const json& channel : said.value("channels", json::array())) {
        channels_[channel["topic"]] = channel;
      }
      texts_.push_back(said);
    }
  }

  void Subscribe(std::uint32_t id, const std::string& topic) {
    const json wish = {{"op", "subscribe"},
                       {"subscriptions", {{{"id", id}, {"channelId", channels_[topic]["id"]}}}}};
    ASSERT_TRUE(feed_.Take(wish.dump()).ok());
  }

  FoxgloveFeed feed_{"one start"};
  std::int64_t now_ns_ = 0;
  std::vector<json> texts_;
  std::vector<std::string> data_;
  std::map<std::string, json> channels_;
};

TEST(FoxgloveProtocol, IsTheFirstKnownOneThatAClientOffers) {
  EXPECT_EQ(FoxgloveProtocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(FoxgloveProtocol("other, foxglove.sdk.v1,foxglove.websocket.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(FoxgloveProtocol("foxglove.sdk.v2"), "");
  EXPECT_EQ(FoxgloveProtocol(""), "");
  EXPECT_EQ(FoxgloveProtocol(",,"), "");
}

TEST_F(FoxgloveFeedTest, ChannelsAreAnnouncedWithTheirSchemas) {
  Tick(TickOf(true));
  Drain();
  ASSERT_EQ(texts_[0]["op"], "serverInfo");
  EXPECT_EQ(texts_[0]["sessionId"], "one start");
  const json& transforms = channels_.at("/foxglove/footing-sim/transforms");
  EXPECT_EQ(transforms["schemaName"], "foxglove.FrameTransforms");
  EXPECT_EQ(transforms["encoding"], "protobuf");
  EXPECT_GT(transforms["schema"].get<std::string>().size(), 100u);
  EXPECT_TRUE(channels_.contains("/foxglove/footing-sim/track"));
  EXPECT_TRUE(data_.empty()) << "nothing is sent that nobody has subscribed to";
}

TEST_F(FoxgloveFeedTest, WhoSubscribesLateGetsWhatWasSentOnce) {
  Tick(TickOf(true));
  Drain();
  for (int i = 0; i < 5; ++i) Tick(TickOf(false));
  Subscribe(77, "/foxglove/footing-sim/track");
  Drain();
  ASSERT_EQ(data_.size(), 1u);
  EXPECT_EQ(data_[0].substr(0, 5), std::string("\x01\x4d\0\0\0", 5));
  std::uint64_t time_ns = 0;
  std::memcpy(&time_ns, data_[0].data() + 5, sizeof(time_ns));
  EXPECT_EQ(time_ns, static_cast<std::uint64_t>(kTickNs));
  foxglove::SceneUpdate track;
  ASSERT_TRUE(track.ParseFromString(data_[0].substr(13)));
  EXPECT_EQ(track.entities(0).cubes(0).size().x(), 2);
}

TEST_F(FoxgloveFeedTest, ASlowViewerGetsTheNewestPoseAndEveryEvent) {
  Tick(TickOf(true));
  Tick(EventOf("first"));
  Drain();
  Subscribe(1, "/foxglove/footing-sim/transforms");
  Subscribe(2, "/foxglove/footing-sim/log");
  Drain();
  for (int i = 0; i < 10; ++i) {
    Tick(TickOf(false));
    Tick(EventOf("event " + std::to_string(i)));
  }
  Drain();
  ASSERT_EQ(data_.size(), 11u);  // One pose, ten events.
  for (std::size_t i = 0; i < 1000; ++i) Tick(EventOf("more"));
  Drain();
  EXPECT_EQ(data_.size(), FoxgloveFeed::kMostLogs);
}

TEST_F(FoxgloveFeedTest, AfterUnsubscribingNothingComes) {
  Tick(TickOf(true));
  Drain();
  Subscribe(9, "/foxglove/footing-sim/transforms");
  ASSERT_TRUE(feed_.Take(R"({"op": "unsubscribe", "subscriptionIds": [9]})").ok());
  Tick(TickOf(false));
  Drain();
  EXPECT_TRUE(data_.empty());
}

TEST_F(FoxgloveFeedTest, SubscriptionsAreBounded) {
  Tick(TickOf(true));
  Drain();
  for (std::uint32_t id = 0; id <= FoxgloveFeed::kMostSubscriptions; ++id) {
    Subscribe(id, "/foxglove/footing-sim/transforms");
  }
  Drain();
  EXPECT_EQ(data_.size(), FoxgloveFeed::kMostSubscriptions);
  EXPECT_THAT(texts_.at(0)["message"].get<std::string>(), HasSubstr("subscriptions"));
}

TEST_F(FoxgloveFeedTest, WhatItDoesNotKnowIsAnsweredAndWhatIsNoMessageEndsIt) {
  EXPECT_TRUE(feed_.Take(R"({"op": "setParameters\u0000", "parameters": []})").ok());
  EXPECT_TRUE(
      feed_.Take(R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 5}]})").ok());
  Drain();
  ASSERT_EQ(texts_.size(), 3u);
  EXPECT_EQ(texts_[1]["op"], "status");
  EXPECT_THAT(texts_[2]["message"].get<std::string>(), HasSubstr("channel 5"));
  for (const char* text : {"", "{", "[]", "{}", R"({"op": 3})",
                           R"({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 1}]})",
                           R"({"op": "subscribe", "subscriptions": [4]})"}) {
    EXPECT_FALSE(feed_.Take(text).ok()) << text;
  }
}

}  // namespace
}  // namespace footing::web
