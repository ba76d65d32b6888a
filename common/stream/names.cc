#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "common/stream/character.h"
#include "common/stream/device.h"
#include "common/stream/leg_turn.h"
#include "common/stream/setup.h"
#include "common/stream/user_interface.h"

namespace footing::stream {
namespace {

constexpr std::array kKinds = {"unknown", "wiimote", "balance_board", "ps_move", "pro_controller"};
constexpr std::array kRoles = {"none",         "left_hand",    "right_hand",     "left_leg",
                               "right_leg",    "head",         "left_board",     "right_board",
                               "editor",       "trunk",        "left_upper_arm", "right_upper_arm",
                               "left_forearm", "right_forearm"};
constexpr std::array kStates = {"unknown", "connecting", "live", "stale", "lost"};
constexpr std::array kOrigins = {"unknown", "device", "device_copy", "defaults", "stored"};
constexpr std::array kExtensions = {"unknown",
                                    "none",
                                    "nunchuk",
                                    "classic",
                                    "motion_plus",
                                    "motion_plus_nunchuk",
                                    "motion_plus_classic",
                                    "other"};
constexpr std::array kGaitNames = {"unknown", "step", "walk", "run", "jump"};
static_assert(kGaitNames.size() == kGaits.size() + 1, "name every gait");
constexpr std::array kInterfaces = {"unknown", "wrist", "arm", "leg", "joystick", "boards"};
static_assert(kInterfaces.size() == kUserInterfaces.size() + 1, "name every interface");
constexpr std::array kTurnSources = {"unknown", "hands", "head", "feet", "trunk", "stick", "lean"};
constexpr std::array kCauseNames = {"unknown", "simulation",   "curve",
                                    "jump",    "straightness", "transition"};
static_assert(kCauseNames.size() == kFailureCauses.size() + 1, "name every cause");
constexpr std::array kGestures = {"none",  "switch on",    "hold still", "step off",  "step on",
                                  "stand", "lean forward", "shake",      "take steps"};
constexpr std::array kTrialPhaseNames = {"unknown", "ready", "running", "finished", "stopped"};

template <std::size_t N, typename E>
const char* At(const std::array<const char*, N>& names, E value) {
  const auto index = static_cast<std::size_t>(value);
  return index < N ? names[index] : names[0];
}

template <typename E, std::size_t N>
E Named(const std::array<const char*, N>& names, const std::string& name) {
  for (std::size_t i = 1; i < N; ++i) {
    if (name == names[i]) return static_cast<E>(i);
  }
  return E::kUnspecified;
}

/// All names but the first, which is that of kUnspecified.
template <std::size_t N>
std::string Joined(const std::array<const char*, N>& names) {
  std::string joined;
  for (std::size_t i = 1; i < N; ++i) joined += (i == 1 ? "" : ", ") + std::string(names[i]);
  return joined;
}

}  // namespace

const char* Name(DeviceKind kind) { return At(kKinds, kind); }
const char* Name(DeviceRole role) { return At(kRoles, role); }
const char* Name(DeviceState state) { return At(kStates, state); }
const char* Name(CalibrationOrigin origin) { return At(kOrigins, origin); }
const char* Name(Extension extension) { return At(kExtensions, extension); }
const char* Name(Gait gait) { return At(kGaitNames, gait); }
const char* Name(FailureCause cause) { return At(kCauseNames, cause); }
const char* Name(TrialPhase phase) { return At(kTrialPhaseNames, phase); }
const char* Name(UserInterface interface) { return At(kInterfaces, interface); }
const char* Name(Gesture gesture) { return At(kGestures, gesture); }
const char* Name(TurnSource source) { return At(kTurnSources, source); }
DeviceRole RoleNamed(const std::string& name) { return Named<DeviceRole>(kRoles, name); }
TurnSource LegTurnSourceNamed(const std::string& name) {
  for (const auto source : kLegTurnSources) {
    if (name == Name(source)) return source;
  }
  return TurnSource::kUnspecified;
}

std::string RoleNames() { return Joined(kRoles); }
std::string GaitNames() { return Joined(kGaitNames); }
Gait GaitNamed(const std::string& name) { return Named<Gait>(kGaitNames, name); }
std::string UserInterfaceNames() { return Joined(kInterfaces); }
UserInterface UserInterfaceNamed(const std::string& name) {
  return Named<UserInterface>(kInterfaces, name);
}

std::string RoleNames(std::uint32_t roles) {
  std::string names;
  for (std::size_t number = 1; number < kRoles.size(); ++number) {
    const auto role = static_cast<DeviceRole>(number);
    if ((roles & RoleBit(role)) == 0) continue;
    names += (names.empty() ? "" : ", ") + std::string(Name(role));
  }
  return names;
}

std::string DevicesText(UserInterface interface, std::uint32_t roles) {
  std::vector<std::string> names;
  for (std::size_t number = 1; number < kRoles.size(); ++number) {
    const auto role = static_cast<DeviceRole>(number);
    if ((roles & RoleBit(role)) == 0) continue;
    std::string& name = names.emplace_back("the " + std::string(Name(role)));
    std::replace(name.begin(), name.end(), '_', ' ');
  }
  if (interface == UserInterface::kJoystick) {
    return names.size() == 1 ? "the joystick in " + names.front() : "the joystick";
  }
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 == names.size() ? " and " : ", ";
    list += names[i];
  }
  return list;
}

std::uint32_t LedsOf(DeviceRole role) {
  switch (role) {
    case DeviceRole::kLeftHand:
      return 0b0001;
    case DeviceRole::kRightHand:
      return 0b0010;
    case DeviceRole::kLeftLeg:
      return 0b0100;
    case DeviceRole::kRightLeg:
      return 0b1000;
    case DeviceRole::kHead:
      return 0b1001;
    case DeviceRole::kTrunk:
      return 0b0101;
    case DeviceRole::kLeftBoard:
      return 0b0001;
    case DeviceRole::kEditor:
      return 0b0110;
    case DeviceRole::kLeftUpperArm:
      return 0b0011;
    case DeviceRole::kRightUpperArm:
      return 0b1010;
    case DeviceRole::kLeftForearm:
      return 0b0111;
    case DeviceRole::kRightForearm:
      return 0b1110;
    case DeviceRole::kRightBoard:
    case DeviceRole::kUnspecified:
      return 0;
  }
  return 0;
}

}  // namespace footing::stream
