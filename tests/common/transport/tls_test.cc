#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/write.hpp>
#include <optional>

#include "common/tls/fingerprint.h"
#include "common/tls/known_servers.h"
#include "common/transport/client.h"
#include "tests/common/temporary_folder.h"
#include "tests/common/transport/server_fixture.h"

namespace footing::transport {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr char kToken[] = "0123456789abcdef";
constexpr std::size_t kTls = 2;  // The listener behind those of ServerFixture.

Address TlsAddress(std::uint16_t port = 0) {
  Address address;
  address.kind = Address::Kind::kTls;
  address.host = "127.0.0.1";
  address.port = port;
  return address;
}

class TlsTest : public ServerFixture {
 protected:
  TlsTest() {
    setenv("FOOTING_KNOWN_SERVERS", config_.Path("known_servers").c_str(), 1);
    options_.token = kToken;
    options_.identity_file = config_.Path("identity.pem");
  }
  ~TlsTest() override { unsetenv("FOOTING_KNOWN_SERVERS"); }

  void StartTlsServer(std::uint16_t port = 0) {
    StartServer(options_);
    const auto listening = server_->Listen(TlsAddress(port));
    ASSERT_TRUE(listening.ok()) << listening.error().message;
  }

  std::uint16_t Port(std::size_t listener = kTls) const {
    return server_->ListeningOn(listener).port;
  }

  /// A real client; its state and its words are kept.
  void StartClient(const Address& address, const std::string& token = kToken) {
    ClientOptions options;
    options.address = address;
    options.client_name = "test";
    options.token = token;
    ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) { ticks_.push_back(tick); };
    handlers.on_state = [this](LinkState state, const std::string& why) {
      state_ = state;
      why_ = why;
    };
    client_.emplace(io_, options, handlers);
    client_->Start();
  }

  bool RunUntilState(LinkState state) {
    return RunUntil([&] { return state_ == state; });
  }
  bool WhyHas(const std::string& text) const { return why_.find(text) != std::string::npos; }

  std::optional<std::string> Known(std::uint16_t port) const {
    return tls::KnownServers(config_.Path("known_servers"))
        .Find("127.0.0.1:" + std::to_string(port))
        .value();
  }

  /// A socket that speaks no TLS, connected to the listener.
  tcp::socket PlainPeer(std::uint16_t port) {
    tcp::socket socket(io_);
    socket.connect({boost::asio::ip::address_v4::loopback(), port});
    return socket;
  }

  /// What the handshake of a foreign TLS client ends with.
  error_code HandshakeOf(boost::asio::ssl::context::method method) {
    boost::asio::ssl::context context(method);
    boost::asio::ssl::stream<tcp::socket> stream(PlainPeer(Port()), context);
    std::optional<error_code> ended;
    stream.async_handshake(boost::asio::ssl::stream_base::client,
                           [&](const error_code& error) { ended = error; });
    EXPECT_TRUE(RunUntil([&] { return ended.has_value(); }));
    return *ended;
  }

  const test::TemporaryFolder config_;
  ServerOptions options_ = Options();
  std::optional<Client> client_;
  std::vector<v1::Tick> ticks_;
  std::optional<LinkState> state_;
  std::string why_;
};

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
  hello.mutable_hello()->set_token(kToken);
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
  ASSERT_TRUE(RunUntilState(LinkState::kRefused)) << why_;
  EXPECT_TRUE(WhyHas("2 connections of this host that have not come in yet")) << why_;
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
                            "kept out a client at 127.0.0.1, wrong token; 1 since the start"});
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
