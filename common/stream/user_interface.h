#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "common/stream/character.h"
#include "common/stream/device.h"

namespace footing::stream {

/// What a person commands the gait engine's character with (gait paper, section 7); boards are
/// ours.
enum class UserInterface {
  kUnspecified = 0,
  kWrist = 1,
  kArm = 2,
  kLeg = 3,
  kJoystick = 4,
  kBoards = 5
};

inline constexpr std::array kUserInterfaces{UserInterface::kWrist, UserInterface::kArm,
                                            UserInterface::kLeg, UserInterface::kJoystick,
                                            UserInterface::kBoards};

/// "wrist", "arm", "leg", "joystick", "boards".
const char* Name(UserInterface interface);
/// The interface of that name; kUnspecified when there is none.
UserInterface UserInterfaceNamed(const std::string& name);
/// "wrist, arm, leg, joystick, boards": for errors.
std::string UserInterfaceNames();

/// What an interface understands of the person's motion now.
enum class Activity {
  kUnspecified = 0,
  kAbsent = 1,     ///< A device that it needs is missing.
  kRest = 2,       ///< At rest, or standing still.
  kUnclear = 3,    ///< In motion, but its features are not known yet.
  kUnequal = 4,    ///< Left and right move at different frequencies.
  kAlternate = 5,  ///< Left and right alternate.
  kTogether = 6,   ///< Left and right move together.
  kStick = 7,      ///< The stick is out of its centre.
  kButton = 8,     ///< The jump button is pressed, or was a moment ago.
  kHeelRise = 9,   ///< Both heels rise from the boards.
  kOffBoards = 10  ///< Both feet are off the boards.
};

/// What turns the character.
enum class TurnSource {
  kUnspecified = 0,
  kHands = 1,
  kHead = 2,
  kFeet = 3,
  kTrunk = 4,
  kStick = 5,
  kLean = 6
};

/// "hands", "head", "feet", "trunk", "stick", "lean".
const char* Name(TurnSource source);

/// Of the forearms.
struct ForearmState {
  bool valid = false;
  double elevation_rad = 0;  ///< Over the horizontal; -pi/2 hanging.
  double bent_rad = 0;       ///< Above it the arms count as bent.
};

/// Of a joystick.
struct StickPosition {
  bool valid = false;
  double x = 0;  ///< -1 left to 1 right.
  double y = 0;  ///< -1 back to 1 front.
};

/// Of what turns the character.
struct TurnState {
  bool valid = false;
  TurnSource source = TurnSource::kUnspecified;
  double share = 0;  ///< Positive to the right; beyond +-1 the character turns.
};

/// What an interface believes that the person does and what that commands. Of fixed size.
struct InterfaceState {
  UserInterface interface = UserInterface::kUnspecified;
  Activity activity = Activity::kUnspecified;
  Gait gait = Gait::kStep;              ///< What the motion commands.
  Gait next_gait = Gait::kUnspecified;  ///< Seen, but it has not lasted long enough yet.
  double next_share = 0;                ///< How much of that time is over, 0 to 1.
  bool frequency_valid = false;
  double frequency_hz = 0;  ///< Of one limb; on boards of one foot.
  double border_hz = 0;     ///< Between walking and running; 0: not a matter of frequency.
  bool phase_valid = false;
  double phase_rad = 0;     ///< Right minus left, in (-pi, pi].
  double together_rad = 0;  ///< Nearer to 0 the limbs move together; 0: phase has no meaning.
  ForearmState forearms = {};
  StickPosition stick = {};
  bool load_valid = false;
  double left_share = 0.5;  ///< Of the load on both boards, 0 to 1.
  TurnState turn = {};
  /// Bit n: a device with the role of number n is missing. A joystick is missing in the hand that
  /// has it, and in both while it was not seen in either.
  std::uint32_t missing_roles = 0;
  std::uint32_t unmounted_roles = 0;  ///< Likewise: worn without a mounting, which it needs.
  double view_roll_rad = 0;  ///< By which the picture follows the head, clockwise positive.
};

/// The bit of a role in InterfaceState.
constexpr std::uint32_t RoleBit(DeviceRole role) { return 1u << static_cast<unsigned>(role); }
/// The names of roles by their bits: "left_hand, head".
std::string RoleNames(std::uint32_t roles);
/// The devices of an interface by the bits of their roles, in words for who uses them: "the left
/// hand and the head", "the left board", "the joystick in the left hand".
std::string DevicesText(UserInterface interface, std::uint32_t roles);

}  // namespace footing::stream
