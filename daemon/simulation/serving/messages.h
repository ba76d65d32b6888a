#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/character.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/session.pb.h"

/// The parts of the messages of footing-sim that are the same for every engine. An engine has one
/// character.
namespace footing::serving {

/// What the frames of all engines have in common.
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
v1::Event MakeEvent(v1::Event::Kind kind, std::int64_t host_ns, const std::string& text = "");
/// What happened to the lease, for a person.
void AddLeaseEvents(const std::vector<std::string>& changes, std::int64_t host_ns,
                    v1::Events& events);
v1::Skeletons MakeSkeletons(const std::string& world, const stream::Skeleton& skeleton);

/// The refusal of a command for a character that there is not; 0 means the only one.
std::optional<v1::CommandResult> RefuseOtherCharacter(const v1::Command& command);
/// The answer to a command; the message says why it was not carried out.
v1::CommandResult Answer(bool ok, const std::string& message);

}  // namespace footing::serving
