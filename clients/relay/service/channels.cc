#include "clients/relay/service/channels.h"

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

const google::protobuf::FieldDescriptor* Field(std::uint32_t field) {
  const auto* const found = v1::Tick::descriptor()->FindFieldByNumber(static_cast<int>(field));
  return found != nullptr && found->message_type() != nullptr ? found : nullptr;
}

}  // namespace

ChannelKind KindOf(std::uint32_t field) {
  const std::string name = ChannelName(field);
  if (std::count(kRetained.begin(), kRetained.end(), name) > 0) return ChannelKind::kRetained;
  if (std::count(kSampled.begin(), kSampled.end(), name) > 0) return ChannelKind::kSampled;
  return ChannelKind::kWhole;
}

std::string ChannelName(std::uint32_t field) {
  const auto* const found = Field(field);
  return found == nullptr ? "" : found->name();
}

std::vector<transport::Channel> ChannelsNamed(
    const google::protobuf::RepeatedPtrField<std::string>& names) {
  std::vector<transport::Channel> channels;
  for (const std::string& name : names) {
    const auto* const found = v1::Tick::descriptor()->FindFieldByName(name);
    if (found == nullptr || found->message_type() == nullptr) continue;
    const auto field = static_cast<std::uint32_t>(found->number());
    channels.push_back({name, field, KindOf(field) == ChannelKind::kRetained});
  }
  return channels;
}

Result<void> CheckChannels(const std::vector<std::string>& names) {
  const google::protobuf::Descriptor& tick = *v1::Tick::descriptor();
  std::string known;
  for (int i = 0; i < tick.field_count(); ++i) {
    if (tick.field(i)->message_type() == nullptr || tick.field(i)->name() == kRetired) continue;
    known += (known.empty() ? "" : ", ") + tick.field(i)->name();
  }
  for (const std::string& name : names) {
    const auto* const found = tick.FindFieldByName(name);
    if (found == nullptr || found->message_type() == nullptr || name == kRetired)
      return UsageError("unknown --channel " + name + "; there are: " + known);
  }
  return {};
}

}  // namespace footing::relay
