#include <unistd.h>

#include "tests/common/net/server_fixture.h"

namespace footing::transport {
namespace {

class ServerHandshakeTest : public ServerFixture {
 protected:
  /// The Refused that the server answers to this Hello.
  v1::Refused RefusalOf(const v1::Envelope& hello, std::size_t listener = 0) {
    const auto client = Connect(listener);
    client->Read();
    client->Send(hello);
    EXPECT_TRUE(RunUntil([&] { return client->closed.has_value(); }));
    const v1::Envelope* refused = client->Find(v1::Envelope::kRefused);
    return refused == nullptr ? v1::Refused() : refused->refused();
  }
};

TEST_F(ServerHandshakeTest, WelcomeSaysWhoServesWhatUnderWhichLimits) {
  StartServer();
  for (const std::size_t listener : {0u, 1u}) {
    const auto client = Connect(listener);
    client->Read();
    client->Send(Hello());
    ASSERT_TRUE(WaitFor(*client, v1::Envelope::kWelcome));
    const v1::Welcome& welcome = client->Find(v1::Envelope::kWelcome)->welcome();
    EXPECT_EQ(welcome.server_id(), "test-server");
    EXPECT_EQ(welcome.version(), "1.2.3");
    EXPECT_EQ(welcome.epoch(), server_->epoch());
    EXPECT_EQ(welcome.protocol_major(), 1u);
    EXPECT_EQ(welcome.granted_role(), v1::ROLE_VIEW);
    EXPECT_EQ(welcome.channels_size(), 3);
    EXPECT_EQ(welcome.host_ns(), now_ns_);
    EXPECT_EQ(welcome.limits().max_message_in_bytes(), 64u << 10);
    EXPECT_EQ(welcome.limits().max_message_out_bytes(), 1u << 20);
    EXPECT_EQ(welcome.limits().ring_s(), 30);
  }
  EXPECT_EQ(server_->statistics().accepted, 2u);
}

TEST_F(ServerHandshakeTest, AnotherMajorVersionIsRefusedWithBothVersions) {
  StartServer();
  v1::Envelope hello = Hello();
  hello.mutable_hello()->set_protocol_major(2);
  hello.mutable_hello()->set_protocol_minor(7);
  const v1::Refused refused = RefusalOf(hello);
  EXPECT_EQ(refused.reason(), v1::Refused::REASON_PROTOCOL_VERSION);
  EXPECT_EQ(refused.message(),
            "test-server speaks protocol 1.0, this client 2.7; update the server");
}

TEST_F(ServerHandshakeTest, WhatAHelloLacksIsNamed) {
  StartServer();
  v1::Envelope hello = Hello();
  hello.mutable_hello()->clear_protocol_major();
  EXPECT_EQ(RefusalOf(hello).message(), "Hello has no protocol_major: send 1 for protocol 1.0");
  const v1::Refused refused = RefusalOf(Hello(static_cast<v1::Role>(9)), 1);
  EXPECT_EQ(refused.reason(), v1::Refused::REASON_ROLE);
  EXPECT_EQ(refused.message(),
            "Hello has the unknown role 9; there are 1 (view), 2 (log), 3 (control) and 4 (admin)");
}

TEST_F(ServerHandshakeTest, AnotherMinorVersionIsWelcome) {
  StartServer();
  const auto client = Connect();
  client->Read();
  v1::Envelope hello = Hello();
  hello.mutable_hello()->set_protocol_minor(42);
  hello.mutable_hello()->add_wanted_capabilities("telepathy");
  client->Send(hello);
  EXPECT_TRUE(WaitFor(*client, v1::Envelope::kWelcome));
}

TEST_F(ServerHandshakeTest, ControlOverTcpIsRefusedWithTheWayToGetIt) {
  StartServer();
  const v1::Refused refused = RefusalOf(Hello(v1::ROLE_CONTROL), 1);
  EXPECT_EQ(refused.reason(), v1::Refused::REASON_ROLE);
  EXPECT_NE(refused.message().find("Unix socket"), std::string::npos) << refused.message();
  EXPECT_NE(refused.message().find("token_file"), std::string::npos) << refused.message();
}

TEST_F(ServerHandshakeTest, TheSameUserIsAdminOnTheUnixSocket) {
  StartServer();
  const auto client = Connect();
  client->Read();
  client->Send(Hello(v1::ROLE_ADMIN));
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kWelcome));
  EXPECT_EQ(client->Find(v1::Envelope::kWelcome)->welcome().granted_role(), v1::ROLE_ADMIN);
}

