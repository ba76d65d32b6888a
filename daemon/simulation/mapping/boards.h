#pragma once

#include "common/board/heel_rise.h"
#include "common/board/stance.h"
#include "common/board/step_cadence.h"
#include "daemon/simulation/biped/command.h"
#include "daemon/simulation/mapping/held_jump.h"
#include "daemon/simulation/mapping/inputs.h"
#include "daemon/simulation/mapping/mapping_table.h"
#include "daemon/simulation/mapping/settled_gait.h"
#include "daemon/simulation/mapping/swing_gait.h"
#include "daemon/simulation/mapping/turn.h"

namespace footing::mapping {

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
  board::Weight weight_;    ///< Of who stands there.
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

}  // namespace footing::mapping
