#include "common/net/socket.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>

#include "common/net/address.h"
#include "common/net/client.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"

namespace footing::transport {
namespace {

namespace asio = boost::asio;

constexpr std::size_t kRecordBytes = 16 << 10;  // The most in one TLS record.

asio::ip::address NumericHost(const Address& address, boost::system::error_code& error) {
  return asio::ip::make_address(address.host == "localhost" ? "127.0.0.1" : address.host, error);
}

/// The error of a TLS connection that works no more; nobody asks which one it is.
boost::system::error_code Broken(tls::Progress progress) {
  if (progress == tls::Progress::kEnded) return asio::error::eof;
  return boost::system::errc::make_error_code(boost::system::errc::protocol_error);
}

/// A connection that is being made. A host that is off does not even refuse, and the kernel would
/// try for two minutes, less and less often.
struct Dialling {
  explicit Dialling(asio::io_context& io) : socket(io), deadline(io) {}

  void SetDeadline() {
    deadline.After(std::chrono::seconds(3), [this] {
      late = true;
      boost::system::error_code ignored;
      socket.close(ignored);
    });
  }

  PlainSocket socket;
  timer::Timer deadline;
  bool late = false;
};

/// A connected socket with what its address asks for.
Result<Socket> Dialled(asio::io_context& io, PlainSocket plain, const Address& address) {
  if (address.kind != Address::Kind::kTls) return Socket(std::move(plain));
  const auto context = ClientContext(io);
  if (!context) return context.error();
  boost::system::error_code ignored;  // It would block: seen at once.
  plain.non_blocking(true, ignored);
  const auto trust = ServerTrust::Of(address);
  auto channel = context->Connect(plain.native_handle(), [trust](const std::string& fingerprint) {
    return trust->WhyRefused(fingerprint);
  });
  return Socket(std::move(plain), std::move(channel),
                [trust](const std::string& fingerprint) { return trust->OnProved(fingerprint); });
}

}  // namespace

void Socket::AsyncHandshake(std::function<void(std::function<void()>)> in_turn,
                            std::function<void(tls::Progress)> done) {
  in_turn([this, in_turn, done] {
    const tls::Progress progress = StepHandshake();
    if (progress != tls::Progress::kWantsRead && progress != tls::Progress::kWantsWrite) {
      return done(progress);
    }
    AsyncWait(progress, [this, in_turn, done](const error_code& error) {
      if (!error) AsyncHandshake(in_turn, done);
    });
  });
}

tls::Progress Socket::StepHandshake() {
  if (!plain_.is_open()) return tls::Progress::kFailed;  // Its descriptor may be another's by now.
  clock::Act();
  const tls::Progress progress = tls_->Handshake();
  if (progress != tls::Progress::kDone || !on_proved_) return progress;
  const std::string why_not = on_proved_(tls_->peer_fingerprint());
  return why_not.empty() ? progress : tls_->Distrust(why_not);
}

std::size_t Socket::WriteSome(std::span<const asio::const_buffer> buffers, error_code& error) {
  clock::Act();
  if (!tls_) return plain_.write_some(buffers, error);
  // A record is sealed as one piece: small buffers are put together.
  std::array<char, kRecordBytes> together;
  const char* bytes = static_cast<const char*>(buffers[0].data());
  std::size_t size = buffers[0].size();
  if (size < kRecordBytes / 4 && buffers.size() > 1) {
    size = 0;
    for (const asio::const_buffer& buffer : buffers) {
      const std::size_t count = std::min(buffer.size(), together.size() - size);
      std::memcpy(together.data() + size, buffer.data(), count);
      size += count;
      if (size == together.size()) break;
    }
    bytes = together.data();
  }
  std::size_t taken = 0;
  const tls::Progress progress = tls_->Write(bytes, size, taken);
  if (progress == tls::Progress::kDone) return taken;
  const bool later =
      progress == tls::Progress::kWantsWrite || progress == tls::Progress::kWantsRead;
  error = later ? error_code(asio::error::would_block) : Broken(progress);
  return 0;
}

std::size_t Socket::ReadSome(asio::mutable_buffer buffer, error_code& error) {
  std::size_t taken = 0;
  if (!plain_.is_open())
    error = asio::error::operation_aborted;  // Its descriptor may be another's.
  if (error) return 0;
  const tls::Progress progress =
      tls_->Read(static_cast<char*>(buffer.data()), buffer.size(), taken);
  if (progress == tls::Progress::kDone) return taken;
  const bool later =
      progress == tls::Progress::kWantsRead || progress == tls::Progress::kWantsWrite;
  error = later ? error_code(asio::error::would_block) : Broken(progress);
  return 0;
}

void Socket::SayNoMore() {
  clock::Act();
  if (tls_) tls_->SayNoMore();
  error_code ignored;  // It may be gone already.
  plain_.shutdown(PlainSocket::shutdown_send, ignored);
}

void Socket::Close() {
  clock::Act();
  error_code ignored;
  plain_.close(ignored);
}

Result<Endpoint> EndpointOf(const Address& address) {
  if (address.kind == Address::Kind::kUnix) {
    return Endpoint(asio::local::stream_protocol::endpoint(address.path));
  }
  if (address.kind == Address::Kind::kPassed) {
    return UsageError(address.Text() +
                      " is for listening; a client dials unix:PATH, tcp:HOST:PORT or "
                      "tls:HOST:PORT");
  }
  boost::system::error_code error;
  const asio::ip::address host = NumericHost(address, error);
  if (error) {
    return UsageError(address.Text() + ": \"" + address.host +
                      "\" is not a numeric address; write for example " +
                      (address.kind == Address::Kind::kTls ? "tls" : "tcp") +
                      ":127.0.0.1:" + std::to_string(address.port));
  }
  return Endpoint(asio::ip::tcp::endpoint(host, address.port));
}

bool StaysOnThisHost(const Address& address) {
  if (!address.OverTcp()) return true;
  boost::system::error_code error;
  const asio::ip::address host = NumericHost(address, error);
  return !error && host.is_loopback();
}

void Dial(asio::io_context& io, const Address& address, std::function<void(Result<Socket>)> done) {
  Result<Endpoint> endpoint = EndpointOf(address);
  if (const auto checked = CheckFolderOf(address); !checked) endpoint = checked.error();
  if (!endpoint) {
    asio::post(io, [done = std::move(done), error = endpoint.error()] { done(error); });
    return;
  }
  const auto dialling = std::make_shared<Dialling>(io);
  if (address.OverTcp()) dialling->SetDeadline();
  clock::Act();
  dialling->socket.async_connect(*endpoint, [&io, dialling, address, done = std::move(done)](
                                                const boost::system::error_code& error) {
    dialling->deadline.cancel();
    if (dialling->late) {
      done(Failure(address.Text() + ": no answer within 3 s"));
    } else if (error) {
      done(Failure(address.Text() + ": " + MessageOf(error)));
    } else {
      done(Dialled(io, std::move(dialling->socket), address));
    }
  });
}

void Prepare(Socket& prepared) {
  PlainSocket& socket = prepared.plain();
  constexpr int kSendBufferBytes = 128 << 10;
  boost::system::error_code ignored;  // Settings that only make it better.
  socket.non_blocking(true, ignored);
  socket.set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
}

std::string MessageOf(const boost::system::error_code& error) {
  if (error == boost::system::errc::no_such_file_or_directory) return "no such file";
  std::string words = error.message();
  if (!words.empty()) words[0] = static_cast<char>(std::tolower(words[0]));
  return words;
}

std::string CloseReason(const boost::system::error_code& error, bool inside_frame) {
  if (error != asio::error::eof) return "the connection broke: " + MessageOf(error);
  return inside_frame ? "the other side closed in the middle of a message"
                      : "the other side closed the connection";
}

namespace {

// Who holds a folder's lock is about to bind, which takes milliseconds: programs that are started
// together wait for each other, but for no longer than half a second.
constexpr int kLockTries = 50;
constexpr useconds_t kLockTryUs = 10'000;

/// An exclusive lock on a folder, for as long as it lives.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder)
      : folder_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (!folder_.is_open()) error_ = errno;
    for (int tries = 0; folder_.is_open(); ++tries) {
      error_ = flock(folder_.number(), LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
      if (error_ != EWOULDBLOCK || tries == kLockTries) break;
      usleep(kLockTryUs);
    }
  }
  int error() const { return error_; }