TEST_F(ServerHandshakeTest, ASilentConnectionIsEndedAtTheHelloDeadline) {
  ServerOptions options = Options();
  options.hello_deadline_s = 0.02;
  StartServer(options);
  for (const std::size_t listener : {0u, 1u}) {
    const auto client = Connect(listener);
    client->Read();
    ASSERT_TRUE(RunUntil([&] { return client->closed.has_value(); }));
    const v1::Envelope* refused = client->Find(v1::Envelope::kRefused);
    ASSERT_NE(refused, nullptr);
    EXPECT_EQ(refused->refused().reason(), v1::Refused::REASON_HELLO_TIMEOUT);
  }
}

TEST_F(ServerHandshakeTest, OneSessionTooManyIsRefusedAndTheOthersStay) {
  ServerOptions options = Options();
  options.sessions.max_sessions = 2;
  StartServer(options);
  const auto first = Subscribed(Subscribe(), 1);
  const auto second = Subscribed(Subscribe(), 1);
  const v1::Refused refused = RefusalOf(Hello(), 1);
  EXPECT_EQ(refused.reason(), v1::Refused::REASON_TOO_MANY_SESSIONS);
  PublishMotion();
  EXPECT_TRUE(RunUntil([&] { return first->Sequences().size() == 1; }));
  EXPECT_TRUE(RunUntil([&] { return second->Sequences().size() == 1; }));
  EXPECT_EQ(server_->statistics().refused, 1u);
}

TEST_F(ServerHandshakeTest, RefusalsAreLoggedOnceIn10SForEachReason) {
  StartServer();
  for (int i = 0; i < 3; ++i) RefusalOf(Subscribe(), 1);  // In place of Hello.
  RefusalOf(Hello(v1::ROLE_CONTROL), 1);
  ASSERT_EQ(overloads_.size(), 2u);
  EXPECT_EQ(overloads_[0],
            "refused a client from 127.0.0.1: the first message must be Hello (1 since start)");
  EXPECT_NE(overloads_[1].find("the role control is not given"), std::string::npos);
  now_ns_ += 10'000'000'001;
  RefusalOf(Subscribe());
  ASSERT_EQ(overloads_.size(), 3u);
  EXPECT_EQ(overloads_[2], "refused a client of user " + std::to_string(geteuid()) +
                               ": the first message must be Hello (5 since start)");
}

TEST_F(ServerHandshakeTest, ASessionThatSendsRubbishIsEndedAndLogged) {
  StartServer();
  const auto client = Subscribed(Subscribe());
  client->Send(Hello());
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kGoodbye));
  ASSERT_EQ(overloads_.size(), 1u);
  EXPECT_EQ(overloads_[0], "session 1 (test) is ended: Hello came twice");
}

