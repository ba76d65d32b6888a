#include "common/net/publication.h"

#include <algorithm>
#include <cmath>

namespace footing::transport {
namespace {

std::size_t RingTicks(const ServerOptions& options) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(options.ring_s * options.tick_rate_hz)));
}

}  // namespace

Publication::Publication(const ServerOptions& options)
    : max_tick_bytes_(options.max_message_out_bytes - kMaxTickHeadBytes),
      ring_(RingTicks(options), options.ring_max_bytes) {
  for (const Channel& channel : options.channels) {
    fields_.push_back(channel.field);
    if (channel.retained) retained_.insert(channel.field);
  }
}

/// Finds the channels that a tick has space for; returns the bytes of their fields.
std::size_t Publication::Fit(const std::vector<ChannelBytes>& channels) {
  std::size_t size = 0;
  fitting_.clear();
  for (const ChannelBytes& channel : channels) {
    const std::size_t bytes = FieldBytes(channel.field, channel.bytes.size());
    const bool known = std::find(fields_.begin(), fields_.end(), channel.field) != fields_.end();
    if (size + bytes > max_tick_bytes_ || !known) {
      ++channels_left_out_;
      left_out_field_ = channel.field;
      continue;
    }
    size += bytes;
    fitting_.push_back(&channel);
  }
  return size;
}

std::shared_ptr<Tick> Publication::Serialise(const TickNumber& number,
                                             const std::vector<ChannelBytes>& channels) {
  auto tick = std::make_shared<Tick>();
  tick->sequence = number.sequence;
  tick->host_ns = number.host_ns;
  tick->missing_from = number.missing_from;
  const std::size_t size = Fit(channels);
  char head[kMaxTickHeadBytes];
  tick->head_bytes = EncodeTickHead({epoch_, number.sequence, number.host_ns}, size, head);
  tick->bytes.reserve(tick->head_bytes + size);
  tick->bytes.append(head, tick->head_bytes);
  tick->slices.reserve(fitting_.size());
  for (const ChannelBytes* channel : fitting_) AppendField(channel->field, channel->bytes, *tick);
  return tick;
}

TickNumber Publication::Next(std::int64_t host_ns) const {
  const std::uint64_t following = last_sequence_ + 1;
  return {following + left_out_next_, host_ns, left_out_next_ == 0 ? 0 : following};
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
  left_out_next_ = 0;
  return tick;
}

void Publication::Keep(const SharedTick& tick) {
  KeepRetained(tick);
  ring_.Push(tick);
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
