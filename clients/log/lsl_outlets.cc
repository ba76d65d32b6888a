#include "clients/log/lsl_outlets.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <random>
#include <utility>
#include <vector>

#include <netinet/in.h>
#include <unistd.h>

#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>

#include "common/base/units.h"
#include "common/net/address.h"
#include "common/net/listener.h"
#include "common/net/own_address.h"
#include "common/net/socket.h"
#include "common/runtime/clock.h"
#include "common/runtime/timer.h"

namespace footing::log_client::lsl {
namespace {

namespace asio = boost::asio;
using asio::ip::udp;
using boost::system::error_code;
using transport::PlainSocket;

constexpr auto kRequestWithin = std::chrono::seconds(5);
/// The kernel's share of what a reader may leave unread.
constexpr int kSendBufferBytes = 256 << 10;

}  // namespace

class Session;

/// One stream and its readers.
struct Outlet {
  Info info;
  std::unique_ptr<transport::Listener> listener;
  std::vector<std::shared_ptr<Session>> readers{};
  std::uint64_t samples = 0, feeds = 0, dropped = 0;
};

/// One connection: a request, and its answer or the feed.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(PlainSocket socket, std::shared_ptr<Outlet> outlet, std::shared_ptr<void> place)
      : socket_(std::move(socket)),
        outlet_(std::move(outlet)),
        place_(std::move(place)),
        deadline_(socket_.get_executor()) {}

  void Start() {
    error_code ignored;  // A socket that is gone shows when it is read.
    socket_.non_blocking(true, ignored);
    socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
    socket_.set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
    deadline_.After(kRequestWithin, [this] { Close(); });
    Read();
  }
  void Refuse(const std::string& why) {
    Start();
    Answer("LSL/110 " + why + "\r\n\r\n");
  }

  /// Bytes that the kernel does not take at once wait here.
  void Send(std::string_view bytes) {
    if (closed_) return;
    if (waiting_.empty()) {
      error_code error;
      const std::size_t sent = socket_.write_some(asio::buffer(bytes), error);
      if (error && error != asio::error::would_block) return Close();
      bytes.remove_prefix(error ? 0 : sent);
    }
    if (bytes.empty()) return;
    if (waiting_.size() + bytes.size() > Outlets::kMostWaitingBytes) {
      ++outlet_->dropped;
      std::cerr << outlet_->info.name << ": dropped a reader that does not read" << std::endl;
      return Close();
    }
    waiting_ += bytes;
    if (!writing_) WriteLater();
  }

  bool closed() const { return closed_; }

  void Close() {
    if (std::exchange(closed_, true)) return;
    deadline_.cancel();
    waiting_.clear();
    error_code ignored;  // It may be gone already.
    socket_.shutdown(PlainSocket::shutdown_both, ignored);
    socket_.close(ignored);
  }

 private:
  void Read() {
    socket_.async_read_some(asio::buffer(bytes_), [self = shared_from_this()](
                                                      const error_code& error, std::size_t count) {
      if (self->closed_) return;
      if (error) return self->Close();
      self->Take({self->bytes_.data(), count});
      if (!self->closed_) self->Read();
    });
  }

  /// After the request nothing that comes counts.
  void Take(std::string_view bytes) {
    if (answered_) return;
    request_ += bytes;
    const Request request = ParseRequest(request_, outlet_->info);
    switch (request.kind) {
      case Request::Kind::kIncomplete:
        return;
      case Request::Kind::kShortInfo:
        return Answer(ShortInfo(outlet_->info));
      case Request::Kind::kFullInfo:
        return Answer(FullInfo(outlet_->info));
      case Request::Kind::kRefused:
        return Answer(request.refusal);
      case Request::Kind::kStreamFeed:
        break;
    }
    answered_ = true;
    request_.clear();
    deadline_.cancel();
    ++outlet_->feeds;
    Send(FeedStart(outlet_->info));
    if (!closed_) outlet_->readers.push_back(shared_from_this());
  }

  /// The other side closes once it has the answer; otherwise the deadline does.
  void Answer(const std::string& answer) {
    answered_ = ends_ = true;
    request_.clear();
    Send(answer);
    EndOnceSent();
  }
  void EndOnceSent() {
    error_code ignored;  // It may be gone already.
    if (ends_ && waiting_.empty() && !closed_) {
      socket_.shutdown(PlainSocket::shutdown_send, ignored);
    }
  }

  void WriteLater() {
    writing_ = true;
    socket_.async_wait(
        PlainSocket::wait_write, [self = shared_from_this()](const error_code& error) {
          self->writing_ = false;
          if (self->closed_) return;
          if (error) return self->Close();
          error_code failed;
          const std::size_t sent = self->socket_.write_some(asio::buffer(self->waiting_), failed);
          if (failed && failed != asio::error::would_block) return self->Close();
          self->waiting_.erase(0, failed ? 0 : sent);
          if (!self->waiting_.empty()) return self->WriteLater();
          self->EndOnceSent();
        });
  }

