#include "daemon/simulation/mapping/boards.h"

#include <algorithm>
#include <cmath>

#include <numeric>
#include "common/base/units.h"
#include "daemon/simulation/biped/body_state.h"

namespace footing::mapping {

void HeldJump::Start(double time_s) {
  active_ = true;
  jumps_ = false;
  since_s_ = time_s;
}

bool HeldJump::Advance(double time_s, stream::Gait running, bool held) {
  if (!active_) return false;
  if (!jumps_ && running == stream::Gait::kJump) {
    jumps_ = true;
    since_s_ = time_s;
  }
  active_ = held || time_s - since_s_ < (jumps_ ? after_s_ : kMostWaitS);
  return active_;
}

namespace {

using stream::Activity;
using stream::DeviceRole;
using stream::Gait;

/// The character steps as the feet do.
constexpr double kStepsPerCycle = 2;
/// Below this share of the weight both feet are off, once it lasts; they are back after a while.
constexpr double kOffShare = 0.25;
constexpr double kOffS = 0.1;
constexpr double kBackS = 0.5;
/// After this time off the boards it may be somebody else who comes back.
constexpr double kGoneS = 1;
/// A rise's push is over this time after it was recognised.
constexpr double kPushS = 0.15;
/// A heel rise jumps on from the walk that ended no longer ago than this: its feet stand first.
constexpr double kWalkedS = 1;
/// A run must last two steps before it counts, since who leans over to the other side takes two
/// short ones, and the first step of a person who leans is short; a change back one step.
constexpr double kRunCycles = 1;
constexpr double kWalkCycles = 0.5;

board::FootLoad FootOn(const BoardInput& board) {
  const double load_n = std::accumulate(board.corners_n.begin(), board.corners_n.end(), 0.0);
  return {load_n, board.cop_valid, board.cop_x_m};
}

}  // namespace

Result<BoardsMapping> ParseBoardsMapping(const std::string& text, const std::string& origin) {
  BoardsMapping m;
  TableFields fields{
      {"jump_speed_max_mps", &m.jump_speed_max_mps, 0, 2},
      {"jump_after_s", &m.jump_after_s, 0.1, 5},
      {"standing_load_n", &m.standing_load_n, 50, 500},
      {"stance_above", &m.steps.stance_above, 0.55, 0.95},
      {"longest_step_s", &m.steps.longest_step_s, 0.2, 5},
      {"heel_rise_forward_m", &m.heel_rise.forward_m, 0.01, 0.15},
      {"heel_rise_overshoot", &m.heel_rise.overshoot, 0.02, 1},
      {"heel_rise_together_s", &m.heel_rise.together_s, 0.05, 1},
      {"heel_rise_standing_s", &m.heel_rise.standing_s, 0.05, 2},
      {"standing_turn_above", &m.standing_turn_above, 0.01, 1},
  };
  AddSpeedFields(m.walk_mps_from_hz, m.run_mps_from_hz, fields);
  AddFields({"jump_overshoot_min", "jump_overshoot_max", "jump_height_min_m", "jump_height_max_m",
             0, 3, 0.02, 0.5},
            m.jump_m_from_overshoot, fields);
  AddFields(m.border, fields);
  AddFields(m.turn, true, fields);
  if (const auto read = ReadTable(text, origin, fields); !read) return read.error();
  const bool ordered = m.walk_mps_from_hz.Rises() && m.run_mps_from_hz.Rises() &&
                       m.jump_m_from_overshoot.Rises() && m.turn.IsOrdered();
  if (!ordered) return NotOrdered(origin);
  return m;
}

BoardsInterface::BoardsInterface(const BoardsMapping& mapping, bool may_be_left)
    : mapping_(mapping),
      may_be_left_(may_be_left),
      steps_(mapping.steps),
      heel_rise_(mapping.heel_rise),
      turn_(mapping.turn),
      held_jump_(mapping.jump_after_s) {}

bool BoardsInterface::Leaves(double load_n, double elapsed_s) {
  const double on_n = std::max(mapping_.standing_load_n, kOffShare * weight_.n());
  gone_s_ = load_n < on_n ? gone_s_ + elapsed_s : 0;
  back_s_ = load_n < on_n ? 0 : back_s_ + elapsed_s;
  if (gone_s_ > kGoneS) weight_ = {};
  const bool leaves = !off_ && gone_s_ > kOffS;
  if (leaves) off_ = true;
  if (off_ && back_s_ > kBackS) {
    off_ = false;
    weight_.WeighAgain();
  }
  if (!off_) return false;
  steps_.Reset();
  heel_rise_.Reset();
  return leaves;
}

biped::GaitCommand BoardsInterface::StepCommand(double time_s) {
  biped::GaitCommand command;
  if (off_ || !steps_.stepping()) {
    settled_.Reset(Gait::kStep);
    return command;
  }
  // Once both feet stand, either the steps have ended or the heels are about to rise: until that is
  // known the gait goes on as it was, so that a leap has the speed of its run-up.
  const double frequency_hz =
      steps_.even_s() > 0 ? steps_.last_frequency_hz() : steps_.frequency_hz();
  const Gait now = settled_.gait();
  const bool run_seen = mapping_.border.IsRun(frequency_hz, now);
  const Gait seen = run_seen ? Gait::kRun : Gait::kWalk;
  const double cycles = run_seen ? kRunCycles : now == Gait::kStep ? 0 : kWalkCycles;
  const double lasting_s = cycles / frequency_hz;
  command.gait = settled_.Advance(time_s, seen, lasting_s);
  if (command.gait == Gait::kStep) return command;
  const bool run = command.gait == Gait::kRun;
  command.speed_mps =
      run ? mapping_.run_mps_from_hz(frequency_hz) : mapping_.walk_mps_from_hz(frequency_hz);
  command.cadence_hz = kStepsPerCycle * frequency_hz;
  return command;
}

void BoardsInterface::StartJump(double time_s, double speed_mps, double overshoot) {
  rose_s_ = time_s;
  held_jump_.Start(time_s);
  jump_ = {.gait = Gait::kJump,
           .speed_mps = std::min(speed_mps, mapping_.jump_speed_max_mps),
           .height_m = mapping_.jump_m_from_overshoot(overshoot)};
}

double BoardsInterface::TurnOf(double time_s) {
  if (off_) {
    turn_.Rest();
    return 0;
  }
  auto right = steps_.lean_right();
  if (right && !steps_.stepping()) {
    *right *= mapping_.turn.turn_above / mapping_.standing_turn_above;
  }
  return turn_.Advance(time_s, right);
}

biped::GaitCommand BoardsInterface::Advance(double time_s, const Inputs& inputs) {
  const double elapsed_s = std::clamp(time_s - time_s_, 0.0, 0.1);
  time_s_ = time_s;
  if (!inputs.left_board.present || !inputs.right_board.present) {
    *this = BoardsInterface(mapping_, may_be_left_);
    time_s_ = time_s;
    Describe(inputs, 0.5);
    return command_;
  }
  const board::Stance stance =
      board::StanceOn(FootOn(inputs.left_board), FootOn(inputs.right_board));
  const double push = heel_rise_.overshoot();
  const bool leaves = Leaves(stance.load_n, elapsed_s);
  bool rises = false;
  if (!off_) {
    weight_.Advance(stance.load_n, elapsed_s);
    steps_.Advance(time_s, stance.left_share);
    rises =
        heel_rise_.Advance(time_s, stance.load_n / weight_.n(), stance.forward_m, steps_.even_s());
  }
  biped::GaitCommand command = StepCommand(time_s);
  if (steps_.stepping() && steps_.on_time()) {
    walked_mps_ = command.speed_mps;
    walked_s_ = time_s;
  }
  if (rises) {
    const double speed_mps = time_s - walked_s_ < kWalkedS ? walked_mps_ : 0;
    StartJump(time_s, speed_mps, heel_rise_.overshoot());
  }
  if (time_s - rose_s_ < kPushS) {  // The push goes on for a moment.
    jump_.height_m =
        std::max(jump_.height_m, mapping_.jump_m_from_overshoot(heel_rise_.overshoot()));
  }
  if (leaves) held_jump_.Drop();  // The push of a leap looks like a heel rise.
  if (leaves && may_be_left_) StartJump(time_s, command_.speed_mps, push);
  if (held_jump_.Advance(time_s, inputs.running, false)) command = jump_;
  command.turn_per_step_rad = TurnOf(time_s);
  command_ = command;
  Describe(inputs, stance.left_share);
  return command;
}

void BoardsInterface::Describe(const Inputs& inputs, double left_share) {
  const bool absent = !inputs.left_board.present || !inputs.right_board.present;
  const bool stepping = !absent && !off_ && steps_.stepping();
  const bool jumps = held_jump_.active();
  state_ = {
      .interface = stream::UserInterface::kBoards,
      .activity = absent     ? Activity::kAbsent
                  : jumps    ? Activity::kHeelRise
                  : off_     ? Activity::kOffBoards
                  : stepping ? Activity::kAlternate
                             : Activity::kRest,
      .gait = command_.gait,
      .next_gait = settled_.next(),
      .next_share = settled_.share(),
      .frequency_valid = stepping,
      .frequency_hz = stepping ? steps_.frequency_hz() : 0,
      .border_hz = mapping_.border.border_hz,
      .load_valid = !absent && !off_,
      .left_share = left_share,
      .turn = {.valid = turn_.valid(), .source = stream::TurnSource::kLean, .share = turn_.share()},
      .missing_roles = (inputs.left_board.present ? 0 : stream::RoleBit(DeviceRole::kLeftBoard)) |
                       (inputs.right_board.present ? 0 : stream::RoleBit(DeviceRole::kRightBoard))};
}

namespace {

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
