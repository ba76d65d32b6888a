#include "common/net/tls_channel.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <sys/socket.h>

namespace footing::tls {
namespace {

// RFC 8446, 5.1 and 4: a record is type, version (3, 1 to 3), length; a handshake message type and
// length of three bytes, the highest first.
constexpr unsigned kHandshakeRecord = 22;
constexpr unsigned kMajorVersion = 3;
constexpr unsigned kClientHello = 1;
constexpr std::size_t kHandshakeHeaderBytes = 4;

}  // namespace

FirstBytes::Verdict FirstBytes::Check() const {
  const auto at = [this](std::size_t i) { return static_cast<unsigned char>(bytes_[i]); };
  if (size_ > 0 && at(0) != kHandshakeRecord) return Verdict::kNotTls;
  if (size_ > 1 && at(1) != kMajorVersion) return Verdict::kNotTls;
  // In a frame of ours this is the third byte of a length that is accepted: 0.
  if (size_ > 2 && at(2) == 0) return Verdict::kNotTls;
  if (size_ < kSize) return Verdict::kMore;
  const std::size_t record = (std::size_t{at(3)} << 8) | at(4);
  const std::size_t message =
      (std::size_t{at(6)} << 16) | (std::size_t{at(7)} << 8) | std::size_t{at(8)};
  if (record < kHandshakeHeaderBytes) return Verdict::kTooLong;
  if (at(5) != kClientHello) return Verdict::kNotTls;
  return message > kLongestClientHello ? Verdict::kTooLong : Verdict::kTls;
}

namespace {

/// Bytes to and from the socket. OpenSSL's own BIO for sockets would end the program by SIGPIPE
/// when the other side is gone.
int BioRead(BIO* bio, char* bytes, int size) {
  BIO_clear_retry_flags(bio);
  const long got =
      static_cast<Channel*>(BIO_get_data(bio))->ReadSocket(bytes, static_cast<std::size_t>(size));
  if (got < 0 && errno == EAGAIN) BIO_set_retry_read(bio);
  return static_cast<int>(got);
}

int BioWrite(BIO* bio, const char* bytes, int size) {
  BIO_clear_retry_flags(bio);
  const long put =
      static_cast<Channel*>(BIO_get_data(bio))->WriteSocket(bytes, static_cast<std::size_t>(size));
  if (put < 0 && errno == EAGAIN) BIO_set_retry_write(bio);
  return static_cast<int>(put);
}

long BioControl(BIO* bio, int command, long, void*) {
  if (command == BIO_CTRL_EOF) return static_cast<Channel*>(BIO_get_data(bio))->at_end() ? 1 : 0;
  return command == BIO_CTRL_FLUSH ? 1 : 0;
}

const BIO_METHOD* SocketMethod() {
  static const BIO_METHOD* const kMethod = [] {
    BIO_METHOD* const method = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "footing");
    BIO_meth_set_read(method, BioRead);
    BIO_meth_set_write(method, BioWrite);
    BIO_meth_set_ctrl(method, BioControl);
    return method;
  }();
  return kMethod;
}

/// Before each call of OpenSSL whose outcome is asked for: what is left of earlier ones would be
/// taken for its.
void Begin() {
  ERR_clear_error();
  errno = 0;
}

}  // namespace

Channel::Channel(std::shared_ptr<SSL_CTX> shared, int socket, bool is_server,
                 std::function<std::string(const std::string&)> check)
    : shared_(std::move(shared)),
      socket_(socket),
      is_server_(is_server),
      check_(std::move(check)),
      ssl_(nullptr, SSL_free) {}

Channel::~Channel() = default;

Progress Channel::Handshake() {
  if (ready_) return Progress::kDone;
  if (!ssl_) {
    if (const auto not_yet = LookAtFirstBytes()) return *not_yet;
    if (!Open()) {
      problem_ = "OpenSSL cannot begin a TLS connection";
      return Progress::kFailed;
    }
  }
  Begin();
  const Progress progress = Outcome(SSL_do_handshake(ssl_.get()));
  ready_ = progress == Progress::kDone;
  if (progress == Progress::kEnded) {
    problem_ = "the other side closed the connection during the TLS handshake";
    return Progress::kFailed;
  }
  return progress;
}

Progress Channel::Distrust(const std::string& why) {
  ready_ = false;
  untrusted_ = true;
  problem_ = why;
  return Progress::kFailed;
}