  PlainSocket socket_;
  std::shared_ptr<Outlet> outlet_;
  std::shared_ptr<void> place_;  ///< Among the connections.
  timer::Timer deadline_;        ///< The request must be here by then.
  std::array<char, 4096> bytes_{};
  std::string request_;
  std::string waiting_;
  bool answered_ = false;
  bool ends_ = false;
  bool writing_ = false;
  bool closed_ = false;
};

double NowS() { return NanosecondsToSeconds(clock::MonotonicNs()); }

std::string NewUid() {
  std::random_device random;
  char text[40];
  const auto word = [&random] { return static_cast<unsigned>(random()); };
  std::snprintf(text, sizeof text, "%08x-%04x-4%03x-%04x-%04x%08x", word(), word() & 0xFFFF,
                word() & 0xFFF, 0x8000 | (word() & 0x3FFF), word() & 0xFFFF, word());
  return text;
}

class Outlets::Implementation : public std::enable_shared_from_this<Outlets::Implementation> {
 public:
  Implementation(asio::io_context& io, OutletsOptions options)
      : io_(io), options_(std::move(options)), queries_(io), service_(io) {}

  Result<void> Open() {
    error_code error;
    address_ = asio::ip::make_address_v4(options_.interface, error);
    const std::string given = "--interface " + options_.interface + ": ";
    if (error) return UsageError(given + "not an IPv4 address, such as 127.0.0.1");
    if (!address_.is_loopback() && !options_.insecure_lan) {
      return UsageError(given +
                        "anybody in that network could read the streams; allow it with "
                        "--insecure-lan, or leave both out for this host alone");
    }
    const auto own = transport::OwnAddresses();
    if (!address_.is_loopback() &&
        std::find(own.begin(), own.end(), options_.interface) == own.end())
      return UsageError(given + "this host has no such address; list them with: ip address");
    if (const auto opened = OpenQueries(own); !opened) return opened;
    if (const auto opened = OpenService(); !opened) return opened;
    Receive(queries_, query_);
    Receive(service_, request_);
    return {};
  }

  void Close() {
    closed_ = true;
    error_code ignored;  // They are not used any more.
    queries_.close(ignored);
    service_.close(ignored);
    for (const auto& outlet : outlets_) {
      outlet->listener->Close();
      for (const auto& reader : outlet->readers) reader->Close();
      outlet->readers.clear();
    }
  }

  Result<std::size_t> Add(Info info) {
    if (outlets_.size() >= kMostStreams)
      return Failure("no more than " + std::to_string(kMostStreams) + " streams can be offered");
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host = {"localhost"};
    info.hostname = host.data();
    info.uid = NewUid();
    info.created_s = NowS();
    info.v4address = options_.interface;
    info.service_port = service_.local_endpoint().port();
    const auto outlet = std::make_shared<Outlet>();
    for (std::uint16_t i = 0; i <= kPorts && !outlet->listener; ++i) {
      const auto port = static_cast<std::uint16_t>(i < kPorts ? kFirstPort + i : 0);
      transport::Address at;
      at.kind = transport::Address::Kind::kTcp;
      at.host = options_.interface;
      at.port = port;
      transport::ListenSecurity security;
      security.insecure_lan = options_.insecure_lan;
      auto listener = transport::Listener::Open(
          io_, at,
          [weak = std::weak_ptr(outlet), self = weak_from_this()](transport::Socket socket) {
            const auto outlet_then = weak.lock();
            const auto all = self.lock();
            if (outlet_then && all) all->OnAccept(std::move(socket), outlet_then);
          },
          security);
      if (!listener && port == 0) return listener.error();
      if (listener) outlet->listener = std::move(*listener);
    }
    info.data_port = outlet->listener->address().port;
    outlet->info = std::move(info);
    outlets_.push_back(outlet);
    return outlets_.size() - 1;
  }

  void Push(std::size_t stream, std::string_view sample) {
    Outlet& outlet = *outlets_.at(stream);
    ++outlet.samples;
    for (const auto& reader : outlet.readers) reader->Send(sample);
    std::erase_if(outlet.readers, [](const auto& reader) { return reader->closed(); });
  }

  const std::vector<std::shared_ptr<Outlet>>& outlets() const { return outlets_; }

 private:
  Result<void> OpenQueries(std::vector<std::string> own) {
    error_code error;
    queries_.open(udp::v4(), error);
    if (!error) queries_.set_option(udp::socket::reuse_address(true), error);
    if (!error) queries_.bind(udp::endpoint(udp::v4(), kQueryPort), error);
    if (error) {
      return Failure("cannot take UDP port " + std::to_string(kQueryPort) +
                     ", where queries for LSL streams come: " + transport::MessageOf(error) +
                     "; another program may hold it alone: ss -ulpn");
    }
    const int joined_only = 0;
    ::setsockopt(queries_.native_handle(), IPPROTO_IP, IP_MULTICAST_ALL, &joined_only,
                 sizeof joined_only);
    // For this host alone, too, on every interface: there the programs of this host ask, and what
    // others ask is not answered.
    if (!address_.is_loopback()) own = {options_.interface, "127.0.0.1"};
    for (const std::string& interface : own) {
      for (const char* group : kGroups) {
        error_code ignored;  // Queries without a group come all the same.
        queries_.set_option(asio::ip::multicast::join_group(asio::ip::make_address_v4(group),
                                                            asio::ip::make_address_v4(interface)),
                            ignored);
      }
    }
    return {};
  }

