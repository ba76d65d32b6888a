#include "clients/relay/channels.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <google/protobuf/descriptor.h>

#include "common/base/units.h"
#include "common/net/framing.h"
#include "common/net/tick.h"

namespace footing::relay {
namespace {

constexpr std::array<std::string_view, 8> kRetained = {"status", "setup", "skeletons", "track",
                                                       "config", "study", "game",      "stats"};
constexpr std::array<std::string_view, 12> kSampled = {
    "motion", "features",   "boards", "raw",       "nunchuk",  "camera",
    "hands",  "characters", "inputs", "reference", "contacts", "gamepad"};

constexpr std::string_view kRetired = "boards_uniform";  // No server publishes it.

using FieldDescriptor = google::protobuf::FieldDescriptor;

/// The field, if it is a channel's.
const FieldDescriptor* OfChannel(const FieldDescriptor* field) {
  return field != nullptr && field->message_type() != nullptr ? field : nullptr;
}

}  // namespace

ChannelKind KindOf(std::uint32_t field) {
  const std::string name = ChannelName(field);
  if (std::count(kRetained.begin(), kRetained.end(), name) > 0) return ChannelKind::kRetained;
  if (std::count(kSampled.begin(), kSampled.end(), name) > 0) return ChannelKind::kSampled;
  return ChannelKind::kWhole;
}

std::string ChannelName(std::uint32_t field) {
  const auto* const found =
      OfChannel(v1::Tick::descriptor()->FindFieldByNumber(static_cast<int>(field)));
  return found == nullptr ? "" : found->name();
}

std::vector<transport::Channel> ChannelsNamed(
    const google::protobuf::RepeatedPtrField<std::string>& names) {
  std::vector<transport::Channel> channels;
  for (const std::string& name : names) {
    const auto* const found = OfChannel(v1::Tick::descriptor()->FindFieldByName(name));
    if (found == nullptr) continue;
    const auto field = static_cast<std::uint32_t>(found->number());
    const bool again = std::any_of(channels.begin(), channels.end(),
                                   [&](const auto& channel) { return channel.field == field; });
    if (again) continue;
    channels.push_back({name, field, KindOf(field) == ChannelKind::kRetained});
  }
  return channels;
}

Result<void> CheckChannels(const std::vector<std::string>& names) {
  const google::protobuf::Descriptor& tick = *v1::Tick::descriptor();
  for (const std::string& name : names) {
    if (OfChannel(tick.FindFieldByName(name)) != nullptr && name != kRetired) continue;
    std::string known;
    for (int i = 0; i < tick.field_count(); ++i) {
      if (OfChannel(tick.field(i)) == nullptr || tick.field(i)->name() == kRetired) continue;
      known += (known.empty() ? "" : ", ") + tick.field(i)->name();
    }
    return UsageError("unknown --channel " + name + "; there are: " + known);
  }
  return {};
}

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

std::string TickSubject(const std::string& site, const std::string& server) {
  return "footing." + site + "." + server + ".tick";
}

std::string AskSubject(const std::string& site, const std::string& server) {
  return "footing." + site + "." + server + ".ask";
}

std::string ChannelTopic(const std::string& site, const std::string& server,
                         const std::string& channel) {
  return "footing/" + site + "/" + server + "/" + channel;
}

std::string TickMessage(std::uint64_t epoch, const transport::TickNumber& number,
                        const std::vector<transport::ChannelBytes>& channels) {
  transport::Tick tick;
  for (const transport::ChannelBytes& channel : channels) {
    transport::AppendField(channel.field, channel.bytes, tick);
  }
  transport::TickHead head;
  head.epoch = epoch;
  head.sequence = number.sequence;
  head.host_ns = number.host_ns;
  std::array<char, transport::kMaxTickHeadBytes> bytes;
  const std::size_t size = transport::EncodeTickHead(head, tick.bytes.size(), bytes.data());
  // Without the length in front: a message of a broker has its own.
  return std::string(bytes.data() + transport::kLengthBytes, size - transport::kLengthBytes) +
         tick.bytes;
}

}  // namespace footing::relay
