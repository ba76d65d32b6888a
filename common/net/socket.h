#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <sys/types.h>
#include <boost/asio/buffer.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/tls_channel.h"
#include "common/runtime/timer.h"

/// One socket type for Unix, TCP and TLS, so that everything above shares its code.
namespace footing::transport {

using PlainSocket = boost::asio::generic::stream_protocol::socket;
using Endpoint = boost::asio::generic::stream_protocol::endpoint;

/// A connected stream of bytes, in clear or within TLS. Until the TLS handshake is done nothing can
/// be read or written. Not moved once something waits on it.
class Socket {
 public:
  using executor_type = PlainSocket::executor_type;
  using error_code = boost::system::error_code;

  explicit Socket(PlainSocket plain) : plain_(std::move(plain)) {}
  /// `on_proved` is called once the handshake is done, with the other side's fingerprint; what it
  /// returns, if not empty, is why the connection fails all the same.
  Socket(PlainSocket plain, std::unique_ptr<tls::Channel> tls,
         std::function<std::string(const std::string& fingerprint)> on_proved = {})
      : plain_(std::move(plain)), tls_(std::move(tls)), on_proved_(std::move(on_proved)) {}

  executor_type get_executor() { return plain_.get_executor(); }
  int native_handle() { return plain_.native_handle(); }
  /// For what needs no TLS, such as a baseline.
  PlainSocket& plain() { return plain_; }

  bool secured() const { return tls_ != nullptr; }
  /// Fingerprint of the certificate that the other side showed; empty without one.
  std::string peer_fingerprint() const { return tls_ ? tls_->peer_fingerprint() : ""; }

  bool needs_handshake() const { return tls_ && !tls_->ready(); }
  /// Each step of the handshake is given to `in_turn`, which calls it, now or later; `done` gets
  /// kDone, kNotTls or kFailed.
  void AsyncHandshake(std::function<void(std::function<void()> step)> in_turn,
                      std::function<void(tls::Progress)> done);
  /// After kNotTls: goes on in clear; the bytes that came are lost.
  void GoOnInClear() { tls_.reset(); }
  /// After kFailed.
  const tls::Channel& channel() const { return *tls_; }
  /// Calls `handler` with an error_code when the socket can be read, or written.
  template <typename Handler>
  void AsyncWait(tls::Progress wanted, Handler handler) {
    plain_.async_wait(
        wanted == tls::Progress::kWantsWrite ? PlainSocket::wait_write : PlainSocket::wait_read,
        std::move(handler));
  }

  /// Calls `handler` with an error_code and a count of bytes.
  template <typename Handler>
  void AsyncReadSome(boost::asio::mutable_buffer buffer, Handler handler) {
    if (!tls_) return plain_.async_read_some(buffer, std::move(handler));
    if (!tls_->has_more()) return ReadWhenReadable(buffer, std::move(handler));
    boost::asio::post(plain_.get_executor(),
                      [this, buffer, handler = std::move(handler)]() mutable {
                        ReadNow(buffer, std::move(handler));
                      });
  }

  /// Writes some of the buffers at once; would_block when the socket takes nothing. The buffers
  /// that were not taken must be the first ones of the next call.
  std::size_t WriteSome(std::span<const boost::asio::const_buffer> buffers, error_code& error);

  /// Nothing more will be written.
  void SayNoMore();
  void Close();

 private:
  template <typename Handler>
  void ReadWhenReadable(boost::asio::mutable_buffer buffer, Handler handler) {
    AsyncWait(tls::Progress::kWantsRead,
              [this, buffer, handler = std::move(handler)](const error_code& error) mutable {
                if (error) return handler(error, 0);
                ReadNow(buffer, std::move(handler));
              });
  }

  template <typename Handler>
  void ReadNow(boost::asio::mutable_buffer buffer, Handler handler) {
    error_code error;
    const std::size_t taken = ReadSome(buffer, error);
    if (error == boost::asio::error::would_block)
      return ReadWhenReadable(buffer, std::move(handler));
    handler(error, taken);
  }

  std::size_t ReadSome(boost::asio::mutable_buffer buffer, error_code& error);
  tls::Progress StepHandshake();

  PlainSocket plain_;
  std::unique_ptr<tls::Channel> tls_;
  std::function<std::string(const std::string& fingerprint)> on_proved_;
};

/// The address as the kernel takes it. "localhost" is 127.0.0.1; other hosts must be numeric, so
/// that no name server is asked. Usage error otherwise.
Result<Endpoint> EndpointOf(const Address& address);

/// True for a Unix socket and for 127.0.0.0/8 and ::1.
bool StaysOnThisHost(const Address& address);

/// Connects without blocking; `done` gets the socket or one line with the reason, for example
/// "unix:/run/x.sock: no such file"; over TCP it takes 3 s at most. `done` may be dropped with the
/// io_context. A TLS handshake is still to come (see FramedConnection); in it the server's
/// certificate is checked against what the user trusts (ServerTrust).
void Dial(boost::asio::io_context& io, const Address& address,
          std::function<void(Result<Socket>)> done);

/// Non-blocking, TCP_NODELAY, and a send buffer small enough that a slow reader's data do not wait
/// in the kernel where nobody can drop them.
void Prepare(Socket& socket);

/// Whether a timer that has just ended did so more than a second late: the program itself, or the
/// machine, stood still, and the silence meanwhile is nobody else's fault.
inline bool WasLate(const timer::Timer& timer) {
  return timer::Now() - timer.expiry() > std::chrono::seconds(1);
}

/// The system's words for an error, begun in lower case.
std::string MessageOf(const boost::system::error_code& error);

/// Why a connection is over after this error, perhaps within a frame.
std::string CloseReason(const boost::system::error_code& error, bool inside_frame);

// The file behind a Unix socket: whose it is, and when it may go.

/// Clears the way for a server at `path` and calls `bind` there, all under a lock on the folder, so
/// that two servers started at once cannot take each other's file. Only a socket that nobody
/// answers on is removed. `address_text` is for the error line.
Result<void> BindWhereNobodyListens(const std::string& path, const std::string& address_text,
                                    const std::function<Result<void>()>& bind);

/// Which file it is, so that at the end only the own one is removed.
struct FileIdentity {
  dev_t device = 0;
  ino_t inode = 0;
};
FileIdentity IdentityOf(const std::string& path);
void RemoveIfStill(const std::string& path, const FileIdentity& identity);

}  // namespace footing::transport
