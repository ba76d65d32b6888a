#include "clients/relay/thinner.h"

#include <utility>

#include "clients/relay/channels.h"
#include "common/base/instant.h"
#include "common/base/time.h"

namespace footing::relay {

bool IsSound(const transport::TickNumber& number) {
  return IsInstant(number.host_ns) && IsInstant(number.sequence);
}

Thinner::Thinner(double rate_hz, double tick_rate_hz, std::uint64_t last_sequence)
    : rate_hz_(rate_hz),
      begin_(last_sequence),
      last_sequence_(last_sequence),
      decimator_(rate_hz, PeriodNanoseconds(tick_rate_hz)) {}

std::optional<Thinner::Thinned> Thinner::Take(const transport::TickNumber& number,
                                              std::vector<transport::ChannelBytes> channels) {
  if (!IsSound(number) || number.sequence <= last_sequence_) return std::nullopt;
  Thinned thinned;
  thinned.number = number;
  const bool hole = number.sequence > last_sequence_ + 1;
  thinned.number.missing_from = hole ? last_sequence_ + 1 : 0;
  missing_ += number.sequence - last_sequence_ - 1;
  last_sequence_ = number.sequence;
  for (transport::ChannelBytes& channel : channels) {
    if (KindOf(channel.field) == ChannelKind::kSampled) {
      waiting_[channel.field] = std::move(channel.bytes);
    } else {
      retained_.erase(channel.field);
      if (KindOf(channel.field) == ChannelKind::kRetained) came_[channel.field] = number.sequence;
      thinned.channels.push_back(std::move(channel));
    }
  }
  for (auto& [field, bytes] : std::exchange(retained_, {})) {
    thinned.channels.push_back({field, std::move(bytes)});
  }
  if (!waiting_.empty() && decimator_.Take(number.host_ns)) {
    for (auto& [field, bytes] : std::exchange(waiting_, {})) {
      thinned.channels.push_back({field, std::move(bytes)});
    }
  }
  if (rate_hz_ > 0 && thinned.channels.empty() && !hole) {
    ++left_out_;
    return std::nullopt;
  }
  return thinned;
}

void Thinner::TakeRetained(std::uint64_t sequence, std::vector<transport::ChannelBytes> channels) {
  if (sequence < begin_) return;
  for (transport::ChannelBytes& channel : channels) {
    if (KindOf(channel.field) != ChannelKind::kRetained) continue;
    std::uint64_t& came = came_[channel.field];
    if (sequence < came) continue;
    came = sequence;
    retained_[channel.field] = std::move(channel.bytes);
  }
}

}  // namespace footing::relay
