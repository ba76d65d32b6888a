#include <optional>

#include "tests/common/net/client_fixture.h"

namespace footing::transport {
namespace {

TEST_F(ClientTest, ACommandComesBackWithItsAnswer) {
  StartServer();
  ClientOptions options = ClientOn(UnixAddress());
  options.role = v1::ROLE_CONTROL;
  StartClient(options);
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  std::optional<v1::CommandResult> answer;
  v1::Command command;
  command.mutable_set_leds()->set_leds(3);
  client_->Send(command, [&](const v1::CommandResult& result) { answer = result; });
  ASSERT_TRUE(RunUntil([&] { return answer.has_value(); }));
  EXPECT_TRUE(answer->ok());
  EXPECT_EQ(commands_[0].second.set_leds().leds(), 3u);
}

TEST_F(ClientTest, ACommandThatLosesItsConnectionFailsWhenTheLinkIsNoLongerLive) {
  StartServer();
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  std::optional<LinkState> state;
  client_->Send({}, [&](const v1::CommandResult& result) {
    EXPECT_FALSE(result.ok());
    state = client_->state();
  });
  server_->Stop("restart");
  server_.reset();
  ASSERT_TRUE(RunUntil([&] { return state.has_value(); }));
  EXPECT_EQ(*state, LinkState::kConnecting);
}

TEST_F(ClientTest, ACommandWithoutAConnectionFailsAtOnceWithTheReason) {
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntil([&] { return !states_.empty(); }));
  std::optional<v1::CommandResult> answer;
  client_->Send({}, [&](const v1::CommandResult& result) { answer = result; });
  ASSERT_TRUE(answer.has_value());
  EXPECT_FALSE(answer->ok());
  EXPECT_NE(answer->message().find("no such file"), std::string::npos);
}

TEST_F(ClientTest, ACommandAfterItsStopFailsAtOnce) {
  StartServer();
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  client_->Stop();
  std::optional<v1::CommandResult> answer;
  client_->Send({}, [&](const v1::CommandResult& result) { answer = result; });
  ASSERT_TRUE(answer.has_value());
  EXPECT_FALSE(answer->ok());
  EXPECT_EQ(answer->message(), "not connected: the client was stopped");
}

}  // namespace
}  // namespace footing::transport
