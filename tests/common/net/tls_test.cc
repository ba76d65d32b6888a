#include <fstream>

#include <sys/stat.h>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

#include "common/net/access.h"
#include "common/net/client.h"
#include "common/net/tls_context.h"
#include "tests/common/net/tls_fixture.h"

/// Who comes in, and what a client gives away before it knows to whom.
namespace footing::transport {
namespace {

class ServerAccess : public TlsFixture {
 protected:
  ~ServerAccess() override {
    unsetenv("FOOTING_TOKEN_FILE");
    unsetenv("FOOTING_INSECURE_LAN");
  }

  /// The user's own certificate, which a client shows.
  tls::Identity OwnCertificate() const {
    return tls::Identity::LoadOrMake(config_.Path("client.pem"), "viewer").value();
  }

  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(config_.Path(name)) << text;
    ASSERT_EQ(chmod(config_.Path(name).c_str(), 0600), 0);
  }

  std::optional<v1::Role> RoleOf(v1::Role role, const std::string& token) {
    ClientOptions options;
    options.address = TlsAddress(Port());
    options.role = role;
    options.token = token;
    std::optional<v1::Role> granted;
    bool refused = false;
    ClientHandlers handlers;
    handlers.on_welcome = [&](const v1::Welcome& welcome) { granted = welcome.granted_role(); };
    handlers.on_refused = [&](const v1::Refused&) { refused = true; };
    Client client(io_, options, handlers);
    client.Start();
    EXPECT_TRUE(RunUntil([&] { return granted || refused; }));
    return granted;
  }
};

TEST_F(ServerAccess, ACertificateThatCannotBeRememberedIsRefusedBeforeHello) {
  setenv("FOOTING_KNOWN_SERVERS", "/proc/none/known_servers", 1);
  StartTlsServer();
  StartClient(TlsAddress(Port()));
  ASSERT_TRUE(RunUntilState(LinkState::kRefused)) << why_;
  EXPECT_TRUE(WhyHas("cannot be remembered") && WhyHas("/proc/none")) << why_;
  EXPECT_TRUE(WhyHas(server_->fingerprint())) << why_;
  EXPECT_EQ(server_->statistics().denied, 0u) << "nothing was sent";
  EXPECT_TRUE(ticks_.empty());
}

TEST_F(ServerAccess, WhoseCertificateGivesTooLittleHearsWhereThatIsChanged) {
  options_.clients[OwnCertificate().fingerprint()] = v1::ROLE_VIEW;
  StartTlsServer();
  ClientOptions options;
  options.address = TlsAddress(Port());
  options.role = v1::ROLE_CONTROL;
  std::optional<v1::Refused> refused;
  ClientHandlers handlers;
  handlers.on_refused = [&](const v1::Refused& why) { refused = why; };
  Client client(io_, options, handlers);
  client.Start();
  ASSERT_TRUE(RunUntil([&] { return refused.has_value(); }));
  EXPECT_EQ(refused->reason(), v1::Refused::REASON_ROLE);
  EXPECT_NE(refused->message().find("the server's clients_file"), std::string::npos)
      << refused->message();
}

TEST_F(ServerAccess, FilesReadAgainHoldForSessionsThatCome) {
  AccessSettings settings;
  settings.token_file = config_.Path("token");
  settings.clients_file = config_.Path("clients");
  settings.identity_file = config_.Path("identity.pem");
  Write("token", "0123456789abcdef\n");
  Write("clients", "# nobody yet\n");
  ASSERT_TRUE(settings.Apply(options_).ok());
  StartTlsServer();
  EXPECT_EQ(RoleOf(v1::ROLE_CONTROL, "0123456789abcdef"), v1::ROLE_CONTROL);
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{});

  Write("token", "fedcba9876543210\n");
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{"token_file"});
  EXPECT_EQ(RoleOf(v1::ROLE_CONTROL, "0123456789abcdef"), std::nullopt);
  EXPECT_EQ(RoleOf(v1::ROLE_CONTROL, "fedcba9876543210"), v1::ROLE_CONTROL);

  Write("clients", OwnCertificate().fingerprint() + " log\n");
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{"clients_file"});
  EXPECT_EQ(server_->options().clients.at(OwnCertificate().fingerprint()), v1::ROLE_LOG);

  Write("clients", "Ada\n");
  EXPECT_FALSE(settings.Reapply(*server_).ok());
  EXPECT_EQ(server_->options().clients.size(), 1u) << "an error changes nothing";
}

