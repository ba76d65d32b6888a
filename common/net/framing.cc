#include "common/net/framing.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include <boost/asio/post.hpp>

#include "common/base/units.h"
#include "common/runtime/clock.h"
#include "common/runtime/timer.h"

namespace footing::transport {

std::array<char, kLengthBytes> EncodeLength(std::uint32_t length) {
  return {static_cast<char>(length & 0xff), static_cast<char>((length >> 8) & 0xff),
          static_cast<char>((length >> 16) & 0xff), static_cast<char>((length >> 24) & 0xff)};
}

std::uint32_t DecodeLength(const char* bytes) {
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < kLengthBytes; ++i) {
    length |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  return length;
}

std::string Frame(std::string_view payload) {
  const auto length = EncodeLength(static_cast<std::uint32_t>(payload.size()));
  std::string frame;
  frame.reserve(kLengthBytes + payload.size());
  frame.append(length.data(), length.size());
  frame.append(payload);
  return frame;
}

Result<void> FrameSplitter::CheckLength(std::string_view frame) const {
  const std::uint32_t length = DecodeLength(frame.data());
  if (length <= max_) return {};
  return InvalidData(
      "a message of " + std::to_string(length) + " bytes was announced, at most " +
      std::to_string(max_) +
      " are accepted; a message begins with its length as four bytes, little-endian: "
      "is the other side speaking Footing's protocol?");
}

std::size_t FrameSplitter::Missing() const {
  if (pending_.size() < kLengthBytes) return kLengthBytes - pending_.size();
  return kLengthBytes + DecodeLength(pending_.data()) - pending_.size();
}

Result<std::size_t> FrameSplitter::Feed(std::string_view bytes,
                                        const std::function<bool(std::string_view)>& on_frame) {
  const std::size_t offered = bytes.size();
  while (!pending_.empty()) {
    const std::size_t taken = std::min(Missing(), bytes.size());
    pending_.append(bytes.substr(0, taken));
    bytes.remove_prefix(taken);
    if (pending_.size() < kLengthBytes) return offered;
    if (auto checked = CheckLength(pending_); !checked) return checked.error();
    if (Missing() > 0) {
      if (bytes.empty()) return offered;
      continue;
    }
    const std::string frame = std::move(pending_);
    pending_.clear();
    if (!on_frame(std::string_view(frame).substr(kLengthBytes))) return offered - bytes.size();
  }
  while (bytes.size() >= kLengthBytes) {
    if (auto checked = CheckLength(bytes); !checked) return checked.error();
    const std::size_t whole = kLengthBytes + DecodeLength(bytes.data());
    if (bytes.size() < whole) break;
    const std::string_view frame = bytes.substr(kLengthBytes, whole - kLengthBytes);
    bytes.remove_prefix(whole);
    if (!on_frame(frame)) return offered - bytes.size();
  }
  pending_.assign(bytes);
  return offered;
}

namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr std::size_t kReadBytes = 16 << 10;
/// Batches written in one go before other connections get their turn.
constexpr int kBatchesInARow = 8;
/// Messages handled in one turn.
constexpr int kMessagesInATurn = 8;

}  // namespace

