#include <unistd.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/write.hpp>
#include <cstdlib>
#include <filesystem>
#include <list>
#include <optional>
#include <utility>

#include "common/runtime/clock.h"
#include "common/base/quantile.h"
#include "common/net/context.h"
#include "common/net/identity.h"
#include "common/net/framed_connection.h"
#include "common/net/framing.h"
#include "common/net/listener.h"
#include "daemon/offline/bench/loop_thread.h"
#include "daemon/offline/bench/pairs.h"
#include "daemon/offline/bench/row.h"
#include "daemon/offline/bench/waiting.h"

namespace footing::bench {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr int kTlsPairs = 9;
constexpr int kConnects = 60;
constexpr int kRoundTrips = 3000;
constexpr std::size_t kEchoBytes = 100;

/// Ours: frames over a Listener's sockets, sent back; in turns, as a server's sessions are.
class FramedEcho {
 public:
  FramedEcho(asio::io_context& io, const tls::Identity& identity) : io_(io), identity_(identity) {
    loop_.turns = std::make_shared<transport::TurnQueue>(io.get_executor());
  }

  Result<void> Listen() {
    transport::Address address = TcpAddress();
    address.kind = transport::Address::Kind::kTls;
    transport::ListenSecurity security;
    security.tls = [this] { return tls::Context::ForServer(identity_); };
    auto listener = transport::Listener::Open(
        io_, address, [this](transport::Socket socket) { Accept(std::move(socket)); }, security);
    if (!listener) return listener.error();
    listener_ = std::move(*listener);
    return {};
  }
  const transport::Address& address() const { return listener_->address(); }

 private:
  void Accept(transport::Socket socket) {
    const auto place = connections_.emplace(connections_.end());
    transport::FramedHandlers handlers;
    handlers.on_frame = [place](std::string_view payload) { (*place)->Send(payload); };
    handlers.on_close = [this, place](const std::string&) { connections_.erase(place); };
    place->emplace(std::move(socket), transport::FramedLimits(), std::move(handlers), loop_);
    (*place)->Start();
  }

  asio::io_context& io_;
  const tls::Identity& identity_;
  transport::SharedLoop loop_;
  std::unique_ptr<transport::Listener> listener_;
  std::list<std::optional<transport::FramedConnection>> connections_;
};

/// The baseline: Asio's own TLS stream, one frame of known length at a time; the same certificate,
/// TLS 1.3, no tickets.
class BareEcho {
 public:
  BareEcho(asio::io_context& io, const std::string& identity_file)
      : acceptor_(io, {asio::ip::address_v4::loopback(), 0}), context_(asio::ssl::context::tlsv13) {
    context_.use_certificate_chain_file(identity_file);
    context_.use_private_key_file(identity_file, asio::ssl::context::pem);
    SSL_CTX_set_num_tickets(context_.native_handle(), 0);
    Accept();
  }
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  struct Connection {
    Connection(tcp::socket socket, asio::ssl::context& context)
        : stream(std::move(socket), context), frame(kEchoBytes + transport::kLengthBytes, '\0') {}
    asio::ssl::stream<tcp::socket> stream;
    std::string frame;
  };

  void Accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      if (error) return;
      socket.set_option(tcp::no_delay(true));
      const auto connection = std::make_shared<Connection>(std::move(socket), context_);
      connection->stream.async_handshake(asio::ssl::stream_base::server,
                                         [connection](const error_code& failed) {
                                           if (!failed) Echo(connection);
                                         });
      Accept();
    });
  }

  static void Echo(const std::shared_ptr<Connection>& connection) {
    const auto buffer = asio::buffer(connection->frame);
    asio::async_read(connection->stream, buffer,
                     [connection, buffer](const error_code& error, std::size_t) {
                       if (error) return;
                       asio::async_write(connection->stream, buffer,
                                         [connection](const error_code& failed, std::size_t) {
                                           if (!failed) Echo(connection);
                                         });
                     });
  }

  tcp::acceptor acceptor_;
  asio::ssl::context context_;
};

/// When an exchange began, then when each of its echoes arrived.
using Stamps = std::vector<std::int64_t>;

/// One connection of ours: `echoes` frames, each sent when the one before has come back.
class FramedExchange {
 public:
  FramedExchange(asio::io_context& io, const transport::Address& address, std::size_t echoes,
                 std::function<void()> done)
      : echoes_(echoes), done_(std::move(done)), stamps_{clock::MonotonicNs()} {
    transport::Dial(io, address, [this](Result<transport::Socket> socket) {
      if (!socket) return done_();
      transport::FramedHandlers handlers;
      handlers.on_frame = [this](std::string_view payload) {
        stamps_.push_back(clock::MonotonicNs());
        stamps_.size() > echoes_ ? done_() : static_cast<void>(connection_->Send(payload));
      };
      handlers.on_close = [this](const std::string&) { done_(); };
      connection_.emplace(std::move(*socket), transport::FramedLimits(), std::move(handlers));
      connection_->Start();
      connection_->Send(std::string(kEchoBytes, 'e'));
    });
  }
  const Stamps& stamps() const { return stamps_; }