TEST_F(ServerAccess, ACertificateEnteredLaterComesInWithoutARestart) {
  const tls::Identity own = OwnCertificate();
  StartTlsServer();
  EXPECT_EQ(RoleOf(v1::ROLE_LOG, ""), std::nullopt);
  AccessKeys keys;
  keys.clients[own.fingerprint()] = v1::ROLE_LOG;
  EXPECT_EQ(server_->SetAccess(keys), 0u);
  EXPECT_EQ(RoleOf(v1::ROLE_LOG, ""), v1::ROLE_LOG);
}

TEST_F(ServerAccess, FilesReadAgainEndWhatCameInByWhatIsGone) {
  AccessSettings settings;
  settings.token_file = config_.Path("token");
  settings.view_token_file = config_.Path("view");
  settings.clients_file = config_.Path("clients");
  settings.identity_file = config_.Path("identity.pem");
  Write("token", "0123456789abcdef\n");
  Write("view", "view-0123456789abcdef\n");
  Write("clients", "# nobody yet\n");
  ASSERT_TRUE(settings.Apply(options_).ok());
  StartTlsServer();
  const auto come = [&](std::size_t listener, const std::string& token) {
    auto client = Connect(listener);
    client->Read();
    v1::Envelope hello = Hello();
    hello.mutable_hello()->set_token(token);
    client->Send(hello);
    EXPECT_TRUE(WaitFor(*client, v1::Envelope::kWelcome));
    return client;
  };
  const auto local = come(0, ""), by_token = come(kTls, "0123456789abcdef"),
             by_view_token = come(kTls, "view-0123456789abcdef");
  Write("token", "fedcba9876543210\n");
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{"token_file"});
  ASSERT_TRUE(WaitFor(*by_token, v1::Envelope::kGoodbye));
  EXPECT_EQ(by_token->Find(v1::Envelope::kGoodbye)->goodbye().reason(),
            "revoked: the token in the server's token_file was replaced; copy the new one to this "
            "client");
  settings.view_token_file.clear();
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{"view_token_file"});
  ASSERT_TRUE(WaitFor(*by_view_token, v1::Envelope::kGoodbye));

  // The user's own certificate, which a real client shows.
  Write("clients", OwnCertificate().fingerprint() + " log\n");
  EXPECT_TRUE(settings.Reapply(*server_).ok());
  StartClient(TlsAddress(Port()), "");
  ASSERT_TRUE(RunUntilState(LinkState::kLive)) << why_;
  Write("clients", "# nobody\n");
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{"clients_file"});
  ASSERT_TRUE(RunUntil([&] { return WhyHas("was removed from the server's clients_file"); }));
  ASSERT_TRUE(RunUntilState(LinkState::kRefused)) << why_;
  EXPECT_EQ(local->Find(v1::Envelope::kGoodbye), nullptr) << "nothing of its was revoked";
}

TEST_F(ServerAccess, EachKindOfMissingProofHasALineOfTheLog) {
  options_.clients["sha256:another"] = v1::ROLE_VIEW;
  StartTlsServer();
  const auto nameless = Connect(kTls);
  nameless->Read();
  nameless->Send(Hello());
  ASSERT_TRUE(WaitFor(*nameless, v1::Envelope::kRefused));
  const std::string own = OwnCertificate().fingerprint();
  EXPECT_EQ(RoleOf(v1::ROLE_VIEW, ""), std::nullopt);
  ASSERT_EQ(overloads_.size(), 2u);
  EXPECT_NE(overloads_[0].find("neither a token nor a certificate"), std::string::npos);
  EXPECT_NE(overloads_[1].find("its certificate is not in the clients_file"), std::string::npos);
  EXPECT_NE(overloads_[1].find(own + " view"), std::string::npos) << overloads_[1];
}

