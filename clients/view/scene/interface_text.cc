#include "clients/view/scene/interface_text.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/words.h"
#include "common/base/units.h"

namespace footing::scene {
namespace {

using stream::Activity;
using stream::UserInterface;

bool IsOfFeet(UserInterface interface) {
  return interface == UserInterface::kLeg || interface == UserInterface::kBoards;
}

const char* LimbsOf(UserInterface interface) {
  return IsOfFeet(interface) ? "feet" : interface == UserInterface::kArm ? "arms" : "hands";
}

std::string RestText(UserInterface interface) {
  if (interface == UserInterface::kJoystick) return "stick at rest";
  if (IsOfFeet(interface)) return "standing";
  return std::string(LimbsOf(interface)) + " at rest";
}

std::string WithSpaces(std::string names) {
  std::replace(names.begin(), names.end(), '_', ' ');
  return names;
}

}  // namespace

std::string RoleText(stream::DeviceRole role) { return WithSpaces(stream::Name(role)); }

std::string RolesText(std::uint32_t roles) { return WithSpaces(stream::RoleNames(roles)); }

std::string ActivityText(const stream::InterfaceState& state) {
  const std::string limbs = LimbsOf(state.interface);
  switch (state.activity) {
    case Activity::kUnspecified:
      return "";
    case Activity::kAbsent:
      return "no devices";
    case Activity::kRest:
      return RestText(state.interface);
    case Activity::kUnclear:
      return limbs + " in motion, not clear yet";
    case Activity::kUnequal:
      return limbs + " at different frequencies";
    case Activity::kAlternate:
      return IsOfFeet(state.interface) ? "stepping" : limbs + " swing alternately";
    case Activity::kTogether:
      return IsOfFeet(state.interface) ? "both feet together" : limbs + " swing together";
    case Activity::kStick:
      return "stick pushed";
    case Activity::kButton:
      return "button A";
    case Activity::kHeelRise:
      return "heel rise";
    case Activity::kOffBoards:
      return "nobody on the boards";
  }
  return "";
}

std::string ProblemText(const stream::InterfaceState& state) {
  if (state.missing_roles != 0 && state.interface == UserInterface::kJoystick) {
    return "missing: " + stream::DevicesText(state.interface, state.missing_roles);
  }
  if (state.missing_roles != 0) return "missing: " + RolesText(state.missing_roles);
  if (state.unmounted_roles == 0) return "";
  return "no mounting: " + RolesText(state.unmounted_roles) + " (footing-ctl setup)";
}

std::string InterfaceText(const stream::InterfaceState& state) {
  if (state.interface == UserInterface::kUnspecified) return "";
  std::string text = std::string(stream::Name(state.interface)) + ": " + ActivityText(state);
  if (state.frequency_valid) text += ", " + Fixed(state.frequency_hz, 2) + " Hz";
  if (state.phase_valid) text += ", phase " + Fixed(RadiansToDegrees(state.phase_rad), 0) + " deg";
  if (state.forearms.valid) {
    text += ", forearms " + Fixed(RadiansToDegrees(state.forearms.elevation_rad), 0) + " deg";
  }
  if (state.stick.valid) text += ", " + Fixed(state.stick.x, 2) + " " + Fixed(state.stick.y, 2);
  if (state.load_valid) text += ", left " + Fixed(100 * state.left_share, 0) + " %";
  text += " -> " + GaitTitle(state.gait);
  if (state.next_gait != stream::Gait::kUnspecified) {
    text += " (" + GaitTitle(state.next_gait) + "?)";
  }
  if (std::fabs(state.turn.share) >= 1) {
    text += std::string(", turn ") + (state.turn.share > 0 ? "right" : "left") + " by " +
            stream::Name(state.turn.source);
  }
  const std::string problem = ProblemText(state);
  return problem.empty() ? text : text + "; " + problem;
}

}  // namespace footing::scene
