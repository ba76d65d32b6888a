#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <sys/types.h>
#include <boost/asio/buffer.hpp>
#include <boost/circular_buffer.hpp>

#include "common/net/access.h"
#include "common/net/limits.h"
#include "common/net/server.h"
#include "common/net/tick.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {

/// Behaviour of a session's full queue; numbers as in v1::QueuePolicy.
enum class QueueRule { kLatest = 1, kDropOldest = 2, kReliable = 3 };

/// A channel's field out of another tick than the one it goes along with.
struct RetainedField {
  std::uint32_t field = 0;
  SharedTick tick;
};

/// Ticks dropped because the queue was full: first and last sequence.
struct Dropped {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
};

/// The ticks that wait for one session, bounded, with the ticks themselves shared.
///
/// A retained channel says how things stand, so its newest value must not be lost with a tick that
/// was dropped or left out by decimation: it is added to the next tick that goes out.
class TickQueue {
 public:
  struct Entry {
    SharedTick tick;
    std::vector<RetainedField> retained;
  };

  TickQueue() = default;
  /// `capacity` >= 1; kLatest has one of 1 whatever is said. `retained`: fields that are retained.
  TickQueue(QueueRule rule, std::size_t capacity, std::set<std::uint32_t> retained);

  /// False for kReliable when the queue is full: the session has to end.
  bool Push(SharedTick tick);
  /// A tick that is left out on purpose: nothing is missing, but retained channels are kept.
  void Skip(const SharedTick& tick);

  /// Ticks that were dropped in front of the oldest tick, once.
  std::optional<Dropped> TakeDropped() { return std::exchange(dropped_, std::nullopt); }
  bool Pop(Entry& entry);

  /// The oldest tick that waits; null: none.
  const Tick* oldest() const { return entries_.empty() ? nullptr : entries_.front().tick.get(); }

  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  std::uint64_t dropped_ticks() const { return dropped_ticks_; }

 private:
  void Add(SharedTick tick);
  void DropOldest();
  void Retain(const SharedTick& tick, std::vector<RetainedField>& retained) const;

  QueueRule rule_ = QueueRule::kDropOldest;
  std::size_t capacity_ = 1;
  std::set<std::uint32_t> retained_;
  /// Grows when it must. Mostly one tick waits at a time, and a server of a thousand sessions
  /// should find it in few lines of the cache.
  boost::circular_buffer<Entry> entries_;
  std::vector<RetainedField> for_next_;  ///< Retained fields of ticks skipped since the last Push.
  std::optional<Dropped> dropped_;
  std::uint64_t dropped_ticks_ = 0;
};

// The answers to Hello and Subscribe, as functions of what was asked.

inline constexpr std::uint32_t kProtocolMajor = 1;
inline constexpr std::uint32_t kProtocolMinor = 0;

/// As a person reads it; the number of one that this version does not know.
std::string RoleName(v1::Role role);

/// A refusal with that reason, and a line for a person.
v1::Refused Refuse(v1::Refused::Reason reason, const std::string& message);

/// A Welcome but for its stamps.
v1::Welcome MakeWelcome(const ServerOptions& options, std::uint64_t epoch, v1::Role role);

/// Effective subscription of a session, after the server's limits.
struct Subscription {
  std::set<std::uint32_t> fields;
  bool all = false;   ///< Every channel: the tick's bytes go out as one piece.
  double max_hz = 0;  ///< 0: every tick.
  QueueRule rule = QueueRule::kDropOldest;
  std::size_t queue_ticks = 1;
  std::size_t max_channel_bytes = 0;  ///< Bytes of one tick, with what it carries along.
};

/// The effective subscription and the answer that says so (but for first_sequence).
struct EffectiveSubscription {
  Subscription subscription;
  v1::Subscribed answer;
};
EffectiveSubscription Settle(const v1::Subscribe& wish, const ServerOptions& options);

/// Which server a client is connected to, and what a new connection resumes.
struct ServerPosition {
  std::string name;
  std::uint64_t epoch = 0;
  /// Last tick, which may be of an epoch before: the connection may break between.
  std::uint64_t last_epoch = 0;
  std::uint64_t last_sequence = 0;

  /// A live tick has come.
  void Take(std::uint64_t sequence) {
    last_sequence = last_epoch == epoch ? std::max(last_sequence, sequence) : sequence;
    last_epoch = epoch;
  }
};

/// Content of one gather-write: small pieces of its own beside bytes that many sessions share. It
/// keeps all of them alive until they are written.
class WriteBatch {
 public:
  /// As many buffers as one writev(2) of Asio takes.
  static constexpr std::size_t kMaxBuffers = 64;
  static constexpr std::size_t kHeadBytes = 64;

