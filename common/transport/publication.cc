#include "common/transport/publication.h"

#include <algorithm>
#include <cmath>

namespace footing::transport {
namespace {

/// Tag and length in front of a channel's message take at most this.
constexpr std::size_t kMaxPrefixBytes = 10;

std::size_t RingTicks(const ServerOptions& options) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(options.ring_s * options.tick_rate_hz)));
}

}  // namespace

Publication::Publication(const ServerOptions& options)
    : max_tick_bytes_(options.max_message_out_bytes - kMaxTickHeadBytes),
      ring_(RingTicks(options), options.ring_max_bytes) {
  for (const Channel& channel : options.channels) {
    fields_.insert(channel.field);
    if (channel.retained) retained_.insert(channel.field);
  }
}

std::shared_ptr<Tick> Publication::Serialise(const TickNumber& number,
                                             const std::vector<ChannelBytes>& channels) {
  auto tick = std::make_shared<Tick>();
  tick->sequence = number.sequence;
  tick->host_ns = number.host_ns;
  tick->missing_from = number.missing_from;
  std::size_t size = 0;
  for (const auto& channel : channels) size += channel.bytes.size() + kMaxPrefixBytes;
  tick->bytes.reserve(std::min(size, max_tick_bytes_));
  tick->slices.reserve(channels.size());
  for (const auto& channel : channels) {
    const bool fits =
        tick->bytes.size() + channel.bytes.size() + kMaxPrefixBytes <= max_tick_bytes_;
    if (!fits || fields_.count(channel.field) == 0) {
      ++channels_left_out_;
      continue;
    }
    AppendField(channel.field, channel.bytes, *tick);
  }
  return tick;
}

void Publication::KeepRetained(const SharedTick& tick) {
  for (const Slice& slice : tick->slices) {
    if (retained_.count(slice.field) > 0) last_values_[slice.field] = tick;
  }
}

SharedTick Publication::Publish(const TickNumber& number,
                                const std::vector<ChannelBytes>& channels) {
  SharedTick tick = Serialise(number, channels);
  last_sequence_ = number.sequence;
  KeepRetained(tick);
  ring_.Push(tick);
  return tick;
}

void Publication::BeginAt(const TickNumber& number, const std::vector<ChannelBytes>& retained) {
  last_sequence_ = number.sequence;
  KeepRetained(Serialise(number, retained));
}

SharedTick Publication::Snapshot(std::uint64_t sequence, std::int64_t host_ns) const {
  auto tick = std::make_shared<Tick>();
  tick->sequence = sequence;
  tick->host_ns = host_ns;
  for (const auto& [field, source] : last_values_) {
    const Slice& slice = *source->Find(field);
    if (tick->bytes.size() + slice.size > max_tick_bytes_) continue;
    tick->slices.push_back({field, tick->bytes.size(), slice.size});
    tick->bytes.append(source->bytes, slice.begin, slice.size);
  }
  return tick;
}

}  // namespace footing::transport