 private:
  config::FileDescriptor folder_;
  int error_ = 0;
};

/// 0 when somebody accepts connections there, otherwise the errno of connect(2).
int TryToConnect(const std::string& path) {
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0) return errno;
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::strncpy(name.sun_path, path.c_str(), sizeof(name.sun_path) - 1);
  const int failed =
      connect(descriptor, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0 ? 0 : errno;
  close(descriptor);
  return failed == EAGAIN ? 0 : failed;  // Its backlog is full: it lives.
}

Result<void> ClearTheWay(const std::string& path, const std::string& address_text) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return {};
  if (!S_ISSOCK(status.st_mode)) {
    return Failure(address_text + ": the file exists and is not a socket; choose another path");
  }
  const int failed = TryToConnect(path);
  if (failed == 0) {
    return Failure(address_text +
                   " is in use by another server; stop that one or choose another address");
  }
  if (failed != ECONNREFUSED) {
    return Failure(address_text + ": cannot find out whether another server uses it (" +
                   std::strerror(failed) + "); choose another path");
  }
  unlink(path.c_str());
  return {};
}

}  // namespace

Result<void> BindWhereNobodyListens(const std::string& path, const std::string& address_text,
                                    const std::function<Result<void>()>& bind) {
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  const FolderLock lock(folder);
  if (lock.error() == EWOULDBLOCK) {
    return Failure(address_text + ": another server is being started in " + folder + "; try again");
  }
  if (lock.error() != 0) {
    return Failure(address_text + ": folder " + folder + ": " + std::strerror(lock.error()) +
                   "; create it or choose another path");
  }
  if (auto cleared = ClearTheWay(path, address_text); !cleared) return cleared;
  return bind();
}

FileIdentity IdentityOf(const std::string& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino};
}

void RemoveIfStill(const std::string& path, const FileIdentity& identity) {
  const FileIdentity now = IdentityOf(path);
  if (now.inode != 0 && now.inode == identity.inode && now.device == identity.device) {
    unlink(path.c_str());
  }
}

}  // namespace footing::transport
