#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <google/protobuf/arena.h>

#include "common/base/result.h"
#include "common/net/admission.h"
#include "common/net/limits.h"
#include "common/net/socket.h"
#include "common/net/turn_queue.h"
#include "footing/v1/session.pb.h"

/// How messages are cut out of a byte stream: u32 little-endian length, then that many bytes.
namespace footing::transport {

inline constexpr std::size_t kLengthBytes = 4;

/// Length of a frame to the bytes in front of it, and back.
std::array<char, kLengthBytes> EncodeLength(std::uint32_t length);
std::uint32_t DecodeLength(const char* bytes);

/// One frame: length and payload in one string. The payload is shorter than 4 GiB.
std::string Frame(std::string_view payload);

/// Cuts frames out of the bytes as they arrive.
///
/// A declared length over the limit is refused as soon as its four bytes are there: nothing is
/// allocated for it. What is kept between calls is at most one incomplete frame, and never more
/// than has arrived.
class FrameSplitter {
 public:
  explicit FrameSplitter(std::uint32_t max_payload_bytes) : max_(max_payload_bytes) {}

  /// Calls `on_frame` for every complete frame, in order; it returns false to stop behind that
  /// frame. The view is valid during the call only. Returns how many bytes were taken: all of them
  /// unless it was stopped; the rest may be fed again. InvalidData for a length over the limit;
  /// nothing may be fed after that.
  Result<std::size_t> Feed(std::string_view bytes,
                           const std::function<bool(std::string_view)>& on_frame);

  /// Bytes of a frame that has begun and is not complete.
  std::size_t pending_bytes() const { return pending_.size(); }

 private:
  std::size_t Missing() const;
  Result<void> CheckLength(std::string_view frame) const;

  std::uint32_t max_;
  std::string pending_;
};

/// Every message is parsed into one block, again and again: a tick has dozens of small parts, and
/// fetching them from all over the heap takes longer than parsing them.
class MessageParser {
 public:
  MessageParser() : arena_(block_.data(), block_.size()) {}

  /// Valid until the next one or Discard(); null for bytes that are not a message.
  const v1::Envelope* Parse(std::string_view payload) {
    if (parsed_) Discard();
    parsed_ = true;
    const bool good = message_->ParseFromArray(payload.data(), static_cast<int>(payload.size()));
    return good ? message_ : nullptr;
  }

  /// Drops the message. Whoever calls this once the message is handled gets the next one sooner,
  /// which then finds the block empty.
  void Discard() {
    arena_.Reset();
    message_ = NewMessage();
    parsed_ = false;
  }

 private:
  v1::Envelope* NewMessage() {
    return google::protobuf::Arena::CreateMessage<v1::Envelope>(&arena_);
  }

  /// Enough for a tick of eight devices; a longer message takes more from the heap.
  static constexpr std::size_t kArenaBytes = 32 << 10;

  std::vector<char> block_ = std::vector<char>(kArenaBytes);
  google::protobuf::Arena arena_;
  v1::Envelope* message_ = NewMessage();
  bool parsed_ = false;
};

/// Limits of one connection, bytes and frames.
struct FramedLimits {
  std::uint32_t max_in_bytes = 64u << 10;  ///< A longer announced frame ends the connection.
  std::uint32_t max_out_bytes = 1u << 20;
  std::size_t max_queued_bytes = 1u << 20;  ///< Limit for Send(), without the kernel's buffer.
  std::size_t max_queued_frames = 1024;
  double linger_s = 1;  ///< How long Finish() waits for the other side to take the last bytes.
  /// Who sends more is read no more until it has waited: nothing of it is lost, it is slowed.
  InputBudget input = {};
};

/// Calls that a connection makes.
struct FramedHandlers {
  /// One frame's payload, valid during the call.
  std::function<void(std::string_view payload)> on_frame;
  /// Once, when the connection is over, with one line that says why. Never from within a call to
  /// this class. Not called after Close().
  std::function<void(const std::string& reason)> on_close;
  /// Optional: called when nothing of Send() waits and the socket takes more; may add whole frames
  /// to the batch. Adding none means there is nothing to send.
  std::function<void(WriteBatch& batch)> on_writable;
  /// Optional: bytes have just arrived; the frames that they complete follow.
  std::function<void()> on_bytes;
  /// Optional: a frame over the limit was announced, or bytes in clear came where TLS is spoken.
  /// May Finish() with a last word.
  std::function<void(const std::string& why)> on_bad_input;
  /// Optional: the budget of input is used up, and nothing is read for `wait_s`.
  std::function<void(double wait_s)> on_slowed = {};
  /// Optional: the certificate of the other side was refused. on_close follows.
  std::function<void(const std::string& why)> on_untrusted = {};
};

/// A connection that carries frames (u32 little-endian length, payload) both ways, with bounded
/// memory. Everything runs on the io_context's one thread.
///
/// Writes go to the socket at once when it takes them; only what it does not take is queued. Over
/// TLS the handshake comes first, from Start() on; what is sent before waits for it.
class FramedConnection {
 public:
  /// A socket of Listener or Dial; it is made ready here (see Prepare).
  FramedConnection(Socket socket, const FramedLimits& limits, FramedHandlers handlers,
                   SharedLoop loop = {});
  ~FramedConnection();
  FramedConnection(const FramedConnection&) = delete;
  FramedConnection& operator=(const FramedConnection&) = delete;

  /// Begins to read.
  void Start();

  /// Queues one frame. False, and nothing queued, when it is over the limit, the queue is full or
  /// the connection is over: the caller decides whether that matters.
  bool Send(std::string_view payload);

  /// There is something for on_writable to fetch.
  void Wake();

  /// Counts the message being handled as that many more of the budget.
  void Charge(double messages);

  /// Sends what is queued and one last frame (none if empty; on_writable is asked no more), then
  /// closes; at the latest after linger_s. on_close gets `reason`.
  void Finish(std::string_view last_payload, const std::string& reason);

  /// Closes at once; no handler is called any more. The destructor does the same.
  void Close();

  bool open() const;
  std::size_t queued_bytes() const;
  /// Within TLS.
  bool secured() const;
  /// Fingerprint of the certificate that the other side showed in TLS; empty without one.
  std::string peer_fingerprint() const;
  /// For SO_PEERCRED and the like.
  int native_handle();
  Socket::executor_type executor();

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

/// Frames that wait to be written, oldest first.
class Outbox {
 public:
  void Add(std::string_view payload) {
    bytes_ += payload.size();
    frames_.push_back(Frame(payload));
  }

  /// As many as the batch has space for.
  void MoveTo(WriteBatch& batch) {
    while (!frames_.empty() && batch.free_buffers() > 0) {
      bytes_ -= frames_.front().size() - kLengthBytes;
      batch.AddOwned(std::move(frames_.front()));
      frames_.pop_front();
    }
  }

  bool empty() const { return frames_.empty(); }
  std::size_t frames() const { return frames_.size(); }
  /// Bytes of their payloads.
  std::size_t bytes() const { return bytes_; }

 private:
  std::deque<std::string> frames_;
  std::size_t bytes_ = 0;
};

}  // namespace footing::transport
