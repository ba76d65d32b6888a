#include "daemon/simulation/mapping/any_interface.h"

#include <algorithm>

namespace footing::mapping {

using stream::DeviceRole;
using stream::UserInterface;

namespace {

/// The fastest stable jump (daemon/simulation/biped/limits.cc).
constexpr double kRunUpMps = 2;

}  // namespace

const char* MappingFileOf(UserInterface interface) {
  switch (interface) {
    case UserInterface::kUnspecified:
    case UserInterface::kWrist:
      return kWristMappingFile;
    case UserInterface::kArm:
      return kArmMappingFile;
    case UserInterface::kLeg:
      return kLegMappingFile;
    case UserInterface::kJoystick:
      return kJoystickMappingFile;
    case UserInterface::kBoards:
      return kBoardsMappingFile;
  }
  return kWristMappingFile;
}

bool Uses(const InterfaceOptions& options, DeviceRole role) {
  switch (options.interface) {
    case UserInterface::kUnspecified:
      return false;
    case UserInterface::kWrist:
    case UserInterface::kArm:
    case UserInterface::kJoystick:
      return role == DeviceRole::kLeftHand || role == DeviceRole::kRightHand;
    case UserInterface::kLeg:
      return role == DeviceRole::kLeftLeg || role == DeviceRole::kRightLeg;
    case UserInterface::kBoards:
      return role == DeviceRole::kLeftBoard || role == DeviceRole::kRightBoard;
  }
  return false;
}

std::uint32_t MissingRoles(const InterfaceOptions& options, std::uint32_t present) {
  std::uint32_t needed = 0;
  for (unsigned number = 1; number <= static_cast<unsigned>(DeviceRole::kTrunk); ++number) {
    const auto role = static_cast<DeviceRole>(number);
    if (Uses(options, role)) needed |= stream::RoleBit(role);
  }
  const bool leg = options.interface == UserInterface::kLeg;
  if (leg && options.leg.turn_by == stream::TurnSource::kHead) {
    needed |= stream::RoleBit(DeviceRole::kHead);
  }
  if (leg && options.leg.turn_by == stream::TurnSource::kTrunk) {
    needed |= stream::RoleBit(DeviceRole::kTrunk);
  }
  // The stick may be on either hand's Wiimote.
  const bool stick = options.interface == UserInterface::kJoystick && (needed & present) != 0;
  return stick ? 0 : needed & ~present;
}

Result<AnyInterface> AnyInterface::Create(const InterfaceOptions& options, const std::string& table,
                                          const std::string& from) {
  const std::string origin = from.empty() ? MappingFileOf(options.interface) : from;
  switch (options.interface) {
    case UserInterface::kUnspecified:
      break;
    case UserInterface::kWrist: {
      const auto mapping = ParseWristMapping(table, origin);
      if (!mapping) return mapping.error();
      return AnyInterface(WristInterface(*mapping));
    }
    case UserInterface::kArm: {
      const auto mapping = ParseArmMapping(table, origin);
      if (!mapping) return mapping.error();
      return AnyInterface(ArmInterface(*mapping));
    }
    case UserInterface::kLeg: {
      const auto mapping = ParseLegMapping(table, origin);
      if (!mapping) return mapping.error();
      return AnyInterface(LegInterface(*mapping, options.leg));
    }
    case UserInterface::kJoystick: {
      const auto mapping = ParseJoystickMapping(table, origin);
      if (!mapping) return mapping.error();
      return AnyInterface(JoystickInterface(*mapping));
    }
    case UserInterface::kBoards: {
      const auto mapping = ParseBoardsMapping(table, origin);
      if (!mapping) return mapping.error();
      return AnyInterface(BoardsInterface(*mapping, options.boards_may_be_left));
    }
  }
  return UsageError("unknown interface; there are: " + stream::UserInterfaceNames());
}

biped::GaitCommand AnyInterface::Advance(double time_s, const Inputs& inputs) {
  biped::GaitCommand command =
      std::visit([&](auto& interface) { return interface.Advance(time_s, inputs); }, interface_);
  if (command.gait == stream::Gait::kRun) run_mps_ = command.speed_mps;
  const bool runs_up = command.gait == stream::Gait::kJump && inputs.running == stream::Gait::kRun;
  if (runs_up) command.speed_mps = std::max(command.speed_mps, std::min(run_mps_, kRunUpMps));
  return command;
}

void AnyInterface::StartAgain() {
  std::visit([](auto& interface) { interface.StartAgain(); }, interface_);
}

void AnyInterface::RenewGrip() {
  if (auto* arm = std::get_if<ArmInterface>(&interface_)) arm->RenewGrip();
}

const stream::InterfaceState& AnyInterface::state() const {
  return std::visit(
      [](const auto& interface) -> const stream::InterfaceState& { return interface.state(); },
      interface_);
}

}  // namespace footing::mapping