TEST_F(ServerAccess, BeyondThisHostTheTokenIsNotSentInClearUnlessAllowed) {
  ClientOptions options;
  options.token = "0123456789abcdef";
  const auto hello = [&](const std::string& address) {
    options.address = ParseAddress(address).value();
    return MakeHello(options);
  };
  for (const std::string address : {"tls:192.0.2.5:7450", "tcp:127.0.0.1:7450", "unix:/tmp/s"}) {
    EXPECT_EQ(hello(address).value().hello().token(), options.token) << address;
  }
  const auto refused = hello("tcp:192.0.2.5:7450");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("FOOTING_INSECURE_LAN=1"), std::string::npos);
  setenv("FOOTING_INSECURE_LAN", "1", 1);
  EXPECT_EQ(hello("tcp:192.0.2.5:7450").value().hello().token(), options.token);
  unsetenv("FOOTING_INSECURE_LAN");
  options.token.clear();
  EXPECT_TRUE(hello("tcp:192.0.2.5:7450").ok()) << "there is nothing to hide";
}

using TlsTest = TlsFixture;

TEST_F(TlsTest, TheFirstCertificateIsRememberedAndTheTokenLetsIn) {
  StartTlsServer();
  StartClient(TlsAddress(Port()));
  ASSERT_TRUE(RunUntilState(LinkState::kLive)) << why_;
  EXPECT_EQ(Known(Port()), server_->fingerprint());
  EXPECT_TRUE(tls::ParseFingerprint(server_->fingerprint()));
  const std::size_t before = ticks_.size();
  for (int i = 0; i < 20; ++i) PublishMotion(60'000);  // Each over several TLS records.
  ASSERT_TRUE(RunUntil([&] { return ticks_.size() == before + 20; }));
  for (std::size_t i = before; i < ticks_.size(); ++i) {
    ASSERT_EQ(ticks_[i].raw().reports(0).report(), std::string(60'000, 'r'));
  }
}

TEST_F(TlsTest, AReaderThatStallsGetsGapsAndWholeFrames) {
  StartTlsServer();
  auto client = Connect(kTls);
  client->Read();
  v1::Envelope hello = Hello();
  hello.mutable_hello()->set_token(kFixtureToken);
  client->Send(hello);
  client->Send(Subscribe(v1::QUEUE_POLICY_DROP_OLDEST, 4));
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kTick));
  // The reader has no turn while 20 MB are published: socket and queue fill up.
  for (int i = 0; i < 20; ++i) PublishMotion(1'000'000);
  const std::uint64_t last = PublishMotion();
  ASSERT_TRUE(RunUntil(
      [&] { return client->Sequences().size() > 0 && client->Sequences().back() == last; }));
  EXPECT_NE(client->Find(v1::Envelope::kGap), nullptr);
}

TEST_F(TlsTest, AChangedCertificateIsRefusedAndTheTokenIsNotSent) {
  StartTlsServer();
  const std::uint16_t port = Port();
  StartClient(TlsAddress(port));
  ASSERT_TRUE(RunUntilState(LinkState::kLive)) << why_;
  const std::string first = server_->fingerprint();
  server_.reset();
  options_.identity_file = config_.Path("another.pem");
  StartTlsServer(port);
  ASSERT_NE(server_->fingerprint(), first);
  ASSERT_TRUE(RunUntilState(LinkState::kRefused)) << why_;
  EXPECT_TRUE(WhyHas("THE CERTIFICATE HAS CHANGED")) << why_;
  EXPECT_TRUE(WhyHas(first) && WhyHas(server_->fingerprint())) << why_;
  EXPECT_EQ(Known(port), first) << "what was trusted stays";
  EXPECT_EQ(server_->statistics().sessions, 0u);
  // A person has compared the new one: now it is taken, at the next try.
  const tls::KnownServers known(config_.Path("known_servers"));
  ASSERT_TRUE(known.Add("127.0.0.1:" + std::to_string(port), server_->fingerprint()).ok());
  client_.reset();
  StartClient(TlsAddress(port));
  EXPECT_TRUE(RunUntilState(LinkState::kLive)) << why_;
}

TEST_F(TlsTest, TwoServersHaveTwoCertificates) {
  StartTlsServer();
  StartClient(TlsAddress(Port()));
  ASSERT_TRUE(RunUntilState(LinkState::kLive)) << why_;
  const auto one = std::move(server_);
  const std::uint16_t port = one->ListeningOn(kTls).port;
  ServerOptions options = options_;
  options.identity_file = config_.Path("other.pem");
  Server other(io_, options, {});
  ASSERT_TRUE(other.Listen(TlsAddress()).ok());
  StartClient(TlsAddress(other.ListeningOn(0).port));
  ASSERT_TRUE(RunUntilState(LinkState::kLive)) << why_;
  EXPECT_EQ(Known(port), one->fingerprint());
  EXPECT_EQ(Known(other.ListeningOn(0).port), other.fingerprint());
  client_.reset();
}

TEST_F(TlsTest, WithoutTheTokenNobodyComesIn) {
  StartTlsServer();
  StartClient(TlsAddress(Port()), "0123456789abcdeX");
  ASSERT_TRUE(RunUntilState(LinkState::kRefused));
  EXPECT_TRUE(WhyHas("the token is wrong")) << why_;
  unsetenv("FOOTING_TOKEN_FILE");
  state_.reset();
  StartClient(TlsAddress(Port()), "");
  ASSERT_TRUE(RunUntilState(LinkState::kRefused));
  EXPECT_TRUE(WhyHas("FOOTING_TOKEN_FILE")) << why_;
}

TEST_F(TlsTest, APlainClientOnATlsPortHearsWhatToDo) {
  StartTlsServer();
  Address plain = TlsAddress(Port());
  plain.kind = Address::Kind::kTcp;
  StartClient(plain);
  ASSERT_TRUE(RunUntilState(LinkState::kRefused)) << why_;
  EXPECT_TRUE(WhyHas("this port speaks TLS: connect with tls:HOST:PORT")) << why_;
}

TEST_F(TlsTest, ATlsClientOnAPlainPortHearsWhatToDo) {
  StartTlsServer();
  StartClient(TlsAddress(Port(1)));
  ASSERT_TRUE(RunUntil([&] { return WhyHas("does not speak TLS"); })) << why_;
  EXPECT_TRUE(WhyHas("connect with tcp:")) << why_;
  EXPECT_EQ(Known(Port(1)), std::nullopt) << "nothing was proved";
}

TEST_F(TlsTest, Tls13AndNothingOlderIsSpoken) {
  StartTlsServer();
  EXPECT_FALSE(HandshakeOf(boost::asio::ssl::context::tlsv13_client));
  const error_code refused = HandshakeOf(boost::asio::ssl::context::tlsv12_client);
  EXPECT_EQ(refused.category(), boost::asio::error::get_ssl_category());
  EXPECT_NE(refused.message().find("protocol version"), std::string::npos) << refused.message();
}

TEST_F(TlsTest, AHandshakeThatStallsIsCutOffAtTheDeadline) {
  options_.hello_deadline_s = 0.05;
  StartTlsServer();
  // Nothing, half of the first bytes, and a ClientHello that never ends.
  const std::string begun("\x16\x03\x01\x01\x04\x01\x00\x01\x00\x03\x03", 11);
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, begun.size()}) {
    tcp::socket peer = PlainPeer(Port());
    boost::asio::write(peer, boost::asio::buffer(begun.data(), size));
    std::optional<error_code> ended;
    char byte = 0;
    boost::asio::async_read(peer, boost::asio::buffer(&byte, 1),
                            [&](const error_code& error, std::size_t) { ended = error; });
    ASSERT_TRUE(RunUntil([&] { return ended.has_value(); })) << size;
    EXPECT_TRUE(*ended == boost::asio::error::eof ||
                *ended == boost::asio::error::connection_reset);
  }
  EXPECT_EQ(server_->statistics().refused, 3u);
}

