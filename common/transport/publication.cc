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

SharedTick Publication::Publish(std::int64_t host_ns, const std::vector<ChannelBytes>& channels) {
  auto tick = std::make_shared<Tick>();
  tick->sequence = ++last_sequence_;
  tick->host_ns = host_ns;
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
  SharedTick shared = std::move(tick);
  for (const Slice& slice : shared->slices) {
    if (retained_.count(slice.field) > 0) last_values_[slice.field] = shared;
  }
  ring_.Push(shared);
  return shared;
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
