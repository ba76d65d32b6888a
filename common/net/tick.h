#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

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

/// What stands in front of the channels' fields.
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

/// Bytes of a frame's payload with such a head and such channels.
std::size_t TickPayloadBytes(const TickHead& head, std::size_t channel_bytes);

}  // namespace footing::transport
