#include <limits>

#include <unistd.h>

#include "common/base/units.h"
#include "tests/common/net/server_fixture.h"

namespace footing::transport {
namespace {

class ServerCommandTest : public ServerFixture {
 protected:
  std::unique_ptr<TestClient> WithRole(v1::Role role, std::size_t listener = 0) {
    auto client = Connect(listener);
    client->Read();
    client->Send(Hello(role));
    EXPECT_TRUE(WaitFor(*client, v1::Envelope::kWelcome));
    return client;
  }
  v1::CommandResult Ask(TestClient& client, std::uint64_t id, std::uint32_t deadline_ms = 0) {
    v1::Envelope message;
    message.mutable_command()->set_id(id);
    message.mutable_command()->set_deadline_ms(deadline_ms);
    message.mutable_command()->mutable_set_rumble()->set_on(true);
    return Call(client, message);
  }
  v1::CommandResult Call(TestClient& client, const v1::Envelope& message) {
    const std::size_t before = client.Count(v1::Envelope::kCommandResult);
    client.Send(message);
    EXPECT_TRUE(RunUntil([&] { return client.Count(v1::Envelope::kCommandResult) == before + 1; }));
    return client.messages.back().command_result();
  }
  v1::CommandResult List(TestClient& client, std::uint64_t after = 0) {
    v1::Envelope message;
    message.mutable_command()->set_id(++last_id_);
    message.mutable_command()->mutable_list_sessions()->set_after(after);
    return Call(client, message);
  }
  v1::CommandResult EndThem(TestClient& client, const std::vector<std::uint64_t>& numbers,
                            const std::string& reason = "") {
    v1::Envelope message;
    message.mutable_command()->set_id(++last_id_);
    v1::EndSessions& end = *message.mutable_command()->mutable_end_sessions();
    end.mutable_sessions()->Add(numbers.begin(), numbers.end());
    end.set_reason(reason);
    return Call(client, message);
  }

  std::uint64_t last_id_ = 100;
};

TEST_F(ServerCommandTest, ControlAndAdminAreCarriedOutViewAndLogAreNot) {
  StartServer();
  for (const v1::Role role : {v1::ROLE_CONTROL, v1::ROLE_ADMIN}) {
    const v1::CommandResult result = Ask(*WithRole(role), 7);
    EXPECT_TRUE(result.ok());
    EXPECT_EQ(result.id(), 7u);
  }
  EXPECT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[0].first.role, v1::ROLE_CONTROL);
  for (const v1::Role role : {v1::ROLE_VIEW, v1::ROLE_LOG}) {
    const v1::CommandResult result = Ask(*WithRole(role, 1), 7);
    EXPECT_FALSE(result.ok());
    EXPECT_NE(result.message().find("need the role control"), std::string::npos);
    EXPECT_NE(result.message().find("request control in Hello"), std::string::npos);
  }
  EXPECT_EQ(commands_.size(), 2u);
}

TEST_F(ServerCommandTest, DevicesNeedTheRoleControlAServerThatTakesThemAndShortMessages) {
  takes_devices_ = true;
  StartServer();
  const auto why_ended = [&](v1::Role role, std::size_t listener, std::size_t bytes) {
    const auto client = WithRole(role, listener);
    v1::Envelope message;
    message.mutable_device()->mutable_input_report()->set_report(std::string(bytes, 'r'));
    client->Send(message);
    EXPECT_TRUE(WaitFor(*client, v1::Envelope::kGoodbye));
    return client->Find(v1::Envelope::kGoodbye)->goodbye().reason();
  };
  EXPECT_NE(why_ended(v1::ROLE_LOG, 1, 10).find("needs the role control"), std::string::npos);
  EXPECT_NE(why_ended(v1::ROLE_CONTROL, 0, 2048).find("at most 2048 bytes"), std::string::npos);
  EXPECT_TRUE(devices_.empty());
  takes_devices_ = false;
  StartServer();
  EXPECT_NE(why_ended(v1::ROLE_CONTROL, 0, 10).find("takes no devices here"), std::string::npos);
}

TEST_F(ServerCommandTest, DevicesMaySendFiftyTimesAsManyMessages) {
  takes_devices_ = true;
  StartServer();
  const auto client = WithRole(v1::ROLE_CONTROL);
  v1::Envelope message;
  message.mutable_device()->mutable_input_report()->set_report("r");
  const auto send = [&](std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) client->Send(message);
  };
  send(1000);  // 20 messages of the 100 of a second.
  ASSERT_TRUE(RunUntil([&] { return devices_.size() == 1000; }));
  EXPECT_EQ(server_->statistics().slowed, 0u);
  message.mutable_device()->mutable_attach()->set_slot(1);  // 2 messages each.
  send(100);
  EXPECT_TRUE(RunUntil([&] { return server_->statistics().slowed > 0; }));
}