/// Checks the first bytes as a server, before it makes anything of OpenSSL's.
std::optional<Progress> Channel::LookAtFirstBytes() {
  while (is_server_) {
    switch (first_.Check()) {
      case FirstBytes::Verdict::kTls:
        return std::nullopt;
      case FirstBytes::Verdict::kNotTls:
        return Progress::kNotTls;
      case FirstBytes::Verdict::kTooLong:
        problem_ = "the other side announced a ClientHello that is too long";
        return Progress::kFailed;
      case FirstBytes::Verdict::kMore:
        break;
    }
    const ssize_t got = recv(socket_, first_.next(), first_.missing(), 0);
    if (got > 0) {
      first_.Add(static_cast<std::size_t>(got));
    } else if (got < 0 && errno == EAGAIN) {
      return Progress::kWantsRead;
    } else if (got == 0 || errno != EINTR) {
      problem_ = "the other side closed the connection before the TLS handshake";
      return Progress::kFailed;
    }
  }
  return std::nullopt;
}

bool Channel::Open() {
  ssl_.reset(SSL_new(shared_.get()));
  BIO* const bio = ssl_ ? BIO_new(SocketMethod()) : nullptr;
  if (bio == nullptr) return false;
  BIO_set_data(bio, this);
  BIO_set_init(bio, 1);
  SSL_set_bio(ssl_.get(), bio, bio);
  SSL_set_app_data(ssl_.get(), this);
  if (is_server_) {
    SSL_set_accept_state(ssl_.get());
  } else {
    SSL_set_connect_state(ssl_.get());
  }
  return true;
}

Progress Channel::Read(char* bytes, std::size_t size, std::size_t& taken) {
  Begin();
  return Outcome(SSL_read_ex(ssl_.get(), bytes, size, &taken));
}

bool Channel::has_more() const { return SSL_has_pending(ssl_.get()) == 1; }

Progress Channel::Write(const char* bytes, std::size_t size, std::size_t& taken) {
  Begin();
  return Outcome(SSL_write_ex(ssl_.get(), bytes, size, &taken));
}

void Channel::SayNoMore() {
  if (!ready_) return;
  Begin();
  SSL_shutdown(ssl_.get());  // If it cannot, the end of the socket says the same.
}

bool Channel::CheckPeer(const std::string& fingerprint) {
  peer_fingerprint_ = fingerprint;
  if (!check_) return true;
  problem_ = check_(fingerprint);
  untrusted_ = !problem_.empty();
  return !untrusted_;
}

long Channel::ReadSocket(char* bytes, std::size_t size) {
  const std::string_view first = first_.bytes().substr(first_taken_);
  if (!first.empty()) {
    const std::size_t count = std::min(size, first.size());
    std::copy_n(first.data(), count, bytes);
    first_taken_ += count;
    return static_cast<long>(count);
  }
  while (true) {
    const ssize_t got = recv(socket_, bytes, size, 0);
    at_end_ = got == 0;
    if (got >= 0 || errno != EINTR) return got;
  }
}

long Channel::WriteSocket(const char* bytes, std::size_t size) {
  while (true) {
    const ssize_t put = send(socket_, bytes, size, MSG_NOSIGNAL);
    if (put >= 0 || errno != EINTR) return put;
  }
}

Progress Channel::Outcome(int result) {
  if (result == 1) return Progress::kDone;
  const int from_socket = errno;
  switch (SSL_get_error(ssl_.get(), result)) {
    case SSL_ERROR_WANT_READ:
      return Progress::kWantsRead;
    case SSL_ERROR_WANT_WRITE:
      return Progress::kWantsWrite;
    case SSL_ERROR_ZERO_RETURN:
      return Progress::kEnded;
    case SSL_ERROR_SYSCALL:
      if (from_socket == 0) return Progress::kEnded;
      problem_ = std::strerror(from_socket);
      return Progress::kFailed;
    default:
      if (!untrusted_) problem_ = ProblemOf(ERR_peek_error());
      ERR_clear_error();
      return Progress::kFailed;
  }
}

std::string Channel::ProblemOf(unsigned long error) const {
  switch (ERR_GET_REASON(error)) {
    case SSL_R_WRONG_VERSION_NUMBER:
    case SSL_R_PACKET_LENGTH_TOO_LONG:
    case SSL_R_UNEXPECTED_MESSAGE:
    case SSL_R_BAD_RECORD_TYPE:
      if (!is_server_ && !ready_) {
        return "the other side does not speak TLS; if it listens on tcp:, connect with tcp:";
      }
      break;
    case SSL_R_UNSUPPORTED_PROTOCOL:
    case SSL_R_TLSV1_ALERT_PROTOCOL_VERSION:
      return "the other side does not speak TLS 1.3";
    default:
      break;
  }
  const char* const reason = ERR_reason_error_string(error);
  return std::string("TLS failed: ") + (reason == nullptr ? "unknown reason" : reason);
}

}  // namespace footing::tls