class FramedConnection::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(Socket socket, const FramedLimits& limits, FramedHandlers handlers,
                 SharedLoop loop)
      : socket_(std::move(socket)),
        linger_(socket_.get_executor()),
        slowed_(socket_.get_executor()),
        limits_(limits),
        handlers_(std::move(handlers)),
        splitter_(limits.max_in_bytes),
        pace_(limits.input),
        loop_(std::move(loop)) {
    Prepare(socket_);
  }

  void Start() { socket_.needs_handshake() ? ShakeHands() : Read(); }

  bool Send(std::string_view payload) {
    if (state_ != State::kOpen || payload.size() > limits_.max_out_bytes) return false;
    if (outbox_.frames() >= limits_.max_queued_frames) return false;
    if (outbox_.bytes() + payload.size() > limits_.max_queued_bytes) return false;
    outbox_.Add(payload);
    Write();
    return true;
  }

  void Wake() {
    if (state_ == State::kOpen) Write();
  }

  void Charge(double messages) { pace_.ChargeMessages(messages); }

  void Finish(std::string_view last_payload, const std::string& reason) {
    if (state_ != State::kOpen) return;
    state_ = State::kFinishing;
    reason_ = reason;
    if (!last_payload.empty()) outbox_.Add(last_payload);
    linger_.After(limits_.linger_s, [self = shared_from_this()] { self->End(self->reason_); });
    Write();
  }

  void Close() {
    silent_ = true;
    End("closed");
  }

  bool open() const { return state_ == State::kOpen; }
  std::size_t queued_bytes() const { return outbox_.bytes(); }
  bool secured() const { return socket_.secured(); }
  std::string peer_fingerprint() const { return socket_.peer_fingerprint(); }
  int native_handle() { return socket_.native_handle(); }
  Socket::executor_type executor() { return socket_.get_executor(); }

 private:
  enum class State { kOpen, kFinishing, kOver };

  /// A step costs as much as hundreds of messages, so it waits for its turn, too.
  void ShakeHands() {
    const auto self = shared_from_this();
    socket_.AsyncHandshake(
        [self](std::function<void()> step) { self->loop_.InTurn(self->executor(), step); },
        [self](tls::Progress progress) { self->OnHandshake(progress); });
  }

  void OnHandshake(tls::Progress progress) {
    if (state_ == State::kOver) return;
    if (progress == tls::Progress::kNotTls) {
      socket_.GoOnInClear();
      OnBadInput("this port speaks TLS: connect with tls:HOST:PORT");
    } else if (progress != tls::Progress::kDone) {
      const std::string problem = socket_.channel().problem();
      if (socket_.channel().untrusted() && handlers_.on_untrusted) handlers_.on_untrusted(problem);
      return End(state_ == State::kFinishing ? reason_ : problem);
    }
    Write();
    if (state_ != State::kOver) Read();
  }

  void Read() {
    socket_.AsyncReadSome(asio::buffer(input_),
                          [self = shared_from_this()](const error_code& error, std::size_t size) {
                            self->OnRead(error, size);
                          });
  }

  void OnRead(const error_code& error, std::size_t size) {
    if (state_ == State::kOver) return;
    if (error) {
      End(state_ == State::kFinishing ? reason_
                                      : CloseReason(error, splitter_.pending_bytes() > 0));
      return;
    }
    // While finishing, what still comes is read and thrown away: closing over unread bytes would
    // reset the connection and lose the last word.
    if (state_ == State::kOpen && handlers_.on_bytes) handlers_.on_bytes();
    if (state_ == State::kOver) return;
    pace_.ChargeBytes(size);
    unhandled_ = std::string_view(input_.data(), size);
    Handle();
  }

  void Handle() {
    if (loop_.turns) {
      return loop_.turns->Add([self = shared_from_this()] { return self->HandleSome(); });
    }
    while (HandleSome()) {
    }
  }

  /// Handles some of the messages that were read; true when there are more. Then it reads on.
  bool HandleSome() {
    if (state_ == State::kOver) return false;
    if (state_ == State::kOpen && !unhandled_.empty()) {
      if (pace_.limits() && Slow()) return false;
      int handled = 0;
      corked_ = loop_.turns != nullptr;  // Their answers leave together.
      Split([&] { return ++handled < kMessagesInATurn; });
      corked_ = false;
      if (loop_.turns && state_ != State::kOver) Write();
    }
    if (state_ == State::kOpen && !unhandled_.empty()) return true;
    if (state_ != State::kOver) Read();
    return false;
  }

  void Split(const std::function<bool()>& more) {
    const auto fed = splitter_.Feed(unhandled_, [&](std::string_view payload) {
      pace_.ChargeMessages(1);
      handlers_.on_frame(payload);
      return state_ == State::kOpen && more();
    });
    if (fed) return unhandled_.remove_prefix(*fed);
    unhandled_ = {};
    OnBadInput(fed.error().message);
  }

  void OnBadInput(const std::string& why) {
    if (state_ == State::kOpen && handlers_.on_bad_input) handlers_.on_bad_input(why);
    if (state_ == State::kOpen) End(why);
  }

  /// Whether the budget is used up; the rest is handled when there is some again.
  bool Slow() {
    const std::int64_t wait_ns = pace_.WaitNs(clock::MonotonicNs());
    if (wait_ns == 0) return false;
    slowed_.After(std::chrono::nanoseconds(wait_ns), [self = shared_from_this()] {
      if (self->state_ != State::kOver) self->Handle();
    });
    if (handlers_.on_slowed) handlers_.on_slowed(NanosecondsToSeconds(wait_ns));
    return true;
  }

  void Write() {
    if (waiting_ || writing_ || corked_ || socket_.needs_handshake()) return;
    writing_ = true;  // on_writable may call Wake() or Send().
    for (int batches = 0; state_ != State::kOver; ++batches) {
      if (!batch_) batch_ = loop_.pool->Take();
      if (batch_->empty()) Fill();
      if (batch_->empty()) break;
      if (batches == kBatchesInARow) {
        WriteLater();
        break;
      }
      error_code error;
      const std::size_t written = socket_.WriteSome(batch_->buffers(), error);
      if (error == asio::error::would_block) {
        WaitUntilWritable();
        break;
      }
      if (error) {
        End(state_ == State::kFinishing ? reason_ : CloseReason(error, false));
        break;
      }
      batch_->Consume(written);
    }
    writing_ = false;
    if (batch_ && batch_->empty()) loop_.pool->Give(std::move(batch_));
    if (state_ == State::kFinishing && !batch_ && outbox_.empty()) socket_.SayNoMore();
  }

  void Fill() {
    outbox_.MoveTo(*batch_);
    if (state_ == State::kOpen && batch_->free_buffers() > 0 && handlers_.on_writable) {
      handlers_.on_writable(*batch_);
    }
  }

  void WriteLater() {
    waiting_ = true;
    loop_.InTurn(executor(), [self = shared_from_this()] { self->WriteNow(); });
  }

  void WriteNow() {
    waiting_ = false;
    if (state_ != State::kOver) Write();
  }

  void WaitUntilWritable() {
    waiting_ = true;
    const auto wanted = tls::Progress::kWantsWrite;
    socket_.AsyncWait(wanted, [self = shared_from_this()](const error_code& error) {
      self->waiting_ = false;
      if (!error && self->state_ != State::kOver) self->WriteLater();
    });
  }

  void End(const std::string& reason) {
    if (state_ == State::kOver) return;
    state_ = State::kOver;
    linger_.cancel();
    slowed_.cancel();
    socket_.Close();
    asio::post(socket_.get_executor(), [self = shared_from_this(), reason] {
      // The handlers go too: they often hold the owner of this connection.
      FramedHandlers handlers = std::move(self->handlers_);
      self->handlers_ = {};
      if (!self->silent_ && handlers.on_close) handlers.on_close(reason);
    });
  }

  Socket socket_;
  timer::Timer linger_;
  timer::Timer slowed_;
  const FramedLimits limits_;
  FramedHandlers handlers_;
  FrameSplitter splitter_;
  InputPace pace_;
  std::string_view unhandled_;  ///< Part of input_ that is read, and not handled yet.
  Outbox outbox_;
  const SharedLoop loop_;
  std::unique_ptr<WriteBatch> batch_;  ///< While something waits to be written.
  State state_ = State::kOpen;
  bool waiting_ = false;
  bool writing_ = false;
  bool corked_ = false;
  bool silent_ = false;
  std::string reason_;
  std::array<char, kReadBytes> input_;
};

