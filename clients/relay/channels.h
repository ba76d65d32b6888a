#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/net/server.h"
#include "footing/v1/session.pb.h"

/// What a relay must know of the channels that it hands on.
namespace footing::relay {

enum class ChannelKind {
  kRetained,  ///< A state: its last value is kept for those who come later.
  kSampled,   ///< Samples or poses: a newer one takes an older one's place.
  kWhole,     ///< Everything else, such as events: none may be left out.
};

/// Of a field of v1::Tick. One that this version does not know is handed on whole.
ChannelKind KindOf(std::uint32_t field);

/// The name of a channel; empty for a field that is none.
std::string ChannelName(std::uint32_t field);

/// The channels of these names, each once, as a server publishes them; names that nobody knows are
/// left out.
std::vector<transport::Channel> ChannelsNamed(
    const google::protobuf::RepeatedPtrField<std::string>& names);

/// Usage error that lists the channels there are when one of `names` is none of them.
Result<void> CheckChannels(const std::vector<std::string>& names);

}  // namespace footing::relay
