#include "clients/view/scene/lost_text.h"

#include "common/stream/user_interface.h"

namespace footing::scene {
namespace {

using stream::UserInterface;

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
  lost.what = "No signal from " + stream::DevicesText(state.interface, state.missing_roles);
  lost.advice = AdviceFor(state.interface);
  return lost;
}

std::string LostLine(const CharacterPose& pose) {
  const auto lost = LostSignalOf(pose);
  return lost ? lost->what + ". " + lost->effect + " " + lost->advice : "";
}

}  // namespace footing::scene
