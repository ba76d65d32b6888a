#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "footing/v1/session.pb.h"

/// One tick, serialised once and shared by the ring and by every session's queue.
namespace footing::transport {

/// Where one channel's field (tag, length and message) stands in the tick's bytes.
struct Slice {
  std::uint32_t field = 0;
  std::size_t begin = 0;
  std::size_t size = 0;
};

/// Immutable once it is made.
struct Tick {
  std::uint64_t sequence = 0;
  std::int64_t host_ns = 0;
  /// First of the ticks right in front of this one that this server never had: its owner left them
  /// out, or they were lost before they came to a server that relays another one's; 0: none.
  /// Whoever gets this tick gets a Gap in front of it.
  std::uint64_t missing_from = 0;
  std::size_t head_bytes = 0;
  /// The head of the live frame with all channels, if it has one, then the channels' fields, one
  /// after the other, as they stand in v1::Tick.
  std::string bytes;
  std::vector<Slice> slices;  ///< Places in `bytes`.

  std::string_view fields() const { return std::string_view(bytes).substr(head_bytes); }

  /// Null when this tick has nothing of that channel.
  const Slice* Find(std::uint32_t field) const;
};
using SharedTick = std::shared_ptr<const Tick>;

/// Bytes of one length-delimited protobuf field whose message has so many.
std::size_t FieldBytes(std::uint32_t field, std::size_t message_bytes);

/// Appends one length-delimited protobuf field.
void AppendField(std::uint32_t field, const std::string& message, Tick& tick);

/// Head of a tick, in front of the channels' fields.
struct TickHead {
  std::uint64_t epoch = 0;
  std::uint64_t sequence = 0;
  std::int64_t host_ns = 0;
  bool snapshot = false;
  bool refilled = false;
};

/// Longest head: frame length 4, tag 2 and length 5 of the tick, three varints of 11, two flags
/// of 2.
inline constexpr std::size_t kMaxTickHeadBytes = 4 + 2 + 5 + 3 * 11 + 2 * 2;

/// Writes the head of a frame whose channels have `channel_bytes` bytes in all: the frame's length,
/// the tag and length of Envelope.tick, and the tick's own fields. Returns how many bytes it took
/// of the kMaxTickHeadBytes at `out`.
std::size_t EncodeTickHead(const TickHead& head, std::size_t channel_bytes, char* out);

/// Whether a server can have this rate; one from another program or a file may be anything.
constexpr bool IsTickRate(double rate_hz) { return rate_hz >= 0.1 && rate_hz <= 10'000; }

/// The rate of the server that says this; `otherwise` where it says none, or none that can be.
inline double TickRateOf(const v1::Welcome& welcome, double otherwise) {
  const double rate_hz = welcome.limits().tick_rate_hz();
  return IsTickRate(rate_hz) ? rate_hz : otherwise;
}

/// The last ticks, by rising sequence, bounded in number and in bytes. The newest is always held.
/// The sequences of a relay's ticks have holes where it left ticks out.
class TickRing {
 public:
  TickRing(std::size_t max_ticks, std::size_t max_bytes)
      : max_ticks_(max_ticks), max_bytes_(max_bytes) {}

  /// The tick's sequence is above the last one's. Lets go what is over the bounds.
  void Push(SharedTick tick);

  /// The first one held from this sequence on; null when there is none yet.
  const SharedTick* AtOrAfter(std::uint64_t sequence) const;
  /// How many are held from this sequence on.
  std::size_t CountFrom(std::uint64_t sequence) const;

  bool empty() const { return ticks_.empty(); }
  /// Sequences of the oldest and the newest tick held; 0 when there is none.
  std::uint64_t first() const { return empty() ? 0 : ticks_.front()->sequence; }
  std::uint64_t last() const { return empty() ? 0 : ticks_.back()->sequence; }
  std::size_t bytes() const { return bytes_; }

 private:
  std::size_t IndexFrom(std::uint64_t sequence) const;

  std::size_t max_ticks_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::deque<SharedTick> ticks_;
};

}  // namespace footing::transport
