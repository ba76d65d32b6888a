#include "common/net/tick.h"

#include <algorithm>
#include <utility>

#include "common/base/result.h"
#include "common/net/framing.h"

namespace footing::transport {
namespace {

// Protobuf's encoding: a tag is field number times 8 plus wire type; 0 varint, 2 length-delimited.
constexpr std::uint64_t Tag(std::uint32_t field, std::uint32_t wire_type) {
  return (std::uint64_t{field} << 3) | wire_type;
}
constexpr std::uint32_t kVarint = 0;
constexpr std::uint32_t kLengthDelimited = 2;
constexpr std::uint32_t kEnvelopeTick = 16;  // Envelope.tick in session.proto.
// Fields of Tick in session.proto.
constexpr std::uint32_t kEpoch = 1;
constexpr std::uint32_t kSequence = 2;
constexpr std::uint32_t kHostNs = 3;
constexpr std::uint32_t kSnapshot = 4;
constexpr std::uint32_t kRefilled = 5;

char* WriteVarint(std::uint64_t value, char* out) {
  while (value >= 0x80) {
    *out++ = static_cast<char>(value | 0x80);
    value >>= 7;
  }
  *out++ = static_cast<char>(value);
  return out;
}

/// A field of value zero is left out, as protobuf does.
char* WriteVarintField(std::uint32_t field, std::uint64_t value, char* out) {
  if (value == 0) return out;
  return WriteVarint(value, WriteVarint(Tag(field, kVarint), out));
}

char* WriteTickFields(const TickHead& head, char* out) {
  out = WriteVarintField(kEpoch, head.epoch, out);
  out = WriteVarintField(kSequence, head.sequence, out);
  out = WriteVarintField(kHostNs, static_cast<std::uint64_t>(head.host_ns), out);
  out = WriteVarintField(kSnapshot, head.snapshot ? 1 : 0, out);
  return WriteVarintField(kRefilled, head.refilled ? 1 : 0, out);
}

char* WriteEnvelopeTag(std::size_t tick_bytes, char* out) {
  return WriteVarint(tick_bytes, WriteVarint(Tag(kEnvelopeTick, kLengthDelimited), out));
}

}  // namespace

const Slice* Tick::Find(std::uint32_t field) const {
  const auto found = std::find_if(slices.begin(), slices.end(),
                                  [&](const Slice& slice) { return slice.field == field; });
  return found == slices.end() ? nullptr : &*found;
}

std::size_t FieldBytes(std::uint32_t field, std::size_t message_bytes) {
  char prefix[20];  // Two varints.
  const char* const end =
      WriteVarint(message_bytes, WriteVarint(Tag(field, kLengthDelimited), prefix));
  return static_cast<std::size_t>(end - prefix) + message_bytes;
}

void AppendField(std::uint32_t field, const std::string& message, Tick& tick) {
  char prefix[20];  // Two varints.
  const char* const end =
      WriteVarint(message.size(), WriteVarint(Tag(field, kLengthDelimited), prefix));
  const std::size_t begin = tick.bytes.size();
  tick.bytes.append(prefix, static_cast<std::size_t>(end - prefix));
  tick.bytes.append(message);
  tick.slices.push_back({field, begin, tick.bytes.size() - begin});
}

std::size_t EncodeTickHead(const TickHead& head, std::size_t channel_bytes, char* out) {
  char fields[3 * 11 + 2 * 2];
  const auto field_bytes = static_cast<std::size_t>(WriteTickFields(head, fields) - fields);
  char* const payload = out + kLengthBytes;
  char* const after_tag = WriteEnvelopeTag(field_bytes + channel_bytes, payload);
  char* const end = std::copy(fields, fields + field_bytes, after_tag);
  const auto length = EncodeLength(
      static_cast<std::uint32_t>(static_cast<std::size_t>(end - payload) + channel_bytes));
  std::copy(length.begin(), length.end(), out);
  return static_cast<std::size_t>(end - out);
}

namespace {

std::size_t Cost(const Tick& tick) {
  return sizeof(Tick) + tick.bytes.capacity() + tick.slices.capacity() * sizeof(Slice);
}

}  // namespace

void TickRing::Push(SharedTick tick) {
  FOOTING_CHECK(empty() || tick->sequence > last());
  bytes_ += Cost(*tick);
  ticks_.push_back(std::move(tick));
  while (ticks_.size() > 1 && (ticks_.size() > max_ticks_ || bytes_ > max_bytes_)) {
    bytes_ -= Cost(*ticks_.front());
    ticks_.pop_front();
  }
}

std::size_t TickRing::IndexFrom(std::uint64_t sequence) const {
  const auto found = std::lower_bound(
      ticks_.begin(), ticks_.end(), sequence,
      [](const SharedTick& tick, std::uint64_t wanted) { return tick->sequence < wanted; });
  return static_cast<std::size_t>(found - ticks_.begin());
}

const SharedTick* TickRing::AtOrAfter(std::uint64_t sequence) const {
  const std::size_t index = IndexFrom(sequence);
  return index < ticks_.size() ? &ticks_[index] : nullptr;
}

std::size_t TickRing::CountFrom(std::uint64_t sequence) const {
  return ticks_.size() - IndexFrom(sequence);
}

}  // namespace footing::transport
