#include <string>
#include <utility>

#include "tests/common/net/server_fixture.h"

namespace footing::transport {
namespace {

class ServerRefillTest : public ServerFixture {};

TEST_F(ServerRefillTest, ARefillOfNothingIsAnsweredWithANotice) {
  StartServer();
  const auto client = Subscribed(Subscribe());
  for (int i = 0; i < 5; ++i) PublishMotion();
  for (const auto& [from, to] : {std::pair<int, int>{4, 2}, {6, 9}}) {
    v1::Envelope refill;
    refill.mutable_refill()->set_from_sequence(static_cast<std::uint64_t>(from));
    refill.mutable_refill()->set_to_sequence(static_cast<std::uint64_t>(to));
    client->Send(refill);
  }
  ASSERT_TRUE(RunUntil([&] { return client->Count(v1::Envelope::kNotice) == 2; }));
  const v1::Notice& first = client->Find(v1::Envelope::kNotice)->notice();
  EXPECT_EQ(first.kind(), v1::Notice::KIND_NOTHING_TO_REFILL);
  EXPECT_EQ(first.text(), "Refill: from_sequence 4 is above to_sequence 2");
  const v1::Notice& second = client->messages.back().notice();
  EXPECT_EQ(second.text(), "Refill: tick 6 is not published yet; the newest is 5");
  EXPECT_EQ(second.count(), 6u);
  EXPECT_FALSE(client->closed) << "the session goes on";
}

TEST_F(ServerRefillTest, MoreThanSixteenRefillsAtATimeEndTheSession) {
  StartServer();
  for (int i = 0; i < 2000; ++i) PublishMotion();
  const auto client = Subscribed(Subscribe());
  v1::Envelope refill;
  refill.mutable_refill()->set_from_sequence(1);
  refill.mutable_refill()->set_to_sequence(2000);
  for (int i = 0; i < 17; ++i) client->Send(refill);
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kGoodbye));
  EXPECT_NE(client->Find(v1::Envelope::kGoodbye)->goodbye().reason().find("16 Refills wait"),
            std::string::npos);
}

}  // namespace
}  // namespace footing::transport