TEST_F(ServerCommandTest, SessionsAreListedWithWhereTheyComeFrom) {
  StartServer();
  const auto control = WithRole(v1::ROLE_CONTROL);
  const auto viewer = WithRole(v1::ROLE_VIEW, 1);
  const auto listed = List(*control);
  ASSERT_TRUE(listed.ok()) << listed.message();
  ASSERT_EQ(listed.sessions_size(), 2);
  EXPECT_FALSE(listed.more_sessions());
  const v1::ConnectedSession &own = listed.sessions(0), &other = listed.sessions(1);
  EXPECT_TRUE(own.own());
  EXPECT_EQ(own.stats().role(), "control");
  EXPECT_EQ(own.user(), geteuid());
  EXPECT_EQ(own.granted_by(), "user");
  EXPECT_FALSE(other.own() || other.has_user());
  EXPECT_EQ(other.stats().client_name(), "test");
  EXPECT_EQ(other.host(), "127.0.0.1");
  EXPECT_EQ(other.granted_by(), "address");
  EXPECT_EQ(List(*control, own.stats().session()).sessions_size(), 1) << "those behind it";
  EXPECT_NE(List(*viewer).message().find("need the role control"), std::string::npos);
  EXPECT_TRUE(commands_.empty()) << "the program is not asked";
}

TEST_F(ServerCommandTest, AnAdministratorEndsSessionsWithAReason) {
  StartServer();
  const auto admin = WithRole(v1::ROLE_ADMIN);
  const auto control = WithRole(v1::ROLE_CONTROL);
  const auto viewer = WithRole(v1::ROLE_VIEW, 1);
  const auto listed = List(*admin);
  ASSERT_EQ(listed.sessions_size(), 3);
  const std::uint64_t own = listed.sessions(0).stats().session(),
                      others = listed.sessions(2).stats().session();
  EXPECT_NE(EndThem(*control, {others}).message().find("needs the role admin"), std::string::npos);
  EXPECT_NE(EndThem(*admin, {own}).message().find("is the one that asks"), std::string::npos);
  EXPECT_NE(EndThem(*admin, {}).message().find("1 to 500 sessions"), std::string::npos);
  EXPECT_EQ(viewer->Find(v1::Envelope::kGoodbye), nullptr);
  const auto ended = EndThem(*admin, {others, 99}, "the lab closes");
  ASSERT_TRUE(ended.ok()) << ended.message();
  ASSERT_EQ(ended.sessions_size(), 1) << "99 has no session";
  EXPECT_EQ(ended.sessions(0).stats().session(), others);
  ASSERT_TRUE(WaitFor(*viewer, v1::Envelope::kGoodbye));
  EXPECT_EQ(viewer->Find(v1::Envelope::kGoodbye)->goodbye().reason(),
            "ended by an administrator: the lab closes");
  EXPECT_EQ(List(*admin).sessions_size(), 2);
}

TEST_F(ServerCommandTest, ARepeatedIdGetsItsFirstAnswerAndIsCarriedOutOnce) {
  StartServer();
  const auto client = WithRole(v1::ROLE_CONTROL);
  EXPECT_EQ(Ask(*client, 1).message(), "done 1");
  EXPECT_EQ(Ask(*client, 2).message(), "done 2");
  EXPECT_EQ(Ask(*client, 1).message(), "done 1");
  EXPECT_EQ(commands_.size(), 2u);
}

TEST_F(ServerCommandTest, ACommandPastItsDeadlineIsNotCarriedOut) {
  StartServer();
  const auto client = WithRole(v1::ROLE_CONTROL);
  // Two commands arrive in one read; carrying out the first takes 50 ms.
  on_command_ = [this] { now_ns_ += 50'000'000; };
  for (const std::uint64_t id : {1u, 2u}) {
    v1::Envelope message;
    message.mutable_command()->set_id(id);
    message.mutable_command()->set_deadline_ms(40);
    client->Send(message);
  }
  ASSERT_TRUE(RunUntil([&] { return client->Count(v1::Envelope::kCommandResult) == 2; }));
  EXPECT_EQ(commands_.size(), 1u);
  EXPECT_NE(client->messages.back().command_result().message().find("40 ms"), std::string::npos);
}

