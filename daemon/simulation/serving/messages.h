#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/net/server.h"
#include "common/stream/character.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/session.pb.h"

/// The parts of the messages of footing-sim that are the same for every engine. An engine has one
/// character.
namespace footing::serving {

/// State that the frames of all engines have in common.
struct FrameState {
  std::uint64_t step = 0;
  double time_s = 0;
  std::uint64_t overruns = 0;
  std::uint64_t state_hash = 0;
  bool valid = false;  ///< The character's pose is.
  Eigen::Vector3d p_WC_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WC_mps = Eigen::Vector3d::Zero();
  bool simulated_input = false;
};

/// A frame of one character that has neither links nor contacts yet.
v1::CharacterFrame MakeFrame(const FrameState& state, const std::string& world,
                             const std::string& rig);
/// An event at this time of the host clock.
v1::Event MakeEvent(v1::Event::Kind kind, std::int64_t host_ns, const std::string& text = "");
/// Adds the changes of the lease, as events for a person.
void AddLeaseEvents(const std::vector<std::string>& changes, std::int64_t host_ns,
                    v1::Events& events);
/// The message of one world's skeleton.
v1::Skeletons MakeSkeletons(const std::string& world, const stream::Skeleton& skeleton);

/// The refusal of a command for a character that there is not; 0 means the only one.
std::optional<v1::CommandResult> RefuseOtherCharacter(const v1::Command& command);
/// The answer to a command; the message says why it was not carried out.
v1::CommandResult Answer(bool ok, const std::string& message);

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
