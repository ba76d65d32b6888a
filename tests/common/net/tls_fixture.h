#pragma once

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "common/net/client.h"
#include "common/net/known_servers.h"
#include "tests/common/net/server_fixture.h"
#include "tests/common/temporary_folder.h"

namespace footing::transport {

using boost::asio::ip::tcp;
using boost::system::error_code;

inline constexpr char kFixtureToken[] = "0123456789abcdef";
inline constexpr std::size_t kTls = 2;  // The listener behind those of ServerFixture.

inline Address TlsAddress(std::uint16_t port = 0) {
  Address address;
  address.kind = Address::Kind::kTls;
  address.host = "127.0.0.1";
  address.port = port;
  return address;
}

/// A server that also listens on tls:, and a real client.
class TlsFixture : public ServerFixture {
 protected:
  TlsFixture() {
    setenv("FOOTING_KNOWN_SERVERS", config_.Path("known_servers").c_str(), 1);
    options_.token = kFixtureToken;
    options_.identity_file = config_.Path("identity.pem");
  }
  ~TlsFixture() override { unsetenv("FOOTING_KNOWN_SERVERS"); }

  void StartTlsServer(std::uint16_t port = 0) {
    StartServer(options_);
    const auto listening = server_->Listen(TlsAddress(port));
    ASSERT_TRUE(listening.ok()) << listening.error().message;
  }

  std::uint16_t Port(std::size_t listener = kTls) const {
    return server_->ListeningOn(listener).port;
  }

  /// A real client; its state and its words are kept.
  void StartClient(const Address& address, const std::string& token = kFixtureToken) {
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

  /// Error at the end of the handshake of a foreign TLS client.
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

}  // namespace footing::transport
