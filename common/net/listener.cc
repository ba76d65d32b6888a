#include "common/net/listener.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <utility>

#include "common/net/address.h"
#include "common/net/socket.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::transport {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using Acceptor = asio::basic_socket_acceptor<asio::generic::stream_protocol>;

constexpr int kBacklog = 128;
constexpr auto kPauseAfterError = std::chrono::milliseconds(100);

Error ListenError(const Address& address, const error_code& error) {
  if (error == asio::error::address_in_use) {
    return Failure(address.Text() +
                   " is in use by another program; stop that one or choose another port");
  }
  if (error == boost::system::errc::address_not_available) {
    return Failure("cannot listen on " + address.Text() + ": this host has no address " +
                   address.host + "; list its addresses with: ip address");
  }
  return Failure("cannot listen on " + address.Text() + ": " + MessageOf(error));
}

}  // namespace

class Listener::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(asio::io_context& io, Address address, std::function<void(Socket)> on_accept,
                 const ListenSecurity& security)
      : address_(std::move(address)),
        acceptor_(io),
        pause_(io),
        on_accept_(std::move(on_accept)),
        security_(security) {}

  Result<void> Open() {
    if (address_.kind == Address::Kind::kTls) {
      if (auto prepared = PrepareTls(); !prepared) return prepared;
    }
    if (const auto checked = CheckEncrypted(address_, security_.insecure_lan); !checked) {
      return security_.tls ? checked.error() : NoTls();
    }
    if (address_.kind == Address::Kind::kPassed) return TakePassed();
    MakeRunFolderFor(address_);
    if (auto checked = CheckFolderOf(address_); !checked) return checked;
    const Result<Endpoint> endpoint = EndpointOf(address_);
    if (!endpoint) return endpoint.error();
    if (address_.OverTcp()) return OpenTcp(*endpoint);
    auto bound =
        BindWhereNobodyListens(address_.path, address_.Text(), [&] { return BindUnix(*endpoint); });
    return bound;
  }

  void Accept() {
    acceptor_.async_accept(
        [self = shared_from_this()](const error_code& error, PlainSocket socket) {
          if (self->closed_ || error == asio::error::operation_aborted) return;
          if (error) {
            self->AcceptLater();  // For example too many open files: it passes.
            return;
          }
          self->on_accept_(self->Accepted(std::move(socket)));
          if (!self->closed_) self->Accept();
        });
  }

  void Close() {
    if (closed_) return;
    closed_ = true;
    if (address_.kind == Address::Kind::kUnix) RemoveIfStill(address_.path, file_);
    error_code ignored;
    acceptor_.close(ignored);
    pause_.cancel();
  }

  const Address& address() const { return address_; }

 private:
  Error NoTls() const {
    return UsageError(
        "will not listen on " + address_.Text() +
        ": connections beyond this host need TLS, which this socket does not have; listen on "
        "unix:PATH, and connect from other machines with ssh -L");
  }

  Result<void> PrepareTls() {
    if (!security_.tls) return NoTls();
    auto context = security_.tls();
    if (!context) return context.error();
    tls_ = std::move(context).value();
    return {};
  }

  Socket Accepted(PlainSocket plain) const {
    if (address_.kind != Address::Kind::kTls) return Socket(std::move(plain));
    error_code ignored;  // It would block: seen at once.
    plain.non_blocking(true, ignored);
    auto channel = tls_->Accept(plain.native_handle());
    return Socket(std::move(plain), std::move(channel));
  }

  /// The service manager opened it, and keeps it while this program restarts.
  Result<void> TakePassed() {
    const int passed = service_manager::PassedSocket(address_.path);
    sockaddr_storage name{};
    socklen_t size = sizeof(name);
    if (passed < 0 || getsockname(passed, reinterpret_cast<sockaddr*>(&name), &size) != 0) {
      return UsageError("no socket was passed under the name " + address_.path +
                        "; start by the socket unit, or listen on unix:PATH");
    }
    const bool over_tcp = name.ss_family == AF_INET || name.ss_family == AF_INET6;
    if (over_tcp && !security_.passed_in_clear) {
      if (auto prepared = PrepareTls(); !prepared) return prepared;
    } else if (!over_tcp && name.ss_family != AF_UNIX) {
      return UsageError("the socket passed as " + address_.path + " is neither Unix's nor TCP's");
    }
    // A copy: closing it must not close what the manager passed.
    const int own = fcntl(passed, F_DUPFD_CLOEXEC, 0);
    error_code error;
    acceptor_.assign(asio::generic::stream_protocol(name.ss_family, 0), own, error);
    if (own < 0 || error) return ListenError(address_, error);
    if (!over_tcp) return {};
    if (!security_.passed_in_clear) return TakeBound(Address::Kind::kTls);
    const std::string passed_as = address_.Text();
    if (const auto bound = TakeBound(Address::Kind::kTcp); !bound) return bound;
    if (StaysOnThisHost(address_)) return {};
    return UsageError("will not listen on " + address_.Text() + ", passed as " + passed_as +
                      ": it is not encrypted; let its socket unit listen on 127.0.0.1");
  }

  Result<void> OpenTcp(const Endpoint& endpoint) {
    error_code error;
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(kBacklog, error);
    if (error) return ListenError(address_, error);
    return TakeBound(address_.kind);
  }

  /// The address where it really listens.
  Result<void> TakeBound(Address::Kind kind) {
    error_code error;
    asio::ip::tcp::endpoint bound;
    const Endpoint local = acceptor_.local_endpoint(error);
    if (error) return ListenError(address_, error);
    std::memcpy(bound.data(), local.data(), local.size());
    if (address_.kind == Address::Kind::kPassed) address_.host = bound.address().to_string();
    address_.kind = kind;
    address_.port = bound.port();
    return {};
  }

  Result<void> BindUnix(const Endpoint& endpoint) {
    error_code error;
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (error) return ListenError(address_, error);
    file_ = IdentityOf(address_.path);
    constexpr mode_t kOwnerAndGroup = S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP;
    if (chmod(address_.path.c_str(), kOwnerAndGroup) != 0) {
      return Failure(address_.Text() + ": cannot set its mode: " + std::strerror(errno));
    }
    acceptor_.listen(kBacklog, error);
    if (error) return ListenError(address_, error);
    return {};
  }

  void AcceptLater() {
    pause_.After(kPauseAfterError, [self = shared_from_this()] {
      if (!self->closed_) self->Accept();
    });
  }

  Address address_;
  Acceptor acceptor_;
  timer::Timer pause_;
  std::function<void(Socket)> on_accept_;
  FileIdentity file_;
  const ListenSecurity security_;
  std::optional<tls::Context> tls_;
  bool closed_ = false;
};

Result<std::unique_ptr<Listener>> Listener::Open(asio::io_context& io, const Address& address,
                                                 std::function<void(Socket)> on_accept,
                                                 const ListenSecurity& security) {
  auto implementation =
      std::make_shared<Implementation>(io, address, std::move(on_accept), security);
  if (auto opened = implementation->Open(); !opened) {
    implementation->Close();
    return opened.error();
  }
  implementation->Accept();
  return std::unique_ptr<Listener>(new Listener(std::move(implementation)));
}

Listener::Listener(std::shared_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Listener::~Listener() { implementation_->Close(); }
const Address& Listener::address() const { return implementation_->address(); }
void Listener::Close() { implementation_->Close(); }

}  // namespace footing::transport