  Result<void> OpenService() {
    error_code error;
    service_.open(udp::v4(), error);
    if (!error) {
      for (std::uint16_t i = 0; i <= kPorts; ++i) {
        const auto port = static_cast<std::uint16_t>(i < kPorts ? kFirstPort + i : 0);
        service_.bind(udp::endpoint(address_, port), error);
        if (!error) break;
      }
    }
    if (!error) service_.non_blocking(true, error);
    if (error) {
      return Failure("cannot open a UDP port on " + options_.interface + ": " +
                     transport::MessageOf(error));
    }
    return {};
  }

  /// One datagram and its sender.
  struct Datagram {
    std::array<char, kMostRequestBytes> bytes;
    udp::endpoint from;
  };

  void Receive(udp::socket& socket, Datagram& datagram) {
    socket.async_receive_from(
        asio::buffer(datagram.bytes), datagram.from,
        [self = shared_from_this(), &socket, &datagram](const error_code& error,
                                                        std::size_t count) {
          const double arrived_s = NowS();
          if (self->closed_) return;
          // An error is about an answer that nobody waited for.
          if (!error) self->Answer({datagram.bytes.data(), count}, datagram.from, arrived_s);
          self->Receive(socket, datagram);
        });
  }

  void Answer(std::string_view datagram, const udp::endpoint& from, double arrived_s) {
    if (address_.is_loopback() && !IsOwn(from.address())) return;
    error_code ignored;  // Whoever asked asks again.
    if (auto exchange = ParseTimeRequest(datagram)) {
      exchange->t1 = arrived_s;
      exchange->t2 = NowS();
      service_.send_to(asio::buffer(EncodeTimeAnswer(*exchange)), from, 0, ignored);
    } else if (const auto request = ParseShortInfoRequest(datagram)) {
      const udp::endpoint to(from.address(), request->return_port);
      for (const auto& outlet : outlets_) {
        if (!Matches(outlet->info, request->query)) continue;
        service_.send_to(asio::buffer(ShortInfoAnswer(request->query_id, outlet->info)), to, 0,
                         ignored);
      }
    }
  }

  static bool IsOwn(const asio::ip::address& address) {
    if (address.is_loopback()) return true;
    const auto own = transport::OwnAddresses();
    return std::find(own.begin(), own.end(), address.to_string()) != own.end();
  }

  void OnAccept(transport::Socket socket, const std::shared_ptr<Outlet>& outlet) {
    const auto place =
        std::shared_ptr<void>(nullptr, [connections = connections_](void*) { --*connections; });
    const bool full = ++*connections_ > kMostConnections;
    const auto session = std::make_shared<Session>(std::move(socket.plain()), outlet, place);
    if (!full) return session->Start();
    session->Refuse("503 There are too many readers");
  }

  asio::io_context& io_;
  OutletsOptions options_;
  asio::ip::address_v4 address_;
  udp::socket queries_, service_;
  Datagram query_, request_;
  std::vector<std::shared_ptr<Outlet>> outlets_;
  std::shared_ptr<std::size_t> connections_ = std::make_shared<std::size_t>(0);
  bool closed_ = false;
};

Result<std::unique_ptr<Outlets>> Outlets::Open(asio::io_context& io,
                                               const OutletsOptions& options) {
  auto implementation = std::make_shared<Implementation>(io, options);
  if (const auto opened = implementation->Open(); !opened) return opened.error();
  return std::unique_ptr<Outlets>(new Outlets(std::move(implementation)));
}

Outlets::Outlets(std::shared_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Outlets::~Outlets() { implementation_->Close(); }

Result<std::size_t> Outlets::Add(Info info) { return implementation_->Add(std::move(info)); }

void Outlets::Push(std::size_t stream, double time_s, std::span<const double> values) {
  FOOTING_CHECK(values.size() == info(stream).channels);
  std::string sample;
  AppendSample(time_s, values, sample);
  implementation_->Push(stream, sample);
}

void Outlets::Push(std::size_t stream, double time_s, std::string_view text) {
  std::string sample;
  AppendSample(time_s, text, sample);
  implementation_->Push(stream, sample);
}

std::size_t Outlets::size() const { return implementation_->outlets().size(); }
const Info& Outlets::info(std::size_t stream) const {
  return implementation_->outlets().at(stream)->info;
}
OutletReport Outlets::report(std::size_t stream) const {
  const Outlet& outlet = *implementation_->outlets().at(stream);
  return {outlet.info.name, outlet.info.type, outlet.info.channels,
          outlet.samples,   outlet.feeds,     outlet.dropped};
}

}  // namespace footing::log_client::lsl
