#include "common/transport/listener.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "common/service_manager/service_manager.h"
#include "common/timer/timer.h"
#include "common/transport/run_folder.h"
#include "common/transport/unix_socket_file.h"

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
  return Failure("cannot listen on " + address.Text() + ": " + MessageOf(error));
}

}  // namespace

class Listener::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(asio::io_context& io, Address address, std::function<void(Socket)> on_accept,
                 bool insecure_lan)
      : address_(std::move(address)),
        acceptor_(io),
        pause_(io),
        on_accept_(std::move(on_accept)),
        insecure_lan_(insecure_lan) {}

  Result<void> Open() {
    if (!StaysOnThisHost(address_) && !insecure_lan_) {
      return UsageError("will not listen on " + address_.Text() +
                        ": beyond this host a connection must be encrypted, and this version "
                        "cannot do that; use tcp:127.0.0.1:PORT and carry it with ssh -L, or, in a "
                        "network that you trust wholly, --insecure-lan with a token_file");
    }
    if (address_.kind == Address::Kind::kPassed) return TakePassed();
    if (auto checked = CheckFolderOf(address_); !checked) return checked;
    const Result<Endpoint> endpoint = EndpointOf(address_);
    if (!endpoint) return endpoint.error();
    if (address_.kind == Address::Kind::kTcp) return OpenTcp(*endpoint);
    auto bound =
        BindWhereNobodyListens(address_.path, address_.Text(), [&] { return BindUnix(*endpoint); });
    return bound;
  }

  void Accept() {
    acceptor_.async_accept([self = shared_from_this()](const error_code& error, Socket socket) {
      if (self->closed_ || error == asio::error::operation_aborted) return;
      if (error) {
        self->AcceptLater();  // For example too many open files: it passes.
        return;
      }
      self->on_accept_(std::move(socket));
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
  /// The service manager opened it, and keeps it while this program restarts.
  Result<void> TakePassed() {
    const int passed = service_manager::PassedSocket(address_.path);
    sockaddr_storage name{};
    socklen_t size = sizeof(name);
    if (passed < 0 || getsockname(passed, reinterpret_cast<sockaddr*>(&name), &size) != 0) {
      return UsageError("no socket was passed under the name " + address_.path +
                        "; start by the socket unit, or listen on unix:PATH");
    }
    if (name.ss_family != AF_UNIX) {
      return UsageError("the socket passed as " + address_.path +
                        " is not a Unix socket; beyond this host nothing is encrypted yet");
    }
    // A copy: closing it must not close what the manager passed.
    const int own = fcntl(passed, F_DUPFD_CLOEXEC, 0);
    error_code error;
    acceptor_.assign(asio::generic::stream_protocol(AF_UNIX, 0), own, error);
    if (own < 0 || error) return ListenError(address_, error);
    return {};
  }

  Result<void> OpenTcp(const Endpoint& endpoint) {
    error_code error;
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(kBacklog, error);
    if (error) return ListenError(address_, error);
    asio::ip::tcp::endpoint bound;
    const Endpoint local = acceptor_.local_endpoint(error);
    if (error) return ListenError(address_, error);
    std::memcpy(bound.data(), local.data(), local.size());
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
    pause_.expires_after(kPauseAfterError);
    pause_.async_wait([self = shared_from_this()](const error_code& error) {
      if (!error && !self->closed_) self->Accept();
    });
  }

  Address address_;
  Acceptor acceptor_;
  timer::Timer pause_;
  std::function<void(Socket)> on_accept_;
  FileIdentity file_;
  const bool insecure_lan_;
  bool closed_ = false;
};

Result<std::unique_ptr<Listener>> Listener::Open(asio::io_context& io, const Address& address,
                                                 std::function<void(Socket)> on_accept,
                                                 bool insecure_lan) {
  auto implementation =
      std::make_shared<Implementation>(io, address, std::move(on_accept), insecure_lan);
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