TEST_F(ServerHandshakeTest, ACrowdOverTcpDoesNotLockTheAdministratorOut) {
  ServerOptions options = Options();
  options.sessions.max_sessions = 3;
  options.sessions.admin_places = 4;
  StartServer(options);
  std::vector<std::unique_ptr<TestClient>> crowd;
  for (int i = 0; i < 8; ++i) {  // Idle: connected, and nothing more.
    crowd.push_back(Connect(1));
    crowd.back()->Read();
  }
  ASSERT_TRUE(RunUntil([&] { return server_->statistics().accepted == 8; }));
  std::vector<std::unique_ptr<TestClient>> administrators;
  const int places = geteuid() == 0 ? 4 : 2;  // Half of them are root's.
  for (int i = 0; i < places; ++i) {
    administrators.push_back(Connect());
    administrators.back()->Read();
    administrators.back()->Send(Hello(v1::ROLE_ADMIN));
    ASSERT_TRUE(WaitFor(*administrators.back(), v1::Envelope::kWelcome)) << i;
  }
  EXPECT_EQ(RefusalOf(Hello(v1::ROLE_ADMIN)).reason(), v1::Refused::REASON_TOO_MANY_SESSIONS);
}

TEST_F(ServerHandshakeTest, OneRoleTooManyIsRefusedAndItsPlaceComesBack) {
  ServerOptions options = Options();
  options.sessions.max_log_sessions = 1;
  StartServer(options);
  auto logging = Connect(1);
  logging->Read();
  logging->Send(Hello(v1::ROLE_LOG));
  ASSERT_TRUE(WaitFor(*logging, v1::Envelope::kWelcome));
  const v1::Refused refused = RefusalOf(Hello(v1::ROLE_LOG), 1);
  EXPECT_EQ(refused.reason(), v1::Refused::REASON_TOO_MANY_SESSIONS);
  EXPECT_NE(refused.message().find("role log"), std::string::npos) << refused.message();
  Subscribed(Subscribe(), 1);  // Another role is free.
  logging.reset();
  ASSERT_TRUE(RunUntil([&] { return server_->statistics().sessions == 0; }));
  const auto next = Connect(1);
  next->Read();
  next->Send(Hello(v1::ROLE_LOG));
  EXPECT_TRUE(WaitFor(*next, v1::Envelope::kWelcome));
}

TEST(SessionLimits, OneUserDoesNotTakeEverybodysPlaces) {
  SessionLimits limits;
  limits.max_sessions = 10;
  limits.max_sessions_per_user = 6;
  limits.admin_places = 4;
  constexpr uid_t kOwn = 1000;
  const Peer tcp, other{true, 2000, {}}, own{true, kOwn, {}}, root{true, 0, {}};
  EXPECT_EQ(WhyNoPlace(limits, tcp, kOwn, {5, 5}), "");
  EXPECT_NE(WhyNoPlace(limits, tcp, kOwn, {6, 6}).find("over TCP"), std::string::npos);
  EXPECT_EQ(WhyNoPlace(limits, other, kOwn, {9, 3}), "");
  EXPECT_NE(WhyNoPlace(limits, other, kOwn, {6, 6}).find("of this user"), std::string::npos);
  EXPECT_NE(WhyNoPlace(limits, other, kOwn, {10, 0}), "");
  EXPECT_EQ(WhyNoPlace(limits, own, kOwn, {11, 11}), "");
  EXPECT_NE(WhyNoPlace(limits, own, kOwn, {12, 12}), "");
  EXPECT_EQ(WhyNoPlace(limits, root, kOwn, {13, 0}), "");
  EXPECT_NE(WhyNoPlace(limits, root, kOwn, {14, 0}), "");
}

TEST_F(ServerHandshakeTest, StoppingSaysGoodbyeWithTheReason) {
  StartServer();
  const auto client = Subscribed(Subscribe());
  server_->Stop("restarting after an update");
  ASSERT_TRUE(RunUntil([&] { return client->closed.has_value(); }));
  ASSERT_NE(client->Find(v1::Envelope::kGoodbye), nullptr);
  EXPECT_EQ(client->messages.back().goodbye().reason(), "restarting after an update");
  EXPECT_TRUE(RunUntil([&] { return ended_.size() == 1; }));
  EXPECT_EQ(ended_[0].client_name, "test");
}

}  // namespace
}  // namespace footing::transport
