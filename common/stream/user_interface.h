#pragma once

#include <cstdint>
#include <string>

#include "common/stream/character.h"
#include "common/stream/device.h"

namespace footing::stream {

/// The bit of a role in InterfaceState.
constexpr std::uint32_t RoleBit(DeviceRole role) { return 1u << static_cast<unsigned>(role); }
/// Bits of the roles whose devices move the character: both hands, both legs, or both boards. A
/// head or a trunk only turns it.
std::uint32_t DrivingRoles(UserInterface interface);
/// The names of roles by their bits: "left_hand, head".
std::string RoleNames(std::uint32_t roles);
/// The devices of an interface by the bits of their roles, in words for who uses them: "the left
/// hand and the head", "the left board", "the joystick in the left hand".
std::string DevicesText(UserInterface interface, std::uint32_t roles);

}  // namespace footing::stream
