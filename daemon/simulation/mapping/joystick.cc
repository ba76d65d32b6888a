#include "daemon/simulation/mapping/joystick.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/biped/limits.h"

namespace footing::mapping {
namespace {

using stream::Activity;
using stream::DeviceRole;
using stream::Gait;

/// The hand whose Wiimote has the stick; either one while that is not known.
std::uint32_t HandsOf(DeviceRole role) {
  if (role != DeviceRole::kUnspecified) return stream::RoleBit(role);
  return stream::RoleBit(DeviceRole::kLeftHand) | stream::RoleBit(DeviceRole::kRightHand);
}

/// -1 for a value that the state is beyond already, 1 for one that it has yet to pass.
double Slack(bool beyond, double hysteresis) { return beyond ? -hysteresis : hysteresis; }

}  // namespace

Result<JoystickMapping> ParseJoystickMapping(const std::string& text, const std::string& origin) {
  JoystickMapping m;
  TableFields fields{
      {"centre_radius", &m.centre_radius, 0.05, 0.9},
      {"run_radius", &m.run_radius, 0.1, 1},
      {"radius_hysteresis", &m.radius_hysteresis, 0, 0.2},
      {"forward_above_deg", &m.forward_above_rad, 0, 45, Unit::kDegrees},
      {"straight_half_deg", &m.straight_half_rad, 1, 89, Unit::kDegrees},
      {"sector_hysteresis_deg", &m.sector_hysteresis_rad, 0, 20, Unit::kDegrees},
      {"turn_per_step_deg", &m.turn_per_step_rad, 0, biped::kTurnPerStepMaxDeg, Unit::kDegrees},
      {"jump_height_m", &m.jump_height_m, 0.05, 0.5},
      {"jump_speed_max_mps", &m.jump_speed_max_mps, 0, 2},
      {"jump_after_s", &m.jump_after_s, 0.1, 5},
  };
  AddFields({"walk_radius_min", "walk_radius_max", "walk_speed_min_mps", "walk_speed_max_mps", 0, 1,
             0, 1.75},
            m.walk_mps_from_radius, fields);
  AddFields(
      {"run_radius_min", "run_radius_max", "run_speed_min_mps", "run_speed_max_mps", 0, 1, 0, 6},
      m.run_mps_from_radius, fields);
  if (const auto read = ReadTable(text, origin, fields); !read) return read.error();
  const bool ordered = m.walk_mps_from_radius.Rises() && m.run_mps_from_radius.Rises() &&
                       m.centre_radius < m.run_radius;
  if (!ordered) return NotOrdered(origin);
  return m;
}

StickRegion JoystickInterface::RegionOf(double radius, double angle_rad) const {
  const bool out = region_ != StickRegion::kCentre;
  if (radius < mapping_.centre_radius + Slack(out, mapping_.radius_hysteresis)) {
    return StickRegion::kCentre;
  }
  const bool moves = region_ == StickRegion::kWalk || region_ == StickRegion::kRun;
  const double most_rad =
      kPi / 2 - mapping_.forward_above_rad - Slack(moves, mapping_.sector_hysteresis_rad);
  if (std::fabs(angle_rad) > most_rad) {
    // Nearer to the rear than to a side it does not turn.
    return std::fabs(angle_rad) > 3 * kPi / 4 ? StickRegion::kCentre : StickRegion::kTurnInPlace;
  }
  const bool runs = region_ == StickRegion::kRun;
  const double border = mapping_.run_radius + Slack(runs, mapping_.radius_hysteresis);
  return radius < border ? StickRegion::kWalk : StickRegion::kRun;
}

StickSector JoystickInterface::SectorOf(double angle_rad) const {
  const bool turns = sector_ == (angle_rad > 0 ? StickSector::kRight : StickSector::kLeft);
  const double border_rad =
      mapping_.straight_half_rad + Slack(turns, mapping_.sector_hysteresis_rad);
  if (std::fabs(angle_rad) <= border_rad) return StickSector::kStraight;
  return angle_rad > 0 ? StickSector::kRight : StickSector::kLeft;
}

biped::GaitCommand JoystickInterface::StickCommand(const StickInput& stick) {
  const double radius = std::min(1.0, std::hypot(stick.x, stick.y));
  const double angle_rad = radius > 0 ? std::atan2(stick.x, stick.y) : 0;  // Right is positive.
  region_ = RegionOf(radius, angle_rad);
  sector_ = region_ == StickRegion::kCentre ? StickSector::kStraight : SectorOf(angle_rad);
  biped::GaitCommand command;
  command.height_m = mapping_.jump_height_m;
  if (sector_ == StickSector::kLeft) command.turn_per_step_rad = mapping_.turn_per_step_rad;
  if (sector_ == StickSector::kRight) command.turn_per_step_rad = -mapping_.turn_per_step_rad;
  switch (region_) {
    case StickRegion::kCentre:
    case StickRegion::kTurnInPlace:
      break;
    case StickRegion::kWalk:
      command.gait = Gait::kWalk;
      command.speed_mps = mapping_.walk_mps_from_radius(radius);
      break;
    case StickRegion::kRun:
      command.gait = Gait::kRun;
      command.speed_mps = mapping_.run_mps_from_radius(radius);
      break;
  }
  return command;
}

/// A press before the first input is not counted: nobody pressed for this character.
bool JoystickInterface::Jumps(double time_s, const Inputs& inputs) {
  const StickInput& stick = inputs.stick;
  if (known_ && stick.presses != presses_) jump_.Start(time_s);
  known_ = true;
  presses_ = stick.presses;
  return jump_.Advance(time_s, inputs.running, stick.pressed);
}

biped::GaitCommand JoystickInterface::Advance(double time_s, const Inputs& inputs) {
  const StickInput& stick = inputs.stick;
  biped::GaitCommand command;
  const DeviceRole role = stick.role == DeviceRole::kUnspecified ? role_ : stick.role;
  if (!stick.present) {
    *this = JoystickInterface(mapping_);
  } else {
    command = StickCommand(stick);
    if (Jumps(time_s, inputs)) {
      command.gait = Gait::kJump;
      command.speed_mps = std::min(command.speed_mps, mapping_.jump_speed_max_mps);
    }
  }
  role_ = role;
  Describe(stick, command);
  return command;
}

void JoystickInterface::Describe(const StickInput& stick, const biped::GaitCommand& command) {
  const double right = sector_ == StickSector::kRight ? 1 : sector_ == StickSector::kLeft ? -1 : 0;
  state_ = {
      .interface = stream::UserInterface::kJoystick,
      .activity = !stick.present                    ? Activity::kAbsent
                  : jump_.active()                  ? Activity::kButton
                  : region_ == StickRegion::kCentre ? Activity::kRest
                                                    : Activity::kStick,
      .gait = command.gait,
      .stick = {.valid = stick.present, .x = stick.x, .y = stick.y},
      .turn = {.valid = stick.present, .source = stream::TurnSource::kStick, .share = 1.5 * right}};
  if (!stick.present) state_.missing_roles = HandsOf(role_);
}

}  // namespace footing::mapping