TEST_F(TlsTest, AnEndlessClientHelloIsRefusedByItsHeader) {
  StartTlsServer();
  tcp::socket peer = PlainPeer(Port());
  boost::asio::write(peer, boost::asio::buffer("\x16\x03\x01\x40\x00\x01\xff\xff\xff", 9));
  std::optional<error_code> ended;
  char byte = 0;
  boost::asio::async_read(peer, boost::asio::buffer(&byte, 1),
                          [&](const error_code& error, std::size_t) { ended = error; });
  EXPECT_TRUE(RunUntil([&] { return ended.has_value(); })) << "long before the deadline";
}

TEST_F(TlsTest, HandshakesUnderWayTakeTheirPlaces) {
  options_.sessions.max_sessions_per_user = 2;
  StartTlsServer();
  const tcp::socket one = PlainPeer(Port()), other = PlainPeer(Port());
  ASSERT_TRUE(RunUntil([&] { return server_->statistics().accepted == 2; }));
  StartClient(TlsAddress(Port()));
  ASSERT_TRUE(RunUntilState(LinkState::kRefused)) << why_;
  EXPECT_TRUE(WhyHas("2 sessions over TCP already")) << why_;
}

TEST_F(TlsTest, AHostThatNeverComesInLeavesPlacesToOthers) {
  options_.sessions.max_entering_per_host = 2;
  StartTlsServer();
  const tcp::socket one = PlainPeer(Port()), other = PlainPeer(Port());
  ASSERT_TRUE(RunUntil([&] { return server_->statistics().accepted == 2; }));
  StartClient(TlsAddress(Port()));
  ASSERT_TRUE(RunUntilState(LinkState::kLive)) << why_ << "; the oldest gives way";
  ASSERT_FALSE(overloads_.empty());  // A slow machine may also see the other stranger's deadline.
  EXPECT_NE(overloads_[0].find("2 unauthenticated connections from this host"), std::string::npos);
  // Loopback TCP and the Unix socket are not for other hosts.
  const auto local = Subscribed(Subscribe(), 1);
  EXPECT_NE(local->Find(v1::Envelope::kTick), nullptr);
}

