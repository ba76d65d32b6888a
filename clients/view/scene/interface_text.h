#pragma once

#include <string>
#include <vector>

#include "common/stream/device.h"
#include "common/stream/user_interface.h"

/// A user interface's belief in words, for screens and logs.
namespace footing::scene {

/// "left hand".
std::string RoleText(stream::DeviceRole role);

/// "left hand, head": the roles of these bits.
std::string RolesText(std::uint32_t roles);

/// "hands swing alternately": what the interface believes that the person does.
std::string ActivityText(const stream::InterfaceState& state);

/// What is wrong with the devices and what to do; empty when nothing is.
std::string ProblemText(const stream::InterfaceState& state);

/// The whole belief in one line; empty without an interface.
std::string InterfaceText(const stream::InterfaceState& state);

}  // namespace footing::scene
