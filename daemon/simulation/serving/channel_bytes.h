#pragma once

#include <vector>

#include "common/net/server.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::serving {

inline constexpr std::uint32_t kSkeletons = v1::Tick::kSkeletonsFieldNumber;
inline constexpr std::uint32_t kTrack = v1::Tick::kTrackFieldNumber;
inline constexpr std::uint32_t kCharacters = v1::Tick::kCharactersFieldNumber;
inline constexpr std::uint32_t kEvents = v1::Tick::kEventsFieldNumber;
inline constexpr std::uint32_t kInputs = v1::Tick::kInputsFieldNumber;
inline constexpr std::uint32_t kConfig = v1::Tick::kConfigFieldNumber;
inline constexpr std::uint32_t kStudy = v1::Tick::kStudyFieldNumber;
inline constexpr std::uint32_t kGame = v1::Tick::kGameFieldNumber;

/// One channel of a tick.
inline transport::ChannelBytes Bytes(std::uint32_t field,
                                     const google::protobuf::MessageLite& message) {
  return {field, message.SerializeAsString()};
}

/// Adds what every frame publishes: the character, and events and inputs where there are any.
void AddFrame(const v1::CharacterFrame& frame, const v1::Events& events,
              const v1::AppliedInputs& inputs, std::vector<transport::ChannelBytes>& channels);

}  // namespace footing::serving