TEST_F(TlsTest, WhoIsKeptOutIsLoggedWithItsHostAndOnceInTenSeconds) {
  StartTlsServer();
  for (int i = 0; i < 3; ++i) {
    state_.reset();
    StartClient(TlsAddress(Port()), "0123456789abcdeX");
    ASSERT_TRUE(RunUntilState(LinkState::kRefused)) << why_;
  }
  EXPECT_EQ(server_->statistics().denied, 3u);
  EXPECT_EQ(overloads_, std::vector<std::string>{
                            "refused a client from 127.0.0.1: wrong token (1 since start)"});
}

TEST_F(TlsTest, ACertificateThatTheServerKnowsGivesItsRole) {
  const auto own = tls::Identity::LoadOrMake(config_.Path("client.pem"), "viewer");
  ASSERT_TRUE(own.ok());
  options_.token.clear();
  options_.clients[tls::FingerprintOf("somebody else")] = v1::ROLE_CONTROL;
  StartTlsServer();
  StartClient(TlsAddress(Port()), "");
  ASSERT_TRUE(RunUntilState(LinkState::kRefused)) << why_;
  EXPECT_TRUE(WhyHas("it does not know yours, " + own->fingerprint())) << why_;

  const std::uint16_t port = Port();
  server_.reset();
  options_.clients[own->fingerprint()] = v1::ROLE_VIEW;
  StartTlsServer(port);
  StartClient(TlsAddress(port), "");
  ASSERT_TRUE(RunUntilState(LinkState::kLive)) << why_;
  std::optional<v1::CommandResult> result;
  client_->Send({}, [&](const v1::CommandResult& answer) { result = answer; });
  ASSERT_TRUE(RunUntil([&] { return result.has_value(); }));
  EXPECT_FALSE(result->ok()) << "view never actuates";
  EXPECT_TRUE(commands_.empty());
}

TEST_F(TlsTest, WithoutAnybodyToLetInItDoesNotListen) {
  options_.token.clear();
  StartServer(options_);
  const auto refused = server_->Listen(TlsAddress());
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_NE(refused.error().message.find("token_file or clients_file"), std::string::npos);
}

}  // namespace
}  // namespace footing::transport
