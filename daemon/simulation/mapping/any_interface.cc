#include "daemon/simulation/mapping/any_interface.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::mapping {
namespace {

using stream::DeviceRole;
using stream::TurnSource;

/// The picture follows the head no further.
constexpr double kMostViewRollRad = DegreesToRadians(45);

/// How far to the right that which turns commands; none while it is not known.
std::optional<double> TurnRight(const Inputs& inputs, TurnSource turn_by) {
  if (turn_by == TurnSource::kFeet) {
    const LimbFeatures &left = inputs.legs.left, &right = inputs.legs.right;
    if (!left.moving || !right.moving) return 0;
    if (!left.amplitude_valid || !right.amplitude_valid) return std::nullopt;
    const double sum_mps2 = left.amplitude_mps2 + right.amplitude_mps2;
    return sum_mps2 > 0 ? (left.amplitude_mps2 - right.amplitude_mps2) / sum_mps2 : 0;
  }
  const LimbFeatures& upper = turn_by == TurnSource::kTrunk ? inputs.trunk : inputs.head;
  if (!upper.inclination_valid) return std::nullopt;
  return upper.roll_rad;
}

/// Feet that are lifted to different heights step alternately; a hop lifts both alike. The shins of
/// uneven steps move along different paths, so their phase does not show which of the two it is;
/// and the lower foot's shin moves mostly with the pelvis, so the other one shows the rhythm. Where
/// that has no frequency, legs may have begun to move together, and nothing is replaced. `side`: 1
/// where the left foot is the higher one, -1 the right one.
LimbPair SteppingUnevenly(const LimbPair& legs, int side) {
  const LimbFeatures& higher = side > 0 ? legs.left : legs.right;
  if (!higher.frequency_valid) return legs;
  LimbPair stepping = legs;
  for (LimbFeatures* leg : {&stepping.left, &stepping.right}) {
    leg->frequency_valid = true;
    leg->frequency_hz = higher.frequency_hz;
  }
  stepping.phase_valid = true;
  stepping.phase_rad = kPi;
  return stepping;
}

std::uint32_t MissingRoles(const Inputs& inputs, TurnSource turn_by) {
  std::uint32_t missing = Missing(inputs.legs.left, DeviceRole::kLeftLeg) |
                          Missing(inputs.legs.right, DeviceRole::kRightLeg);
  if (turn_by == TurnSource::kHead) missing |= Missing(inputs.head, DeviceRole::kHead);
  if (turn_by == TurnSource::kTrunk) missing |= Missing(inputs.trunk, DeviceRole::kTrunk);
  return missing;
}

/// A head's controller is worn as the frame M is; shins and trunk need a mounting.
std::uint32_t UnmountedRoles(const Inputs& inputs, TurnSource turn_by) {
  std::uint32_t unmounted = Unmounted(inputs.legs.left, DeviceRole::kLeftLeg) |
                            Unmounted(inputs.legs.right, DeviceRole::kRightLeg);
  if (turn_by == TurnSource::kTrunk) unmounted |= Unmounted(inputs.trunk, DeviceRole::kTrunk);
  return unmounted;
}

TurnMapping TurnMappingOf(const LegMapping& mapping, TurnSource turn_by) {
  TurnMapping turn = mapping.turn;
  if (turn_by == TurnSource::kFeet) {
    turn.turn_above = mapping.feet_turn_above;
    turn.straight_below = mapping.feet_straight_below;
  }
  return turn;
}

}  // namespace

Result<LegMapping> ParseLegMapping(const std::string& text, const std::string& origin) {
  LegMapping mapping;
  TableFields fields;
  AddFields(mapping.swing, fields);
  AddFields(mapping.border, fields);
  AddFields(mapping.turn, false, fields);
  fields.push_back({"feet_turn_above", &mapping.feet_turn_above, 0.01, 1});
  fields.push_back({"feet_straight_below", &mapping.feet_straight_below, 0, 1});
  const auto read = ReadTable(text, origin, fields, {{"camera_roll", &mapping.camera_roll}});
  if (!read) return read.error();
  if (!mapping.swing.IsOrdered() || !mapping.turn.IsOrdered() ||
      mapping.feet_straight_below > mapping.feet_turn_above) {
    return NotOrdered(origin);
  }
  return mapping;
}

LegInterface::LegInterface(const LegMapping& mapping, const LegOptions& options)
    : mapping_(mapping),
      options_(options),
      gait_(mapping.swing),
      turn_(TurnMappingOf(mapping, options.turn_by)) {
  options_.camera_roll = options.camera_roll || mapping.camera_roll;
}

biped::GaitCommand LegInterface::Advance(double time_s, const Inputs& inputs) {
  const auto right = TurnRight(inputs, options_.turn_by);
  const bool absent = !inputs.legs.left.present && !inputs.legs.right.present;
  if (absent) turn_.Rest();
  const double turn_per_step_rad = turn_.Advance(time_s, absent ? std::nullopt : right);
  const bool uneven = options_.turn_by == TurnSource::kFeet && turn_.side() != 0;
  const LimbPair legs = uneven ? SteppingUnevenly(inputs.legs, turn_.side()) : inputs.legs;
  const auto frequency_hz =
      MeanOf(legs, &LimbFeatures::frequency_valid, &LimbFeatures::frequency_hz);
  const bool run = frequency_hz && mapping_.border.IsRun(*frequency_hz, gait_.gait());
  biped::GaitCommand command = gait_.Advance(time_s, legs, run);
  command.turn_per_step_rad = turn_per_step_rad;

  state_ = {.interface = stream::UserInterface::kLeg,
            .border_hz = mapping_.border.border_hz,
            .turn = {.valid = turn_.valid(), .source = options_.turn_by, .share = turn_.share()},
            .missing_roles = MissingRoles(inputs, options_.turn_by),
            .unmounted_roles = UnmountedRoles(inputs, options_.turn_by)};
  if (options_.camera_roll && inputs.head.inclination_valid) {
    state_.view_roll_rad = std::clamp(inputs.head.roll_rad, -kMostViewRollRad, kMostViewRollRad);
  }
  gait_.Describe(legs, state_);
  return command;
}

using stream::UserInterface;

namespace {

/// The fastest stable jump (daemon/simulation/biped/body_state.cc).
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

std::uint32_t MissingRoles(const InterfaceOptions& options, std::uint32_t present) {
  std::uint32_t needed = stream::DrivingRoles(options.interface);
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
