#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace footing::tls {

/// The first bytes that a server reads: the header of a TLS record and that of the ClientHello in
/// it. They say whether the other side speaks TLS at all, and how long its first message is, before
/// anything is allocated for it.
class FirstBytes {
 public:
  static constexpr std::size_t kSize = 9;
  /// A ClientHello has some hundred bytes, and fits in one record.
  static constexpr std::size_t kLongestClientHello = 16u << 10;

  enum class Verdict {
    kMore,     ///< Not all are there yet.
    kTls,      ///< A ClientHello of a length that is accepted.
    kNotTls,   ///< Something else: the other side sends in clear.
    kTooLong,  ///< It announces a ClientHello over the limit, or in pieces that hide its length.
  };

  /// Where the next ones go; as many as are missing.
  char* next() { return bytes_.data() + size_; }
  std::size_t missing() const { return kSize - size_; }
  void Add(std::size_t bytes) { size_ += bytes; }
  std::string_view bytes() const { return {bytes_.data(), size_}; }

  Verdict Check() const;

 private:
  std::array<char, kSize> bytes_{};
  std::size_t size_ = 0;
};

}  // namespace footing::tls

struct bio_st;  // OpenSSL's BIO,
struct ssl_st;  // SSL,
struct ssl_ctx_st;

namespace footing::tls {

/// How far one call came.
enum class Progress {
  kDone,
  kWantsRead,   ///< Again when the socket can be read.
  kWantsWrite,  ///< Again when it can be written.
  kEnded,       ///< The other side ended the connection.
  kNotTls,      ///< Server only: the other side sends in clear; first_bytes() has what it sent.
  kFailed,      ///< problem() says why.
};

/// TLS over a connected, non-blocking socket. It never blocks, and does what the socket allows now;
/// who owns the socket waits for it and calls again.
class Channel {
 public:
  /// See Context.
  Channel(std::shared_ptr<ssl_ctx_st> shared, int socket, bool is_server,
          std::function<std::string(const std::string&)> check);
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  /// Until it is done nothing can be read or written.
  Progress Handshake();
  /// After it: the certificate is not accepted all the same, and nothing is read or written.
  Progress Distrust(const std::string& why);
  bool ready() const { return ready_; }

  /// Up to `size` bytes, at least one when it is done.
  Progress Read(char* bytes, std::size_t size, std::size_t& taken);
  /// Whether Read() has something without looking at the socket.
  bool has_more() const;

  /// Sends at most one record (16 KiB). After kWantsWrite it must be called with the same bytes;
  /// more may follow them.
  Progress Write(const char* bytes, std::size_t size, std::size_t& taken);

  /// Says that nothing more will be written, if the socket takes it.
  void SayNoMore();

  /// A line without the address, after kFailed.
  const std::string& problem() const { return problem_; }
  /// The certificate of the other side was refused: trying again does not help.
  bool untrusted() const { return untrusted_; }
  /// Fingerprint of the certificate that the other side showed, and proved to own; empty when it
  /// showed none.
  const std::string& peer_fingerprint() const { return peer_fingerprint_; }
  std::string_view first_bytes() const { return first_.bytes(); }

  // For OpenSSL's calls only.
  bool CheckPeer(const std::string& fingerprint);
  long ReadSocket(char* bytes, std::size_t size);
  long WriteSocket(const char* bytes, std::size_t size);
  bool at_end() const { return at_end_; }

 private:
  std::optional<Progress> LookAtFirstBytes();
  bool Open();
  Progress Outcome(int result);
  std::string ProblemOf(unsigned long error) const;

  std::shared_ptr<ssl_ctx_st> shared_;
  const int socket_;
  const bool is_server_;
  std::function<std::string(const std::string&)> check_;
  std::unique_ptr<ssl_st, void (*)(ssl_st*)> ssl_;  ///< Made when the other side has begun.
  FirstBytes first_;
  std::size_t first_taken_ = 0;
  bool at_end_ = false;
  bool ready_ = false;
  bool untrusted_ = false;
  std::string problem_;
  std::string peer_fingerprint_;
};

}  // namespace footing::tls
