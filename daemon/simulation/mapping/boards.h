#pragma once

#include "common/board/step_cadence.h"
#include "common/stream/character.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/mapping/inputs.h"
#include "daemon/simulation/mapping/wrist.h"

namespace footing::mapping {

/// A jump that a short event commands: the command waits until the character has taken it over,
/// and goes on for long enough that the jump is made. A plain value.
class HeldJump {
 public:
  /// A character that has not taken a jump over within this time is spared it, s. From running it
  /// takes up to 1.25 s (docs/gait.md).
  static constexpr double kMostWaitS = 2.5;

  /// `after_s`: how long the command goes on once the character jumps.
  explicit HeldJump(double after_s) : after_s_(after_s) {}

  void Start(double time_s);
  /// Takes the event back.
  void Drop() { active_ = false; }
  /// Whether to command the jump; `running` is the character's gait, `held` the event goes on.
  bool Advance(double time_s, stream::Gait running, bool held);
  bool active() const { return active_; }

 private:
  double after_s_;
  bool active_ = false;
  bool jumps_ = false;  ///< The character has taken it over.
  double since_s_ = 0;  ///< The start, or the take-over.
};

/// The table of boards_mapping.json.
struct BoardsMapping {
  Scaling walk_mps_from_hz;
  Scaling run_mps_from_hz;
  FrequencyBorder border;
  Scaling jump_m_from_overshoot;
  double jump_speed_max_mps = 0;
  double jump_after_s = 0;     ///< How long a heel rise goes on once the character jumps.
  double standing_load_n = 0;  ///< From here on somebody stands on the boards.
  board::StepBorders steps;
  board::HeelRiseBorders heel_rise;
  TurnMapping turn;                ///< By the share that leans; while stepping.
  double standing_turn_above = 0;  ///< The same while standing.
};

inline constexpr const char* kBoardsMappingFile = "boards_mapping.json";
/// Every key, nothing unknown, all in range. `origin` names the file.
Result<BoardsMapping> ParseBoardsMapping(const std::string& text, const std::string& origin);

/// The interface of two Balance Boards, ours: one foot on each.
///
/// | motion                        | command                                                   |
/// |-------------------------------|-----------------------------------------------------------|
/// | standing, a board missing     | stepping in place                                         |
/// | stepping, a foot below 1.2 Hz | walk, speed by the frequency of a foot                    |
/// | stepping, a foot above 1.2 Hz | run, speed by the frequency of a foot                     |
/// | a quick heel rise             | jump; height by the push, speed as it walked or ran       |
/// | leaning to a side             | besides, 5 degrees a step to that side                    |
/// | both feet off the boards      | stepping in place; with may_be_left a jump                |
///
/// A plain value.
class BoardsInterface {
 public:
  /// `may_be_left`: the person may jump off the boards, which is a risk of falling.
  BoardsInterface(const BoardsMapping& mapping, bool may_be_left);

  /// The command for new inputs at `time_s`; times must not decrease.
  biped::GaitCommand Advance(double time_s, const Inputs& inputs);
  /// A jump that was commanded is not made any more.
  void StartAgain() { held_jump_.Drop(); }
  const stream::InterfaceState& state() const { return state_; }

 private:
  /// Follows whether both feet are off; true when they have just left.
  bool Leaves(double load_n, double elapsed_s);
  biped::GaitCommand StepCommand(double time_s);
  void StartJump(double time_s, double speed_mps, double overshoot);
  double TurnOf(double time_s);
  void Describe(const Inputs& inputs, double left_share);

  BoardsMapping mapping_;
  bool may_be_left_;
  board::StepCadence steps_;
  board::HeelRise heel_rise_;
  SettledGait settled_;
  Turn turn_;
  double time_s_ = 0;
  board::Weight weight_;    ///< Weight of the person there.
  double gone_s_ = 0;       ///< How long both feet have been off.
  double back_s_ = 0;       ///< How long somebody has stood again.
  bool off_ = true;         ///< Both feet are off, or came back only just now.
  double rose_s_ = -1;      ///< When the last rise was recognised.
  double walked_mps_ = 0;   ///< Speed of the last step that came on time, ...
  double walked_s_ = -1e9;  ///< ... and when that was.
  HeldJump held_jump_;
  biped::GaitCommand jump_;
  biped::GaitCommand command_;
  stream::InterfaceState state_;
};

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
