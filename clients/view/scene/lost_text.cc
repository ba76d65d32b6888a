#include "clients/view/scene/lost_text.h"

#include <vector>

#include "common/stream/user_interface.h"

namespace footing::scene {
namespace {

using stream::DeviceRole;
using stream::UserInterface;

std::string NameOf(DeviceRole role) {
  std::string name = stream::Name(role);
  for (char& letter : name) {
    if (letter == '_') letter = ' ';
  }
  return name;
}

/// "the left hand, the right hand and the head".
std::string ListOf(std::uint32_t roles) {
  std::vector<std::string> names;
  for (unsigned number = 1; number <= static_cast<unsigned>(DeviceRole::kTrunk); ++number) {
    const auto role = static_cast<DeviceRole>(number);
    if ((roles & stream::RoleBit(role)) != 0) names.push_back("the " + NameOf(role));
  }
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 == names.size() ? " and " : ", ";
    list += names[i];
  }
  return list;
}

std::string DevicesOf(const stream::InterfaceState& state) {
  // The stick may be on either hand's remote.
  if (state.interface == UserInterface::kJoystick) return "the joystick";
  return ListOf(state.missing_roles);
}

std::string AdviceFor(UserInterface interface) {
  const std::string which = interface == UserInterface::kBoards ? "board" : "controller";
  return "Stand still and press a button of each silent " + which +
         ". If no light comes on, change its batteries. The character continues by itself.";
}

}  // namespace

std::optional<LostSignal> LostSignalOf(const CharacterPose& pose) {
  const stream::InterfaceState& state = pose.interface;
  if (state.interface == UserInterface::kUnspecified) return std::nullopt;
  const bool absent = state.activity == stream::Activity::kAbsent;
  if (!absent && state.missing_roles == 0) return std::nullopt;
  // Without its devices an interface commands stepping: another command comes from elsewhere.
  if (absent && pose.gait.commanded_gait != stream::Gait::kStep) return std::nullopt;
  LostSignal lost;
  lost.effect = absent ? "The character stops and steps in place."
                       : "The character continues, but does not turn.";
  if (!pose.gait.commanded_by_stream) {
    lost.what = "No signal from any device";
    lost.advice =
        "Stand still. The sensor daemon footingd does not answer: start it again, or "
        "check the cable to it. The character continues by itself.";
    return lost;
  }
  lost.what = "No signal from " + DevicesOf(state);
  lost.advice = AdviceFor(state.interface);
  return lost;
}

std::string LostLine(const CharacterPose& pose) {
  const auto lost = LostSignalOf(pose);
  return lost ? lost->what + ". " + lost->effect + " " + lost->advice : "";
}

}  // namespace footing::scene
