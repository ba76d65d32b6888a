#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "common/net/input_pace.h"
#include "common/net/shared_loop.h"
#include "common/net/socket.h"
#include "common/net/write_batch.h"

namespace footing::transport {

struct FramedLimits {
  std::uint32_t max_in_bytes = 64u << 10;  ///< A longer announced frame ends the connection.
  std::uint32_t max_out_bytes = 1u << 20;
  std::size_t max_queued_bytes = 1u << 20;  ///< Of Send(); what waits in the kernel not counted.
  std::size_t max_queued_frames = 1024;
  double linger_s = 1;  ///< How long Finish() waits for the other side to take the last bytes.
  /// Who sends more is read no more until it has waited: nothing of it is lost, it is slowed.
  InputBudget input = {};
};

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
  /// Of the certificate that the other side showed in TLS; empty without one.
  std::string peer_fingerprint() const;
  /// For SO_PEERCRED and the like.
  int native_handle();
  Socket::executor_type executor();

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::transport