TEST_F(ServerCommandTest, ATextWithControlCharactersIsRefusedBeforeItIsCarriedOut) {
  StartServer();
  const auto client = WithRole(v1::ROLE_CONTROL);
  v1::Envelope message;
  message.mutable_command()->set_id(1);
  message.mutable_command()->mutable_assign_role()->set_rig("a\x1b[2J");
  client->Send(message);
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kCommandResult));
  const v1::CommandResult& result = client->messages.back().command_result();
  EXPECT_FALSE(result.ok());
  EXPECT_NE(result.message().find("assign_role.rig has control characters"), std::string::npos);
  EXPECT_TRUE(commands_.empty());
}

/// A server with the channels of footing-sim that concern markers.
ServerOptions WithMarkers() {
  ServerOptions options;
  options.server_id = "test-server";
  options.channels = {{"events", v1::Tick::kEventsFieldNumber, false}};
  options.takes_markers = true;
  return options;
}

v1::Envelope MarkerOf(std::uint64_t id, const std::string& text, std::int64_t host_ns = 0) {
  v1::Envelope message;
  message.mutable_command()->set_id(id);
  message.mutable_command()->mutable_marker()->set_text(text);
  message.mutable_command()->mutable_marker()->set_host_ns(host_ns);
  return message;
}

TEST_F(ServerCommandTest, MarkersOfTheRolesLogAndAboveAreEventsOfTheNextTick) {
  StartServer(WithMarkers());
  const auto viewer = Subscribed(Subscribe());
  now_ns_ = 500 * kNanosecondsPerSecond;
  v1::Envelope valued = MarkerOf(1, "stimulus \u00e9", 499 * kNanosecondsPerSecond);
  valued.mutable_command()->mutable_marker()->set_value(2.5);
  EXPECT_TRUE(Call(*WithRole(v1::ROLE_LOG, 1), valued).ok());
  EXPECT_TRUE(Call(*WithRole(v1::ROLE_CONTROL), MarkerOf(1, "second")).ok());
  const v1::CommandResult refused = Call(*WithRole(v1::ROLE_VIEW), MarkerOf(1, "third"));
  EXPECT_FALSE(refused.ok());
  EXPECT_NE(refused.message().find("a marker needs the role log"), std::string::npos);
  EXPECT_TRUE(commands_.empty());  // The program behind the server has nothing to do with it.

  v1::Events own;
  own.add_events()->set_text("own");
  server_->Publish(now_ns_, {{v1::Tick::kEventsFieldNumber, own.SerializeAsString()}});
  server_->Publish(now_ns_, {});
  ASSERT_TRUE(RunUntil([&] { return viewer->Sequences().size() == 2; }));
  const v1::Events& events = viewer->messages[viewer->messages.size() - 2].tick().events();
  ASSERT_EQ(events.events_size(), 3);
  EXPECT_EQ(events.events(0).text(), "own");
  EXPECT_EQ(events.events(1).kind(), v1::Event::KIND_MARKER);
  EXPECT_EQ(events.events(1).text(), "stimulus \u00e9");
  EXPECT_EQ(events.events(1).host_ns(), 499 * kNanosecondsPerSecond);
  EXPECT_EQ(events.events(1).marker().received_ns(), 500 * kNanosecondsPerSecond);
  EXPECT_EQ(events.events(1).marker().value(), 2.5);
  EXPECT_EQ(events.events(1).marker().client(), "test");
  EXPECT_EQ(events.events(2).host_ns(), 500 * kNanosecondsPerSecond);  // Its arrival.
  EXPECT_FALSE(events.events(2).marker().has_value());
  EXPECT_FALSE(viewer->messages.back().tick().has_events());
}