FramedConnection::FramedConnection(Socket socket, const FramedLimits& limits,
                                   FramedHandlers handlers, SharedLoop loop)
    : implementation_(std::make_shared<Implementation>(std::move(socket), limits,
                                                       std::move(handlers), std::move(loop))) {}
FramedConnection::~FramedConnection() { Close(); }
void FramedConnection::Start() { implementation_->Start(); }
bool FramedConnection::Send(std::string_view payload) { return implementation_->Send(payload); }
void FramedConnection::Wake() { implementation_->Wake(); }
void FramedConnection::Charge(double messages) { implementation_->Charge(messages); }
void FramedConnection::Finish(std::string_view last_payload, const std::string& reason) {
  implementation_->Finish(last_payload, reason);
}
void FramedConnection::Close() { implementation_->Close(); }
bool FramedConnection::open() const { return implementation_->open(); }
std::size_t FramedConnection::queued_bytes() const { return implementation_->queued_bytes(); }
bool FramedConnection::secured() const { return implementation_->secured(); }
std::string FramedConnection::peer_fingerprint() const {
  return implementation_->peer_fingerprint();
}
int FramedConnection::native_handle() { return implementation_->native_handle(); }
Socket::executor_type FramedConnection::executor() { return implementation_->executor(); }

}  // namespace footing::transport