 private:
  const std::size_t echoes_;
  std::function<void()> done_;
  Stamps stamps_;
  std::optional<transport::FramedConnection> connection_;
};

/// The same with Asio alone.
class BareExchange {
 public:
  BareExchange(asio::io_context& io, asio::ssl::context& context, std::uint16_t port,
               std::size_t echoes, std::function<void()> done)
      : echoes_(echoes),
        done_(std::move(done)),
        stamps_{clock::MonotonicNs()},
        stream_(io, context),
        frame_(transport::Frame(std::string(kEchoBytes, 'e'))) {
    stream_.next_layer().async_connect({asio::ip::address_v4::loopback(), port},
                                       [this](const error_code& error) {
                                         if (error) return done_();
                                         stream_.next_layer().set_option(tcp::no_delay(true));
                                         ShakeHands();
                                       });
  }
  const Stamps& stamps() const { return stamps_; }

 private:
  void ShakeHands() {
    stream_.async_handshake(asio::ssl::stream_base::client,
                            [this](const error_code& error) { error ? done_() : Send(); });
  }
  void Send() {
    asio::async_write(stream_, asio::buffer(frame_), [this](const error_code& error, std::size_t) {
      error ? done_() : Receive();
    });
  }
  void Receive() {
    asio::async_read(stream_, asio::buffer(frame_), [this](const error_code& error, std::size_t) {
      if (!error) stamps_.push_back(clock::MonotonicNs());
      error || stamps_.size() > echoes_ ? done_() : Send();
    });
  }

  const std::size_t echoes_;
  std::function<void()> done_;
  Stamps stamps_;
  asio::ssl::stream<tcp::socket> stream_;
  std::string frame_;
};

/// Makes an exchange on the thread and waits for its end.
template <typename Exchange, typename... Arguments>
Stamps StampsOf(LoopThread& thread, std::size_t echoes, Arguments&... arguments) {
  std::optional<Exchange> exchange;
  std::promise<void> over;
  bool done = false;
  thread.Do([&] {
    exchange.emplace(thread.io(), arguments..., echoes, [&] {
      if (!std::exchange(done, true)) over.set_value();
    });
  });
  over.get_future().wait();
  Stamps stamps;
  thread.Do([&] {
    stamps = exchange->stamps();
    exchange.reset();
  });
  return stamps;
}

double MedianUs(const std::vector<double>& times_ns) {
  return times_ns.empty() ? 0 : 1e-3 * text::Quantile(times_ns, 0.5);
}

/// From the dial until the first echo: connection, handshake, and one round trip.
double MedianConnectUs(const std::function<Stamps(std::size_t echoes)>& exchange) {
  std::vector<double> times_ns;
  for (int i = 0; i < kConnects; ++i) {
    const Stamps stamps = exchange(1);
    if (stamps.size() == 2) times_ns.push_back(static_cast<double>(stamps[1] - stamps[0]));
  }
  return MedianUs(times_ns);
}

double MedianRoundTripUs(const std::function<Stamps(std::size_t echoes)>& exchange) {
  const Stamps stamps = exchange(kRoundTrips);
  std::vector<double> times_ns;
  for (std::size_t i = 2; i < stamps.size(); ++i) {
    times_ns.push_back(static_cast<double>(stamps[i] - stamps[i - 1]));
  }
  return MedianUs(times_ns);
}

}  // namespace

Result<Rows> TlsExchange() {
  const std::string folder = "/tmp/footing-bench-" + std::to_string(getpid()) + "-tls";
  setenv("FOOTING_KNOWN_SERVERS", (folder + "/known_servers").c_str(), 1);
  const std::string identity_file = folder + "/identity.pem";
  const auto identity = tls::Identity::LoadOrMake(identity_file, "footing-bench");
  if (!identity) return identity.error();
  LoopThread server_thread, client_thread;
  FramedEcho framed(server_thread.io(), *identity);
  BareEcho bare(server_thread.io(), identity_file);
  asio::ssl::context bare_context(asio::ssl::context::tlsv13_client);
  const StopsAtEnd stops{&server_thread, &client_thread};
  Result<void> listening;
  server_thread.Do([&] { listening = framed.Listen(); });
  if (!listening) return listening.error();
  const transport::Address address = framed.address();
  const std::uint16_t port = bare.port();
  const auto ours = [&](std::size_t echoes) {
    return StampsOf<FramedExchange>(client_thread, echoes, address);
  };
  const auto baseline = [&](std::size_t echoes) {
    return StampsOf<BareExchange>(client_thread, echoes, bare_context, port);
  };
  if (ours(1).size() != 2 || baseline(1).size() != 2) {
    return Failure("tls_connect: the echo did not come back");
  }
  const Row connect = RunPairs(
      "tls_connect_p50", "us", kTlsPairs, [&] { return MedianConnectUs(ours); },
      [&] { return MedianConnectUs(baseline); });
  const Row round_trip = RunPairs(
      "tls_round_trip_p50", "us", kTlsPairs, [&] { return MedianRoundTripUs(ours); },
      [&] { return MedianRoundTripUs(baseline); });
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  return Rows{connect, round_trip};
}

}  // namespace footing::bench