TEST_F(ServerCommandTest, AMarkerThatIsTooLongOrOfAnotherClockIsRefused) {
  StartServer(WithMarkers());
  const auto client = WithRole(v1::ROLE_CONTROL);
  now_ns_ = 500 * kNanosecondsPerSecond;
  std::uint64_t id = 0;
  EXPECT_TRUE(Call(*client, MarkerOf(++id, std::string(MarkerQueue::kMostBytes, 'a'))).ok());
  const auto why = [&](const std::string& text, std::int64_t host_ns) {
    const v1::CommandResult result = Call(*client, MarkerOf(++id, text, host_ns));
    EXPECT_FALSE(result.ok());
    return result.message();
  };
  EXPECT_NE(why(std::string(MarkerQueue::kMostBytes + 1, 'a'), 0).find("1025 bytes"),
            std::string::npos);
  EXPECT_NE(why("", 0).find("0 bytes"), std::string::npos);
  EXPECT_NE(why("two\nlines", 0).find("control characters"), std::string::npos);
  for (const std::int64_t host_ns :
       {std::int64_t{439} * kNanosecondsPerSecond, std::int64_t{502} * kNanosecondsPerSecond,
        std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_NE(why("late", host_ns).find("CLOCK_MONOTONIC"), std::string::npos) << host_ns;
  }
  StartServer();
  EXPECT_NE(Call(*WithRole(v1::ROLE_CONTROL), MarkerOf(1, "a")).message().find("takes no markers"),
            std::string::npos);
}

TEST(MarkerQueue, MoreThanATickTakesAreRefusedUntilItIsPublished) {
  MarkerQueue queue;
  v1::Marker marker;
  marker.set_text("a");
  for (int i = 0; i < MarkerQueue::kMostWaiting; ++i) {
    ASSERT_TRUE(queue.Add(marker, "test", 1).ok());
  }
  const auto more = queue.Add(marker, "test", 1);
  ASSERT_FALSE(more.ok());
  EXPECT_NE(more.error().message.find("send it again"), std::string::npos);
  std::vector<ChannelBytes> channels;
  queue.MoveTo(channels);
  EXPECT_TRUE(queue.empty());
  ASSERT_EQ(channels.size(), 1u);
  EXPECT_TRUE(queue.Add(marker, "test", 1).ok());
}

TEST_F(ServerCommandTest, PingIsAnsweredWithFourStamps) {
  StartServer();
  const auto client = WithRole(v1::ROLE_VIEW, 1);
  v1::Envelope message;
  message.mutable_ping()->set_id(5);
  message.mutable_ping()->set_t0_ns(77);
  client->Send(message);
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kPong));
  const v1::Pong& pong = client->Find(v1::Envelope::kPong)->pong();
  EXPECT_EQ(pong.id(), 5u);
  EXPECT_EQ(pong.t0_ns(), 77);
  EXPECT_EQ(pong.t1_ns(), now_ns_);
  EXPECT_EQ(pong.t2_ns(), now_ns_);
}

TEST_F(ServerCommandTest, AClientThatIsNotHeardOfIsPingedThenEnded) {
  ServerOptions options = Options();
  options.ping_interval_s = 0.01;
  StartServer(options);
  const auto client = WithRole(v1::ROLE_VIEW);
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kPing));  // Which it does not answer.
  now_ns_ += 10'000'000'001;
  ASSERT_TRUE(RunUntil([&] { return client->closed.has_value(); }));
  EXPECT_EQ(client->Count(v1::Envelope::kPing), 1u);
  ASSERT_TRUE(client->messages.back().has_goodbye());
  EXPECT_NE(client->messages.back().goodbye().reason().find("10 s"), std::string::npos);
}

TEST_F(ServerCommandTest, AClientThatAsksAndNeverReadsIsEnded) {
  ServerOptions options = Options();
  options.sessions.session_messages_per_s = 1e6;
  options.sessions.session_kilobytes_per_s = 1e6;
  StartServer(options);
  const auto client = Connect();
  client->Send(Hello());
  v1::Envelope ping;
  ping.mutable_ping()->set_id(1);
  // Each Ping is answered; nobody reads the answers, so sooner or later they do not fit any more.
  const std::string payload = ping.SerializeAsString();
  ASSERT_TRUE(RunUntil([&] {
    for (int i = 0; i < 100; ++i) client->connection->Send(payload);
    return ended_.size() == 1;
  }));
}

TEST_F(ServerCommandTest, ACommandLeftOpenIsCarriedOutOnceAndAnsweredWhenItIsDone) {
  StartServer();
  answer_later_ = true;
  const auto client = WithRole(v1::ROLE_CONTROL);
  v1::Envelope message;
  message.mutable_command()->set_id(7);
  message.mutable_command()->mutable_set_rumble()->set_on(true);
  client->Send(message);
  client->Send(message);  // Asked again while it is under way.
  v1::Envelope ping;
  ping.mutable_ping()->set_id(1);
  client->Send(ping);
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kPong));
  EXPECT_EQ(commands_.size(), 1u);
  EXPECT_EQ(client->Count(v1::Envelope::kCommandResult), 0u);
  v1::CommandResult result;
  result.set_id(7);
  result.set_ok(true);
  result.set_message("on the disk");
  server_->Answer(commands_[0].first.session, result);
  server_->Answer(commands_[0].first.session, result);  // Once is enough.
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kCommandResult));
  client->Send(message);  // And again when it is done: the same answer.
  ASSERT_TRUE(RunUntil([&] { return client->Count(v1::Envelope::kCommandResult) == 2; }));
  EXPECT_EQ(client->messages.back().command_result().message(), "on the disk");
  EXPECT_EQ(commands_.size(), 1u);
  server_->Answer(99, result);  // A session that is gone.
}

}  // namespace
}  // namespace footing::transport