  WriteBatch() { buffers_.reserve(kMaxBuffers); }
  WriteBatch(const WriteBatch&) = delete;
  WriteBatch& operator=(const WriteBatch&) = delete;

  bool empty() const { return first_ == buffers_.size(); }
  std::size_t free_buffers() const { return kMaxBuffers - buffers_.size(); }

  /// Bytes that belong to this batch alone.
  void AddOwned(std::string bytes);
  /// At most kHeadBytes, copied.
  void AddHead(const char* bytes, std::size_t size);
  /// A part of shared bytes. `owner` is kept until the batch is written.
  void AddShared(std::shared_ptr<const void> owner, const char* bytes, std::size_t size);

  std::span<const boost::asio::const_buffer> buffers() const {
    return std::span(buffers_).subspan(first_);
  }
  /// `bytes` more are written. The batch is empty again once all are.
  void Consume(std::size_t bytes);

 private:
  std::vector<boost::asio::const_buffer> buffers_;
  std::size_t first_ = 0;
  std::array<std::array<char, kHeadBytes>, kMaxBuffers> heads_;
  std::size_t heads_used_ = 0;
  std::vector<std::unique_ptr<const std::string>> owned_;
  std::vector<std::shared_ptr<const void>> shared_;
};

/// Empty batches for the connections of one thread. The one given back last is taken first: with
/// many sessions served one after the other it is still in the processor's cache, which a batch of
/// each session's own would not be.
class BatchPool {
 public:
  std::unique_ptr<WriteBatch> Take();
  void Give(std::unique_ptr<WriteBatch> batch);

 private:
  std::vector<std::unique_ptr<WriteBatch>> free_;
};

/// Buffers that one tick may take in a batch; a tick of more pieces is copied into one.
inline constexpr std::size_t kBuffersPerTick = 8;

/// Adds the frame of one tick: a head of this session's own, and the shared bytes of the channels
/// subscribed to. `head` says all but what the tick does. The batch has space for kBuffersPerTick.
void AddTick(const TickQueue::Entry& entry, const Subscription& subscription, TickHead head,
             WriteBatch& batch);

// Who may come in, and as what: a state machine over the Hello messages of all sessions of a
// server, without sockets and clocks.

/// Whose Hello it is, as the kernel and TLS know it.
struct Caller {
  Peer peer;
  bool secured = false;  ///< It comes over TLS.
  std::string certificate =
      {};  ///< Fingerprint of the certificate that it has proved; empty: none.
};

/// Whose process the server is.
struct ServerUser {
  uid_t user = 0;
  gid_t group = 0;
};

/// By what a caller got its role.
enum class Grant { kAddress, kUser, kCertificate, kToken, kViewToken };

/// "address" (loopback TCP), "user" (the kernel knows it), "certificate", "token", "view_token".
std::string Name(Grant grant);

/// A client that was let in: its role, and the reason for it.
struct Admitted {
  v1::Role role = v1::ROLE_VIEW;
  v1::Role highest = v1::ROLE_VIEW;  ///< That it could have asked for.
  std::string client_name;           ///< As PlainName() gives it.
  Grant grant = Grant::kAddress;
  Claim claim = {};

  bool may_administer() const { return highest == v1::ROLE_ADMIN; }
};

/// Which proof of who it is a caller lacked, for the log.
enum class Lack { kNone, kAnyProof, kKnownCertificate, kRightToken };

/// A client that was turned away: the answer to it, and what it lacks.
struct NotAdmitted {
  v1::Refused answer;
  Lack lack = Lack::kNone;
  std::string lack_text = {};  ///< For the log; empty with kNone.
  bool waits = false;          ///< A guess of a token: it is answered later.
};

/// State that Hello messages change. A plain value.
struct AdmissionState {
  TokenGuard token;
  PlacesTaken places = {};
};

using Admission = std::variant<Admitted, NotAdmitted>;

/// The answer to a Hello. Neither it nor what the log gets depends on the wrong token that a caller
/// presents. Leave() takes an Admitted back when its session ends.
Admission Admit(const ServerOptions& options, const ServerUser& own, const Caller& caller,
                const v1::Hello& hello, std::int64_t now_ns, AdmissionState& state);
void Leave(const Admitted& admitted, AdmissionState& state);

/// Why a session that was admitted with the keys `before` may not stay with those of `now`, for its
/// client; empty when it may.
std::string WhyRevoked(const AccessKeys& before, const AccessKeys& now, const Admitted& admitted);

/// For logs and other people's screens: at most 64 bytes, printable.
std::string PlainName(std::string name);

}  // namespace footing::transport
