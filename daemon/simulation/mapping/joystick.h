#pragma once

#include "daemon/simulation/biped/command.h"
#include "daemon/simulation/mapping/held_jump.h"
#include "daemon/simulation/mapping/inputs.h"
#include "daemon/simulation/mapping/mapping_table.h"

namespace footing::mapping {

/// The table of joystick_mapping.json.
struct JoystickMapping {
  Scaling walk_mps_from_radius;
  Scaling run_mps_from_radius;
  double centre_radius = 0;      ///< Within it the stick rests.
  double run_radius = 0;         ///< Beyond it the character runs.
  double radius_hysteresis = 0;  ///< On either side of both.
  double forward_above_rad = 0;  ///< Elevation of the stick's direction over its left-right axis.
  double straight_half_rad = 0;  ///< Half the sector of straight on.
  double sector_hysteresis_rad = 0;  ///< On either side of a sector's border.
  double turn_per_step_rad = 0;
  double jump_height_m = 0;
  double jump_speed_max_mps = 0;
  double jump_after_s = 0;  ///< How long a press goes on once the character jumps.
};

inline constexpr const char* kJoystickMappingFile = "joystick_mapping.json";
/// Every key, nothing unknown, all in range. `origin` names the file.
Result<JoystickMapping> ParseJoystickMapping(const std::string& text, const std::string& origin);

/// Where the stick is (figure 11).
enum class StickRegion { kCentre, kTurnInPlace, kWalk, kRun };
/// Which of the three sectors of the half circle.
enum class StickSector { kStraight, kLeft, kRight };

/// The joystick interface of the gait paper, section 7 and figure 11: the stick of a Nunchuk and
/// button A of its Wiimote.
///
/// | stick or button             | command                                                     |
/// |-----------------------------|-------------------------------------------------------------|
/// | centre, or to the rear      | stepping in place                                           |
/// | to a side without forward   | stepping in place, turning                                  |
/// | forward, radius below 0.6   | walk, speed by radius                                       |
/// | forward, radius above 0.6   | run, speed by radius                                        |
/// | left, middle, right sector  | besides, 5 degrees a step to the left, none, to the right   |
/// | button A                    | jump of a fixed height, with the stick's speed and turn     |
///
/// A press commands one jump, a held button jump after jump (see HeldJump). A plain value.
class JoystickInterface {
 public:
  explicit JoystickInterface(const JoystickMapping& mapping)
      : mapping_(mapping), jump_(mapping.jump_after_s) {}

  /// The command for new inputs at `time_s`; times must not decrease.
  biped::GaitCommand Advance(double time_s, const Inputs& inputs);
  /// A jump that was commanded is not made any more.
  void StartAgain() { jump_.Drop(); }
  const stream::InterfaceState& state() const { return state_; }

 private:
  StickRegion RegionOf(double radius, double angle_rad) const;
  StickSector SectorOf(double angle_rad) const;
  biped::GaitCommand StickCommand(const StickInput& stick);
  bool Jumps(double time_s, const Inputs& inputs);
  void Describe(const StickInput& stick, const biped::GaitCommand& command);

  JoystickMapping mapping_;
  StickRegion region_ = StickRegion::kCentre;
  StickSector sector_ = StickSector::kStraight;
  bool known_ = false;  ///< Presses have been counted.
  std::uint64_t presses_ = 0;
  stream::DeviceRole role_ = stream::DeviceRole::kUnspecified;  ///< Last known of the stick.
  HeldJump jump_;
  stream::InterfaceState state_;
};

}  // namespace footing::mapping
