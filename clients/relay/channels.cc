#include "clients/relay/channels.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <array>
#include <string_view>

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

}  // namespace footing::relay
